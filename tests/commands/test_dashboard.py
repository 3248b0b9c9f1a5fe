"""`mesa-mobility dashboard`: what it refuses."""

import importlib.util
import socket

import pytest

from mesa_mobility.commands import dashboard


def test_an_unknown_model_is_refused(command):
    ended = command("dashboard", "doorways")
    assert ended.status == 2
    assert ended.err.startswith("error: unknown model 'doorways', did you mean 'doorway'?")


def test_without_solara_it_says_what_to_install(command, monkeypatch):
    monkeypatch.setattr(dashboard, "find_spec", lambda name: None)
    ended = command("dashboard", "doorway")
    assert ended.status == 2
    assert ended.err == (
        "error: the dashboard needs Solara: pip install 'mesa-mobility[viz]' brings what it needs\n"
    )


@pytest.mark.skipif(importlib.util.find_spec("solara") is None, reason="no solara")
def test_a_port_that_is_taken_gives_an_error(command):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        ended = command("dashboard", "doorway", "--port", port)
    assert ended.status == 2
    assert ended.err == (
        f"error: 127.0.0.1:{port} cannot be listened on: Address already in use; "
        "--host and --port choose another address\n"
    )
    assert command("dashboard", "doorway", "--port", 0).status == 2


@pytest.mark.parametrize("server", ["dashboard", "serve"])
def test_a_token_that_can_be_guessed_is_refused(command, monkeypatch, server):
    pytest.importorskip({"dashboard": "solara", "serve": "websockets"}[server])
    monkeypatch.setenv("MESA_MOBILITY_TOKEN", "secret")
    ended = command(server, "doorway")
    assert ended.status == 2
    assert ended.err == (
        "error: MESA_MOBILITY_TOKEN: got 6 characters, expected 16 to 200 letters, digits, '-', "
        "'_', '.' or '~'\n"
    )
