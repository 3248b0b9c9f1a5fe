"""Serving the dashboard from this machine."""

from __future__ import annotations

import os
import socket
import threading
import warnings
from collections.abc import Callable

from mesa_mobility.errors import MobilityError

SETTINGS = {
    "SOLARA_APP": "mesa_mobility.dashboard.page",
    "SOLARA_TELEMETRY_MIXPANEL_ENABLE": "false",
    "SOLARA_SESSION_SAME_SITE": "lax",
    "SOLARA_THEME_SHOW_BANNER": "false",
    "SOLARA_THEME_TITLE": "mesa-mobility",
}
"""What Solara reads when it is imported: the page is ours, and nobody is told of its use."""


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
    # The page is not there before its model; both take a while to load, and do so side by side.
    threading.Thread(target=_warm_up, name="mesa-mobility warm-up", daemon=True).start()
    from mesa_mobility.dashboard import page

    page.opening = model
    # Of a page in a page, which ours is not.
    warnings.filterwarnings("ignore", "Cookies with samesite=none", UserWarning)
    import uvicorn
    from solara.server.starlette import app

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            name = f"[{host}]" if ":" in host else host
            ready(f"http://{name}:{listening.getsockname()[1]}/")

    Server(uvicorn.Config(app, log_level="warning")).run(sockets=[listening])


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


def _warm_up() -> None:
    """Load the shipped map and what the choice is compiled to, before anybody asks for it."""
    from mesa_mobility.crowd import PRESETS, PedestrianModel  # noqa: F401
    from mesa_mobility.crowd.repertoire import repertoire
    from mesa_mobility.mobility import MobilityMap

    repertoire((MobilityMap.load(),), PRESETS["default"].durations)
