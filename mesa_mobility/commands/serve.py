"""`mesa-mobility serve`: a running model for other programs."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Annotated

import typer

from mesa_mobility._startup import nothing_collected
from mesa_mobility.commands.console import say
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.models.making import (
    ModelName,
    ModelOptions,
    create_model,
    model_of_file,
)
from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.interrupts import INTERRUPTED


@grouped
def serve(
    model: ModelName,
    options: ModelOptions,
    doors: ExitOptions,
    *,
    rate: Annotated[int, typer.Option(help="Frames to send a second; a divisor of 30.")] = 30,
    host: Annotated[str, typer.Option(help="Address to listen on.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to listen on; 0 for any free one.")
    ] = 8766,
    origins: Annotated[
        list[str] | None,
        typer.Option(
            "--origin",
            metavar="ORIGIN",
            help="Pages of this origin may connect, such as http://localhost:8000; repeatable.",
        ),
    ] = None,
) -> None:
    """Run a model in real time for other programs: frames and commands over a WebSocket.

    Prints the address to connect to; time begins with the first client. Ctrl-C ends it. Needs the
    extra `live`.
    """
    if find_spec("websockets") is None:
        raise MobilityError(
            "serve needs websockets: pip install 'mesa-mobility[live]' brings what it needs"
        )
    import asyncio

    from mesa_mobility.live.access import address_of, is_loopback, listen, own_token
    from mesa_mobility.live.run import Run
    from mesa_mobility.live.server import Access, LiveServer, origins_of

    token = own_token()
    access = Access(host, token, origins_of(origins or []))
    listening = listen(host, port)
    model, options = model_of_file(model, options.with_seed())
    with nothing_collected():
        from mesa_mobility.crowd import PedestrianModel
        from mesa_mobility.crowd.model_files import find_model
        from mesa_mobility.crowd.precompile import COMPILING, compiling_ahead, is_compiled

        if not is_compiled():
            say(COMPILING)
        with compiling_ahead():
            simulation, _ = create_model(
                find_model(model), model, options, buildings=True, **doors.keywords()
            )
            if not isinstance(simulation, PedestrianModel):
                raise ModelError(f"model {model}: expected a subclass of PedestrianModel")
            run = Run(simulation, rate)

    def ready() -> None:
        if not is_loopback(host):
            say(
                f"warning: {host} is reached from the network: all who have the address below can "
                "command the model, and nothing is encrypted"
            )
        say(f"{model}, seed {options.seed}: connect to the address below (Ctrl-C ends)")
        where = address_of(host, listening.getsockname()[1])
        print(f"ws://{where}/?token={token}", flush=True)

    asyncio.run(LiveServer(run, rate, access, say).serve(listening, ready))
    raise typer.Exit(INTERRUPTED)
