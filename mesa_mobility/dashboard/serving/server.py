"""Serving the dashboard from this machine."""

from __future__ import annotations

import os
import socket
import threading
import warnings
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from mesa_mobility._startup import nothing_collected
from mesa_mobility.crowd.model_files import find_model, is_installed_name
from mesa_mobility.dashboard.serving.guard import Guard
from mesa_mobility.dashboard.session.notices import hand_out_warnings
from mesa_mobility.errors import MobilityError
from mesa_mobility.live.access import TOKEN, address_of, is_loopback, listen, own_token
from mesa_mobility.mobility import MobilityMap

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
"""Solara's settings, read when it is imported: which page to serve, and no telemetry.

Nothing is compressed: packing four megabytes takes longer than sending them over a local network.
"""


def serve(
    model: str,
    host: str,
    port: int,
    ready: Callable[[str], None],
    given: Mapping[str, Any] | None = None,
) -> None:
    """Serve the dashboard until interrupted.

    Its address holds a token, without which every request is refused: other users of this machine
    reach the port, too.

    Args:
        model: name of the installed model to open on, or a Python file with one.
        host: address to listen on.
        port: to listen on.
        ready: called with the page's address when it can be opened; a browser waits for its answer
            until everything is imported.
        given: values of model parameters that the page does not set, by name.

    Raises:
        MobilityError: the address cannot be listened on, there is no such model, or the token in
            the environment is none.
    """
    token = own_token()
    listening = listen(host, port)
    os.environ.update(SETTINGS)
    hand_out_warnings()
    # It concerns pages in frames, which this one is not.  Libraries change the filters for a while
    # in the thread below; one that is added meanwhile is lost.
    warnings.filterwarnings("ignore", "Cookies with samesite=none", UserWarning)
    loaded: Future[type[PedestrianModel]] = Future()
    serving = threading.Event()
    threading.Thread(
        target=_prepare,
        args=(loaded, given or {}, serving),
        name="mesa-mobility start",
        daemon=True,
    ).start()
    kind = find_model(model)
    loaded.set_result(kind)
    # A browser takes a while to start, which it can do while Solara is imported.
    listening.listen()
    port = listening.getsockname()[1]
    ready(f"http://{address_of(host, port)}/?{TOKEN}={token}")

    import uvicorn
    from solara.server.settings import assets
    from solara.server.starlette import app

    from mesa_mobility.dashboard import page
    from mesa_mobility.dashboard.serving.connections import PromptProtocol

    page.opening = model if is_installed_name(model) else kind
    page.given = given or {}
    # Who is on the network is to execute no file that nobody has named.
    page.model_files = is_loopback(host)

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            serving.set()

    guarded = Guard(app, host, port, token, assets.proxy_cache_dir)
    config = uvicorn.Config(
        guarded, http=PromptProtocol, log_level="warning", ws_per_message_deflate=False
    )
    Server(config).run(sockets=[listening])


def _prepare(
    loaded: Future[type[PedestrianModel]], given: Mapping[str, Any], serving: threading.Event
) -> None:
    """Make the model once before a page asks for it, to fill the caches.

    The map is read while Mesa is imported. The rest is done while the browser loads the page:
    earlier it would only hold up the imports.
    """
    # Making the model creates some hundred thousand objects, which all stay.
    with nothing_collected():
        # An unusable map or model is reported where it is needed: by the command or the page.
        with suppress(MobilityError):
            MobilityMap.load()
        kind = loaded.result()
        serving.wait()
        from mesa_mobility.dashboard.session.run_config import Recipe

        with suppress(Exception):
            Recipe(kind, given).make()
