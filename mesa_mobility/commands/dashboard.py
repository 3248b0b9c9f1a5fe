"""`mesa-mobility dashboard`: try and watch a model in the browser."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from mesa_mobility.commands.console import say
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.models.making import MODEL_HELP
from mesa_mobility.errors import MobilityError, ModelError

OPENING, PLAN_MODEL = "doorway", "floor_plan"


@grouped
def dashboard(
    model: Annotated[
        str | None,
        typer.Argument(metavar="[MODEL]", help=MODEL_HELP),
    ] = None,
    plan: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Floor plan to put people on; `mesa-mobility formats` lists formats.",
        ),
    ] = None,
    *,
    doors: ExitOptions,
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port to listen on.")] = 8765,
) -> None:
    """Serve the dashboard until interrupted; the address to open is printed.

    Needs the extra `viz`.
    """
    if find_spec("solara") is None:
        raise MobilityError(
            "the dashboard needs Solara: pip install 'mesa-mobility[viz]' brings what it needs"
        )
    if plan is not None and model is not None:
        raise ModelError(f"--plan {plan}: got model {model!r} as well, expected one of the two")
    from mesa_mobility.dashboard.serving.server import serve
    from mesa_mobility.live.access import is_loopback

    given: dict[str, Any] = {}
    if plan is not None:
        from mesa_mobility.models.floor_plan import read_plan

        read_plan(plan, doors.text, doors.level)
        given = {"plan": plan.resolve(), **doors.keywords()}
    name = model or (OPENING if plan is None else PLAN_MODEL)

    def ready(url: str) -> None:
        if not is_loopback(host):
            say(
                f"warning: {host} is reached from the network: all who have the address below can "
                "run models on this machine, and nothing is encrypted"
            )
        say(f"{name if plan is None else plan}: open {url} (Ctrl-C ends)")

    serve(name, host, port, ready, given)
