"""Serving the dashboard from this machine."""

from __future__ import annotations

import os
import socket
import threading
import warnings
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from typing import TYPE_CHECKING

from mesa_mobility.errors import MobilityError
from mesa_mobility.garbage import nothing_collected
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.registry import load_model

if TYPE_CHECKING:
    from mesa_mobility import PedestrianModel

SETTINGS = {
    "SOLARA_APP": "mesa_mobility.dashboard.page",
    "SOLARA_GC_FREEZE": "false",
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
        ready: called with the page's address when it can be opened; until all is imported, a
            browser waits there for its answer.

    Raises:
        MobilityError: the address cannot be listened on, or there is no such model.
    """
    listening = _listen(host, port)
    os.environ.update(SETTINGS)
    loaded: Future[type[PedestrianModel]] = Future()
    serving = threading.Event()
    threading.Thread(
        target=_prepare, args=(loaded, serving), name="mesa-mobility start", daemon=True
    ).start()
    loaded.set_result(load_model(model))
    name = f"[{host}]" if ":" in host else host
    # A browser takes a while itself, which it may as well do while Solara is imported.
    listening.listen()
    ready(f"http://{name}:{listening.getsockname()[1]}/")

    # Of a page in a page, which ours is not.
    warnings.filterwarnings("ignore", "Cookies with samesite=none", UserWarning)
    import uvicorn
    from solara.server.starlette import app

    from mesa_mobility.dashboard import page

    page.opening = model

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            serving.set()

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


def _prepare(loaded: Future[type[PedestrianModel]], serving: threading.Event) -> None:
    """Make the model once, before a page asks for it: what it reads, lays out and compiles stays.

    The map is read while Mesa is imported, the rest is done while the browser gets what the page is
    made of: both would only hold up the imports before.
    """
    # Some hundred thousand objects are made until the model is there, and all stay.
    with nothing_collected():
        # What is wrong with map or model, whoever needs it says: the command, or the page.
        with suppress(MobilityError):
            MobilityMap.load()
        kind = loaded.result()
        serving.wait()
        from mesa_mobility.dashboard.recipe import Recipe

        with suppress(Exception):
            Recipe(kind).make()
