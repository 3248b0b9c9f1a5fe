"""A served model over real sockets: who gets in, what comes, and what cannot disturb the run."""

import contextlib
import json
import socket
import time

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from mesa_mobility.errors import MobilityError
from mesa_mobility.live.frames import COLUMNS
from mesa_mobility.live.server import MOST_BYTES, MOST_CLIENTS, origins_of
from tests.fixtures.waiting import until
from tests.live.conftest import Client, walkers


def goes_on(served):
    """Assert that time goes by, and that a client is served."""
    with served.client() as client:
        first = client.frame().frame
        client.until(lambda frame: frame.frame > first + 2)


def test_frames_are_the_positions_of_the_same_model_without_a_server(serve_model):
    plain = walkers(record=True)
    served = serve_model(walkers())
    with served.client() as binary, served.client("json") as text:
        for client in (binary, text):
            frames = [client.frame() for _ in range(12)]
            while plain.frame < frames[-1].frame:
                plain.step()
            arrays = plain.recorder.arrays()
            for frame in frames:
                rows = arrays["frame"] == frame.frame
                assert frame.person.tolist() == arrays["person"][rows].tolist() == [0, 1, 2]
                for name in ("x", "y", "heading"):
                    assert getattr(frame, name).tobytes() == arrays[name][rows].tobytes()
            numbers = [frame.number for frame in frames]
            assert numbers == sorted(set(numbers))


def test_time_is_real_and_begins_with_the_first_client(served):
    time.sleep(0.3)
    assert served.model.frame == 0
    with served.client() as client:
        first = client.frame()
        begun = time.monotonic()
        last = client.until(lambda frame: frame.frame >= first.frame + 30)
        took = time.monotonic() - begun
    assert first.frame <= 2
    # At most 0.2 s of delay are made up for.
    assert (last.frame - first.frame) / 30 - 0.25 < took < (last.frame - first.frame) / 30 + 5.0


def test_frames_come_as_often_as_asked(serve_model):
    with serve_model(walkers(), rate=10).client() as client:
        client.until(lambda frame: frame.frame > 0)
        numbers = [client.frame().frame for _ in range(4)]
    assert np.all(np.diff(numbers) % 3 == 0)
    assert np.diff(numbers).min() == 3


def test_a_client_is_first_told_the_full_state(served):
    with served.client() as client:
        scene = client.receive()
        assert scene["type"] == "scene"
        assert (scene["protocol"], scene["rate"]) == (1, 30)
        assert scene["people"] == {
            "person": [0, 1, 2],
            "type": ["made by hand"] * 3,
            "core_radius": [0.15] * 3,
        }
        kinds = [each["properties"]["kind"] for each in scene["plan"]["features"]]
        assert kinds == ["walkable", "exit"]
        assert len(client.frame()) == 3
        assert client.others == []


def test_changes_are_told_before_the_frame_in_which_they_count(served):
    with served.client() as client:
        client.frame()
        client.tell("pause")
        client.others.clear()
        assert client.tell("add", positions=[[5.0, 1.0]])["people"] == [3]
        assert 3 in client.until(lambda frame: len(frame) == 4).person
        told = [each for each in client.others if each["type"] == "people"]
        assert [each["people"]["person"] for each in told] == [[3]]
        client.tell("close", opening="east")
        client.frame()
        plans = [each["plan"] for each in client.others if each["type"] == "plan"]
        assert plans[-1]["features"][1]["properties"]["closed"] is True


def test_time_stands_still_while_paused(served):
    with served.client() as client:
        client.tell("pause", id=1)
        frame = client.until(lambda frame: frame.paused).frame
        time.sleep(0.2)
        client.tell("resume", id="two")
        later = client.until(lambda frame: not frame.paused)
        assert later.frame <= frame + 1
        client.until(lambda frame: frame.frame > later.frame + 2)


def test_answers_have_the_commands_number(served):
    with served.client("json") as client:
        assert client.tell("resume", id=17) == {"type": "done", "id": 17}
        assert client.tell("open", opening="west", id="x") == {
            "type": "error",
            "id": "x",
            "error": "there is no gate or exit 'west'; there are 'east'",
        }


@pytest.mark.parametrize("token", [None, "", "wrong", "%ff%00"])
def test_nobody_gets_in_without_the_token(served, token):
    query = "" if token is None else f"?token={token}"
    with pytest.raises(InvalidStatus) as refused:
        Client(connect(f"ws://127.0.0.1:{served.port}/{query}"))
    assert refused.value.response.status_code == 403
    until(lambda: served.lines)
    assert served.lines == ["refused a connection: expected the token that the command has printed"]
    goes_on(served)


def test_the_token_may_be_a_header(served):
    headers = {"Authorization": "Bearer a token of the tests"}
    with Client(connect(f"ws://127.0.0.1:{served.port}", additional_headers=headers)) as client:
        assert len(client.frame()) == 3


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "file://", "http://127.0.0.1:1", "http://["]
)
def test_pages_of_other_sites_do_not_get_in(served, origin):
    with pytest.raises(InvalidStatus) as refused:
        Client(connect(served.address(), origin=origin))
    assert refused.value.response.status_code == 403
    goes_on(served)


def test_pages_that_were_named_get_in(serve_model):
    served = serve_model(walkers(), origins=origins_of(["http://App.example:8000/"]))
    for origin in ("http://app.example:8000", f"http://127.0.0.1:{served.port}"):
        with Client(connect(served.address(), origin=origin)) as client:
            assert len(client.frame()) == 3
    with pytest.raises(InvalidStatus):
        Client(connect(served.address(), origin="http://app.example"))


@pytest.mark.parametrize("text", ["app.example", "http://", "http://a/b", ""])
def test_what_is_no_origin_is_refused(text):
    with pytest.raises(MobilityError, match="expected such as http://localhost:8000"):
        origins_of([text])


def status_of(port, *lines):
    """The status line of the answer to a request."""
    with socket.create_connection(("127.0.0.1", port), timeout=20) as plain:
        plain.sendall(("\r\n".join(lines) + "\r\n\r\n").encode("latin-1"))
        with contextlib.suppress(ConnectionError):
            return plain.recv(4096).decode("latin-1").partition("\r\n")[0]
    return ""


HANDSHAKE = [
    "Connection: Upgrade",
    "Upgrade: websocket",
    "Sec-WebSocket-Version: 13",
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
]


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1:{0}", "101"),
        ("localhost", "101"),
        ("evil.example", "403"),
        ("192.168.1.5:{0}", "403"),
        ("", "403"),
        ("[", "403"),
    ],
)
def test_the_server_answers_by_its_own_names_alone(served, host, expected):
    path = served.address().partition(str(served.port))[2]
    given = f"Host: {host.format(served.port)}"
    assert f" {expected} " in status_of(served.port, f"GET {path} HTTP/1.1", given, *HANDSHAKE)


@pytest.mark.parametrize(
    ("path", "expected"), [("/elsewhere?{0}", "404"), ("/?form=xml&{0}", "400"), ("//[?{0}", "40")]
)
def test_other_addresses_are_refused(served, path, expected):
    query = served.address().partition("?")[2]
    line = f"GET {path.format(query)} HTTP/1.1"
    assert f" {expected}" in status_of(served.port, line, "Host: 127.0.0.1", *HANDSHAKE)
    goes_on(served)


@pytest.mark.parametrize("garbage", [b"\x16\x03\x01\x02\x00", b"\0" * 9000, b"GET\r\n\r\n", b""])
def test_garbage_on_the_port_is_told_on_one_line_and_the_run_goes_on(served, garbage):
    with socket.create_connection(("127.0.0.1", served.port), timeout=20) as plain:
        plain.sendall(garbage)
        plain.shutdown(socket.SHUT_WR)
        with contextlib.suppress(ConnectionError):
            while plain.recv(4096):
                pass
    goes_on(served)
    assert len(served.lines) <= 1
    assert all(len(line.splitlines()) == 1 for line in served.lines)


@pytest.mark.parametrize(
    "garbage",
    [
        "",
        "{",
        "[]",
        '"walk"',
        "{}",
        '{"do": "fly"}',
        "[" * 20_000,
        '{"id": 1e999}',
        "é\0ü",
        b"\x00\x01\x02",
    ],
)
def test_garbage_from_a_client_is_refused_on_one_line_and_the_run_goes_on(served, garbage):
    with served.client() as client:
        answer = client.send(garbage)
        assert answer["type"] == "error"
        assert len(answer["error"].splitlines()) == 1
        # The same connection still serves.
        assert client.tell("resume")["type"] == "done"


def test_a_message_that_is_too_long_ends_its_connection_alone(served):
    with served.client() as client, served.client() as other:
        with contextlib.suppress(ConnectionClosed):
            client.socket.send("x" * (MOST_BYTES + 1))
            while True:
                client.frame()
        first = other.frame().frame
        other.until(lambda frame: frame.frame > first + 3)


def test_a_client_that_dies_comes_back_to_the_full_state(served):
    client = served.client()
    client.tell("add", positions=[[5.0, 1.0]])
    client.tell("steer", person=0, velocity=[0.0, 0.0])
    died = client.frame().frame
    # As a process that is killed: no closing handshake.
    client.socket.socket.shutdown(socket.SHUT_RDWR)
    until(lambda: len(served.run.orders.steered()) == 0)
    with served.client() as again:
        scene = again.receive()
        assert scene["type"] == "scene"
        assert scene["people"]["person"] == [0, 1, 2, 3]
        frame = again.frame()
        assert frame.frame >= died
        assert frame.person.tolist() == [0, 1, 2, 3]


def test_a_slow_client_loses_frames_and_slows_nothing(serve_model, monkeypatch):
    monkeypatch.setattr("mesa_mobility.live.server.SEND_BUFFER", 2**14)
    model = walkers()
    x, y = np.meshgrid(np.arange(5.0, 75.0, 0.5), [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5])
    # 983 people, whose frames have 43 kB.
    model.add_pedestrians(np.column_stack([x.ravel(), y.ravel()]), pre_movement=1000.0)
    served = serve_model(model)
    narrow = socket.socket()
    narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2**14)
    narrow.connect(("127.0.0.1", served.port))
    slow, quick = served.client(sock=narrow, max_queue=1), served.client()
    with slow, quick:
        slow.frame()
        # Before time goes by, commands publish frames too.
        first = quick.until(lambda frame: frame.frame > 0)
        last = quick.until(lambda frame: frame.frame > first.frame + 30)
        assert last.frame - first.frame == last.number - first.number
        # Held for the slow client: one frame at most, and the library's own 32 kB.
        held = [each.transport.get_write_buffer_size() for each in served.server._clients]
        assert max(held) < len(first.to_bytes()) + 2**15 + 2**10
        numbers = [slow.frame().number for _ in range(8)]
        assert np.diff(numbers).max() > 10


def test_more_clients_than_there_is_room_for_are_refused(served, monkeypatch):
    monkeypatch.setattr("mesa_mobility.live.server.MOST_CLIENTS", 2)
    with served.client() as one, served.client() as two:
        one.frame(), two.frame()
        with pytest.raises(InvalidStatus) as refused:
            served.client()
    assert refused.value.response.status_code == 503
    assert MOST_CLIENTS == 32


def test_a_model_that_fails_ends_the_server_with_its_error(served):
    def fail():
        raise ZeroDivisionError("in a plug-in")

    with served.client() as client:
        client.frame()
        served.model.step = fail
        served.thread.join(20)
        with pytest.raises(ConnectionClosed):
            client.until(lambda frame: False)
    assert isinstance(served.ended, ZeroDivisionError)


def test_a_plug_in_that_fails_in_a_command_is_told(served):
    def fail(*_, **__):
        raise ZeroDivisionError("two\nlines")

    with served.client() as client:
        client.frame()
        served.model.add_pedestrians = fail
        answer = client.tell("add", positions=[[5, 1]], id=3)
        assert answer == {"type": "error", "id": 3, "error": "ZeroDivisionError: two lines"}
    goes_on(served)


def test_columns_are_those_of_the_crowd(served):
    with served.client("json") as client:
        client.frame()
        client.tell("pause")
        frame = client.until(lambda frame: frame.paused)
        for name in COLUMNS:
            expected = getattr(served.model.crowd, name)[:3]
            assert getattr(frame, name).tobytes() == expected.tobytes()
        assert json.loads(frame.to_json())["person"] == [0, 1, 2]
