"""Access to the dashboard's server: only with the token, not from pages of other sites, not in
frames, and to nothing that the page does not need."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from mesa_mobility.live.access import TOKEN, Names, is_own_origin, same_token, token_in

HEADERS = (
    (
        b"content-security-policy",
        b"default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        b"base-uri 'self'; form-action 'self'; frame-ancestors 'none'",
    ),
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)
"""Headers of each response: nothing is loaded from other hosts, and no page may frame this one."""

ROUTES = {
    "GET": re.compile(r"/|/static/.+|/jupyter/nbextensions/.+"),
    "POST": re.compile(r"/_solara/api/close/[^/]+"),
    "WebSocket": re.compile(r"/jupyter/api/kernels/[^/]+/channels"),
}
"""What the page asks for, besides files of ``ASSETS``. Solara serves more: its own state, and pages
by any path."""

ASSETS = "/_solara/cdn/"
"""Libraries of browsers. Solara fetches from a public server what it lacks of them, and deletes a
folder that is asked for, so only files that are there are let through."""

PLAIN = re.compile(r"([\w@+~-][\w@+.~-]*/)+[\w@+~-][\w@+.~-]*", re.ASCII)
"""A path below a folder, without parts that lead elsewhere."""

NO_TOKEN = (
    "open the whole address that `mesa-mobility dashboard` has printed where it was started: it "
    "ends with the token"
)


class Guard:
    """An ASGI application that passes only requests of its own pages to another.

    A request is refused if its ``Host`` is not this server, so that other names pointed at this
    machine do not work; if its ``Origin`` is not that host; if it opens a WebSocket or changes
    something without an ``Origin``; or if it has neither the token, in its address or as
    ``Authorization: Bearer``, nor the cookie for which the token was exchanged. Other than what the
    page needs, nothing is found.

    Args:
        app: the application to guard.
        host: address that the server listens on.
        port: port that it listens on.
        token: required token.
        assets: folder of the browsers' libraries.
    """

    def __init__(self, app: Any, host: str, port: int, token: str, assets: Path) -> None:
        self._app = app
        self._names = Names(host)
        self._token, self._assets = token, assets
        # A cookie is valid for all ports of a host, so its name has the port.
        self._cookie = f"mesa-mobility-{port}"

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Serve or refuse one request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {
            name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]
        }
        refusal = self._refusal(scope, headers)
        if refusal:
            await _answer(scope, send, 403, refusal)
        elif scope["type"] == "http" and self._has_token(scope, {}):
            await _answer(scope, send, 303, "", self._exchange(scope))
        elif not (self._has_cookie(headers) or self._has_token(scope, headers)):
            await _answer(scope, send, 403, NO_TOKEN)
        elif not self._is_needed(scope):
            await _answer(scope, send, 404, "there is no such page")
        else:
            await self._app(scope, receive, _with_headers(send))

    def _refusal(self, scope: Any, headers: Mapping[str, str]) -> str:
        """Why a request is not let through, or ""."""
        host = headers.get("host", "")
        if not self._names.are(host):
            return "this server is not known by that name"
        origin = headers.get("origin")
        if origin is None:
            reads = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
            return "" if reads else "expected an Origin"
        return "" if is_own_origin(origin, host) else "pages of other sites have no access"

    def _has_cookie(self, headers: Mapping[str, str]) -> bool:
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return False
        return found is not None and same_token(found.value, self._token)

    def _has_token(self, scope: Any, headers: Mapping[str, str]) -> bool:
        query = scope["query_string"].decode("latin-1")
        return same_token(token_in(query, [headers.get("authorization", "")]), self._token)

    def _is_needed(self, scope: Any) -> bool:
        """Whether the page needs what is asked for."""
        path = scope["path"]
        kind = "WebSocket" if scope["type"] == "websocket" else scope["method"]
        kind = "GET" if kind == "HEAD" else kind
        if kind == "GET" and path.startswith(ASSETS):
            below = path.removeprefix(ASSETS)
            return bool(PLAIN.fullmatch(below)) and os.path.isfile(self._assets / below)
        return kind in ROUTES and bool(ROUTES[kind].fullmatch(path))

    def _exchange(self, scope: Any) -> list[tuple[bytes, bytes]]:
        """Headers that set the cookie and lead to the same address without the token."""
        pairs = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        rest = urlencode([pair for pair in pairs if pair[0] != TOKEN])
        # An address of two slashes would lead to another host.
        path = quote("/" + scope["path"].lstrip("/\\"))
        place = path + (f"?{rest}" if rest else "")
        cookie = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"
        return [
            (b"location", place.encode("ascii")),
            (b"set-cookie", cookie.encode("latin-1")),
            (b"cache-control", b"no-store"),
        ]


def _with_headers(send: Any) -> Any:
    async def sent(message: Any) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", []), *HEADERS]}
        await send(message)

    return sent


async def _answer(
    scope: Any, send: Any, status: int, text: str, headers: list[tuple[bytes, bytes]] | None = None
) -> None:
    """Answer a request without the application; a WebSocket is not opened."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    plain = (b"content-type", b"text/plain; charset=utf-8")
    start = {
        "type": "http.response.start",
        "status": status,
        "headers": [plain, *(headers or []), *HEADERS],
    }
    await send(start)
    await send({"type": "http.response.body", "body": f"{text}\n".encode()})
