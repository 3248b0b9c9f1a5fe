"""Connections that hold back their request are closed, so that they do not fill up the server.

Uvicorn's own limits begin with the first answer, and its limit of connections would refuse the page
as well.
"""

from __future__ import annotations

from asyncio import BaseTransport, TimerHandle
from typing import ClassVar

from uvicorn.protocols.http.h11_impl import H11Protocol

from mesa_mobility.live.access import HEAD_SECONDS

MOST_WAITING = 64
"""Connections that may owe a request at once. Browsers send one within milliseconds, so the oldest
is closed when another comes."""


class PromptProtocol(H11Protocol):
    """HTTP/1.1 for clients that send the head of each request within ``HEAD_SECONDS``.

    The time begins with the connection, and later with the first byte after an answer; further
    bytes do not prolong it.
    """

    _waiting: ClassVar[dict[PromptProtocol, TimerHandle]] = {}

    def connection_made(self, transport: BaseTransport) -> None:
        """Expect a request."""
        super().connection_made(transport)  # type: ignore[arg-type]
        self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        """Expect nothing more."""
        self._stop()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take in bytes of a request."""
        super().data_received(data)
        answering = self.cycle is not None and not self.cycle.response_complete
        if answering or self.transport.get_protocol() is not self:  # a WebSocket's by now
            self._stop()
        else:
            self._expect()

    def _expect(self) -> None:
        if self in self._waiting:
            return
        if len(self._waiting) >= MOST_WAITING:
            next(iter(self._waiting))._close()
        self._waiting[self] = self.loop.call_later(HEAD_SECONDS, self._close)

    def _stop(self) -> None:
        timer = self._waiting.pop(self, None)
        if timer is not None:
            timer.cancel()

    def _close(self) -> None:
        self._stop()
        self.transport.abort()
