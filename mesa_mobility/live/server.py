"""The WebSocket server of a running model."""

from __future__ import annotations

import asyncio
import json
import logging
import signal
import socket
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from http import HTTPStatus
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from mesa_mobility.errors import MobilityError
from mesa_mobility.live.access import HEAD_SECONDS, Names, is_own_origin, same_token, token_in
from mesa_mobility.live.commands import Refused, read_command
from mesa_mobility.live.run import Engine, Run
from mesa_mobility.live.snapshot import Snapshot, Told

BINARY, JSON = "binary", "json"
"""Forms of frames."""

MOST_CLIENTS = 32

LONGEST_STEP = 10.0
"""Seconds for which the end waits for the step under way."""

MOST_BYTES = 2**16
"""Of a command."""

SEND_BUFFER = 2**18
"""Bytes of frames that the system holds for a client that does not read them."""

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Access:
    """Who may connect.

    Attributes:
        host: address that the server listens on.
        token: required token.
        origins: pages of these origins may connect besides the server's own.
    """

    host: str
    token: str
    origins: frozenset[str] = frozenset()

    @cached_property
    def _names(self) -> Names:
        # Looking up the machine's own names may take long.
        return Names(self.host)

    def refusal(self, request: Request) -> str:
        """Why a request is not let through, or ""."""
        hosts = request.headers.get_all("Host")
        if len(hosts) != 1 or not self._names.are(hosts[0]):
            return "this server is not known by that name"
        for origin in request.headers.get_all("Origin"):
            if not (is_own_origin(origin, hosts[0]) or origin.lower() in self.origins):
                return "pages of other sites have no access"
        given = token_in(urlsplit(request.path).query, request.headers.get_all("Authorization"))
        if not same_token(given, self.token):
            return "expected the token that the command has printed"
        return ""


class LiveServer:
    """Sends the frames of one model to its clients, and their commands to the model.

    Time begins with the first client.

    Args:
        run: the model.
        rate: frames published in a simulated second.
        access: who may connect.
        report: called with one line about each refused connection.
    """

    def __init__(self, run: Run, rate: int, access: Access, report: Callable[[str], None]) -> None:
        self._access, self._report = access, report
        self._engine = Engine(run, rate, self._publish, self._fail)
        self._clients: set[ServerConnection] = set()
        self._begun = False
        self._now: Snapshot | None = None
        # Written by the engine's thread alone, and read by the loop alone.
        self._newest: Snapshot | None = None
        self._called = False
        self._names = 0

    async def serve(self, listening: socket.socket, ready: Callable[[], None]) -> None:
        """Serve until interrupted.

        Raises:
            MobilityError: a step of the model has failed.
            Exception: an error of a plug-in.
        """
        self._loop = asyncio.get_running_loop()
        self._fresh, self._ended = asyncio.Event(), self._loop.create_future()
        # Accepted sockets have the buffer of the listening one.
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        self._engine.start()
        with suppress(NotImplementedError, RuntimeError):
            self._loop.add_signal_handler(signal.SIGINT, self._end)
        async with self._listen(listening):
            ready()
            try:
                await self._ended
            finally:
                self._engine.close()
        # Python must not end while the thread is in compiled code.
        self._engine.join(LONGEST_STEP)

    def _listen(self, listening: socket.socket) -> Any:
        return serve(
            self._serve_client,
            sock=listening,
            process_request=self._let_in,
            compression=None,
            max_size=MOST_BYTES,
            open_timeout=HEAD_SECONDS,
            close_timeout=2.0,
            logger=_quiet_logger(self._report),
        )

    def _end(self) -> None:
        if not self._ended.done():
            self._ended.set_result(None)

    def stop(self) -> None:
        """End serving, from any thread."""
        self._loop.call_soon_threadsafe(self._end)

    def _publish(self, snapshot: Snapshot) -> None:
        """Hand a snapshot to the loop, which may miss some but holds one at most."""
        self._newest = snapshot
        if not self._called:
            self._called = True
            # The loop is closed where the server has ended.
            with suppress(RuntimeError):
                self._loop.call_soon_threadsafe(self._take)

    def _take(self) -> None:
        self._called = False
        self._now = self._newest
        self._fresh.set()
        self._fresh = asyncio.Event()

    def _fail(self, error: Exception) -> None:
        def end() -> None:
            if not self._ended.done():
                self._ended.set_exception(error)

        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(end)

    def _let_in(self, connection: ServerConnection, request: Request) -> Response | None:
        """Refuse a request, or None."""
        try:
            status, reason = self._refusal(request)
        except ValueError:
            status, reason = HTTPStatus.BAD_REQUEST, "not a readable address"
        if not reason:
            return None
        self._report(f"refused a connection: {reason}")
        return connection.respond(status, f"{reason}\n")

    def _refusal(self, request: Request) -> tuple[HTTPStatus, str]:
        """Why a request is not let through; an empty text if it is."""
        status, reason = HTTPStatus.FORBIDDEN, self._access.refusal(request)
        if not reason:
            place = urlsplit(request.path)
            form = dict(parse_qsl(place.query)).get("form", BINARY)
            if place.path not in ("", "/"):
                status, reason = HTTPStatus.NOT_FOUND, "expected the path /"
            elif form not in (BINARY, JSON):
                status, reason = HTTPStatus.BAD_REQUEST, "form: expected binary or json"
            elif len(self._clients) >= MOST_CLIENTS:
                status, reason = HTTPStatus.SERVICE_UNAVAILABLE, f"has {MOST_CLIENTS} clients"
        return status, reason

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert connection.request is not None
        query = dict(parse_qsl(urlsplit(connection.request.path).query))
        self._names += 1
        name = self._names
        self._clients.add(connection)
        if not self._begun:
            self._begun = True
            self._engine.post(_begin)
        sending = asyncio.create_task(self._send(connection, query.get("form") == JSON))
        try:
            await self._receive(connection, name)
        except ConnectionClosed:
            pass
        finally:
            self._clients.discard(connection)
            sending.cancel()
            self._engine.post(lambda run: _drop(run, name))

    async def _send(self, connection: ServerConnection, text: bool) -> None:
        """Send the newest frame whenever the client has taken the one before."""
        told, last = Told(), None
        with suppress(ConnectionClosed):
            while True:
                while self._now is None or self._now is last:
                    await self._fresh.wait()
                last = self._now
                for message in told.missing(last):
                    await connection.send(message)
                await connection.send(last.text if text else last.binary)

    async def _receive(self, connection: ServerConnection, name: int) -> None:
        """Execute one command after the other; a client with many waits for its answers."""
        async for message in connection:
            number: Any = None
            try:
                if not isinstance(message, str):
                    raise Refused("command: got a binary message, expected a text")
                number, command = read_command(message, name)
                answer = await asyncio.wrap_future(self._engine.post(command))
                values = {"type": "done", "id": number, **answer}
            except Refused as error:
                values = {"type": "error", "id": error.id, "error": str(error)}
            except Exception as error:
                values = {"type": "error", "id": number, "error": _said(error)}
            await connection.send(json.dumps(values))


def _begin(run: Run) -> dict[str, Any]:
    run.set_playing(True)
    return {}


def _drop(run: Run, name: int) -> dict[str, Any]:
    run.drop(name)
    return {}


def _said(error: Exception) -> str:
    if isinstance(error, MobilityError):
        return str(error)
    log.exception("in a model or a behaviour")
    return f"{type(error).__name__}: {' '.join(str(error).split())}"


class _OneLine(logging.Handler):
    """Reports what goes wrong with a connection on one line."""

    def __init__(self, report: Callable[[str], None]) -> None:
        super().__init__(logging.ERROR)
        self._report = report

    def emit(self, record: logging.LogRecord) -> None:
        """Report a record, without its traceback."""
        text, error = record.getMessage(), record.exc_info[1] if record.exc_info else None
        # The library's own error has the client's as its cause.
        reason = "" if error is None else f": {error.__cause__ or error}"
        self._report(" ".join(f"{text}{reason}".split()))


def _quiet_logger(report: Callable[[str], None]) -> logging.Logger:
    """A logger of its own for each server, whose lines go nowhere else."""
    logger = logging.Logger("mesa_mobility.live")
    logger.addHandler(_OneLine(report))
    return logger


def origins_of(texts: Iterable[str]) -> frozenset[str]:
    """Origins as browsers send them, in small letters.

    Raises:
        MobilityError: a text that is no origin.
    """
    found = set()
    for text in texts:
        place = urlsplit(text)
        if text != "null" and not (place.scheme and place.netloc and place.path in ("", "/")):
            raise MobilityError(f"--origin {text}: expected such as http://localhost:8000")
        found.add(text.lower().rstrip("/"))
    return frozenset(found)
