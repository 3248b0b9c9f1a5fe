"""Connections that hold back their request, on a server whose patience is short."""

import asyncio
import contextlib
import socket
import threading
import time

import pytest

pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")

import uvicorn

from mesa_mobility.dashboard.serving import connections
from tests.fixtures.waiting import until

PATIENCE, MOST = 0.3, 5
WHOLE = b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"


async def answer(scope, receive, send):
    """An answer that takes longer than a client may take to ask."""
    if scope["type"] == "http":
        await asyncio.sleep(2 * PATIENCE if scope["path"] == "/late" else 0)
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body"})
    elif scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        await asyncio.sleep(2 * PATIENCE)
        await send({"type": "websocket.send", "text": "still here"})


@pytest.fixture
def port(monkeypatch):
    monkeypatch.setattr(connections, "HEAD_SECONDS", PATIENCE)
    monkeypatch.setattr(connections, "MOST_WAITING", MOST)
    config = uvicorn.Config(
        answer, port=0, http=connections.PromptProtocol, log_level="error", lifespan="off"
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    until(lambda: server.started, 10)
    yield server.servers[0].sockets[0].getsockname()[1]
    server.should_exit = True
    thread.join(10)
    assert not connections.PromptProtocol._waiting


def ask(port, path="/", more=""):
    """What comes for a request within a second, until the server has no more to say."""
    with socket.create_connection(("127.0.0.1", port), timeout=1.0) as connection:
        connection.sendall(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n{more}\r\n".encode())
        answer = connection.recv(4096)
        with contextlib.suppress(TimeoutError):
            while more and b"still here" not in answer:
                answer += connection.recv(4096)
    return answer


def closed_after(port, first, then=b""):
    """Seconds after which the server closes a connection that sends a byte now and then."""
    began = time.monotonic()
    with socket.create_connection(("127.0.0.1", port), timeout=0.02) as connection:
        connection.sendall(first)
        while time.monotonic() < began + 3.0:
            try:
                if connection.recv(4096) == b"":
                    break
                connection.sendall(then)
            except TimeoutError:
                with contextlib.suppress(ConnectionError):
                    connection.send(then[:1])
            except ConnectionError:
                break
    return time.monotonic() - began


@pytest.mark.parametrize("first", [b"", b"G", WHOLE[:-2], WHOLE])
def test_who_holds_back_a_request_is_cut_off(port, first):
    assert closed_after(port, first, b"x") == pytest.approx(PATIENCE, abs=PATIENCE)


def test_a_late_answer_and_a_socket_are_waited_for(port):
    assert ask(port, "/late").startswith(b"HTTP/1.1 204 ")
    upgrade = (
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    )
    assert b"still here" in ask(port, "/", upgrade)


def test_many_who_hold_back_a_request_keep_nobody_out(port, monkeypatch):
    monkeypatch.setattr(connections, "HEAD_SECONDS", 60.0)
    held = [socket.create_connection(("127.0.0.1", port), timeout=5) for _ in range(4 * MOST)]
    assert ask(port).startswith(b"HTTP/1.1 204 ")
    # The newest stay, but one that made room for the request.
    for connection in held[: 3 * MOST + 1]:
        with contextlib.suppress(ConnectionError):
            assert connection.recv(1) == b""
    assert len(connections.PromptProtocol._waiting) == MOST - 1
    for connection in held:
        connection.close()
    until(lambda: not connections.PromptProtocol._waiting, 5)
