"""`mesa-mobility dashboard`: try and watch a model in the browser."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Annotated

import typer

from mesa_mobility.commands.console import say
from mesa_mobility.errors import MobilityError


def dashboard(
    model: Annotated[
        str,
        typer.Argument(metavar="[MODEL]", help="Name of a model; `mesa-mobility models` has them."),
    ] = "doorway",
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
    from mesa_mobility.dashboard.server import serve

    serve(model, host, port, ready=lambda url: say(f"{model}: open {url} (Ctrl-C ends)"))
