"""The token of a server, and connections that never ask for anything."""

import contextlib
import socket
import time

import pytest

from mesa_mobility.errors import MobilityError
from mesa_mobility.live.access import own_token, token_in
from tests.live.test_server import goes_on


def test_each_server_has_a_token_of_its_own(monkeypatch):
    monkeypatch.delenv("MESA_MOBILITY_TOKEN", raising=False)
    tokens = {own_token() for _ in range(100)}
    assert len(tokens) == 100
    assert min(map(len, tokens)) == 32  # 24 bytes in base 64


@pytest.mark.parametrize("token", ["a" * 16, "b" * 200, "AZaz09._~-AZaz09"])
def test_the_environment_gives_a_token(monkeypatch, token):
    monkeypatch.setenv("MESA_MOBILITY_TOKEN", token)
    assert own_token() == token
    assert token_in(f"form=json&token={token}", []) == token


@pytest.mark.parametrize("token", ["", "a" * 15, "b" * 201, "a b" * 8, "a&b=" * 8, "ä" * 20])
def test_a_token_that_is_short_or_does_not_fit_in_an_address_is_refused(monkeypatch, token):
    monkeypatch.setenv("MESA_MOBILITY_TOKEN", token)
    with pytest.raises(MobilityError, match=f"TOKEN: got {len(token)} characters, expected 16 to"):
        own_token()


@pytest.mark.thorough
def test_250_connections_that_hold_back_their_request_are_closed_and_the_run_goes_on(served):
    goes_on(served)  # the first step may have to be compiled
    began = time.monotonic()
    held = [socket.create_connection(("127.0.0.1", served.port), timeout=15) for _ in range(250)]
    for connection in held[::2]:
        connection.sendall(b"GET /?token=")
    goes_on(served)
    for connection in held:
        connection.settimeout(max(began + 15.0 - time.monotonic(), 0.01))
        with contextlib.suppress(ConnectionError):
            while connection.recv(4096):
                pass
        connection.close()
    assert 8.0 < time.monotonic() - began < 15.0
    assert all(len(line.splitlines()) == 1 for line in served.lines)
