"""Serving the dashboard from this machine."""

from __future__ import annotations

import gc
import os
import socket
import threading
import warnings
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from mesa_mobility.errors import MobilityError

if TYPE_CHECKING:
    from mesa_mobility.dashboard.recipe import Recipe

SETTINGS = {
    "SOLARA_APP": "mesa_mobility.dashboard.page",
    "SOLARA_TELEMETRY_MIXPANEL_ENABLE": "false",
    "SOLARA_SESSION_SAME_SITE": "lax",
    "SOLARA_THEME_SHOW_BANNER": "false",
    "SOLARA_THEME_TITLE": "mesa-mobility",
    "SOLARA_SERVER_HTTP_GZIP": "false",
}
"""What Solara reads when it is imported: the page is ours, and nobody is told of its use.

Nothing is compressed: to pack four megabytes takes longer than to hand them to a browser on this
machine or in this house.
"""


def serve(model: str, host: str, port: int, ready: Callable[[str], None]) -> None:
    """Serve the dashboard until interrupted.

    Args:
        model: name of the installed model to open on.
        host: address to listen on.
        port: to listen on.
        ready: called with the page's address when it can be opened.

    Raises:
        MobilityError: the address cannot be listened on.
    """
    listening = _listen(host, port)
    os.environ.update(SETTINGS)
    # Some hundred thousand objects are made that all stay: to look for garbage among them takes a
    # sixth of the time until the page is there.
    gc.disable()
    reading = threading.Thread(target=_read_map, name="mesa-mobility map", daemon=True)
    reading.start()
    # Of a page in a page, which ours is not.
    warnings.filterwarnings("ignore", "Cookies with samesite=none", UserWarning)
    import uvicorn
    from solara.server.starlette import app

    from mesa_mobility.dashboard import page
    from mesa_mobility.dashboard.recipe import Recipe
    from mesa_mobility.registry import load_model

    page.opening = model
    first = Recipe(load_model(model))

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            # While the browser gets what the page is made of.
            reading.join()
            threading.Thread(
                target=_warm_up, args=(first,), name="mesa-mobility warm-up", daemon=True
            ).start()
            name = f"[{host}]" if ":" in host else host
            ready(f"http://{name}:{listening.getsockname()[1]}/")

    config = uvicorn.Config(app, log_level="warning", ws_per_message_deflate=False)
    Server(config).run(sockets=[listening])


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
    except OSError as error:
        raise MobilityError(
            f"{host}:{port} cannot be listened on: {error.strerror or error}; "
            "--host and --port choose another address"
        ) from error
    return listening


def _read_map() -> None:
    """Read the map that ships, which most models use; the rest of the start goes on meanwhile."""
    from mesa_mobility.mobility import MobilityMap

    # If it cannot be read, the model that needs it says so.
    with suppress(MobilityError):
        MobilityMap.load()


def _warm_up(first: Recipe) -> None:
    """Make the model once, before a page asks for it: its kernels and what they read."""
    # What is wrong with it, the page says.
    with suppress(Exception):
        first.make()
    gc.enable()
    gc.freeze()
