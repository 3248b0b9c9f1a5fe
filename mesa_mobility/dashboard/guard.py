"""Access to the dashboard's server: not from pages of other sites, not in frames, and on a network
only with the token."""

from __future__ import annotations

from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from mesa_mobility.live.access import Names, is_own_origin, same_token

HEADERS = (
    (b"content-security-policy",
     b"default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
     b"base-uri 'self'; form-action 'self'; frame-ancestors 'none'"),
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
)  # fmt: skip
"""Headers of each response: nothing is loaded from other hosts, and no page may frame this one."""

TOKEN = "token"


class Guard:
    """An ASGI application that passes only requests of its own pages to another.

    A request is refused if its ``Host`` is not this server, so that other names pointed at this
    machine do not work; if its ``Origin`` is not that host; if it opens a WebSocket or changes
    something without an ``Origin``; and, with a token, if it has neither the token in its address
    nor the cookie for which the token was exchanged.

    Args:
        app: the application to guard.
        host: address that the server listens on.
        port: port that it listens on.
        token: required token, or "" for none.
    """

    def __init__(self, app: Any, host: str, port: int, token: str = "") -> None:
        self._app = app
        self._names = Names(host)
        self._token = token
        # A cookie is valid for all ports of a host, so its name has the port.
        self._cookie = f"mesa-mobility-{port}"

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Serve or refuse one request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1")
                   for name, value in scope["headers"]}  # fmt: skip
        refusal = self._refusal(scope, headers)
        if refusal:
            await _answer(scope, send, 403, refusal)
        elif not self._token or self._has_cookie(headers):
            await self._app(scope, receive, _with_headers(send))
        elif self._has_token(scope):
            await _answer(scope, send, 303, "", self._exchange(scope))
        else:
            await _answer(scope, send, 403, "open the address that the command has printed")

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

    def _has_token(self, scope: Any) -> bool:
        if scope["type"] != "http":
            return False
        given = dict(parse_qsl(scope["query_string"].decode("latin-1"))).get(TOKEN, "")
        return same_token(given, self._token)

    def _exchange(self, scope: Any) -> list[tuple[bytes, bytes]]:
        """Headers that set the cookie and lead to the same address without the token."""
        pairs = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        rest = urlencode([pair for pair in pairs if pair[0] != TOKEN])
        # An address of two slashes would lead to another host.
        path = quote("/" + scope["path"].lstrip("/\\"))
        place = path + (f"?{rest}" if rest else "")
        cookie = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Lax"
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
    start = {"type": "http.response.start", "status": status,
             "headers": [plain, *(headers or []), *HEADERS]}  # fmt: skip
    await send(start)
    await send({"type": "http.response.body", "body": f"{text}\n".encode()})
