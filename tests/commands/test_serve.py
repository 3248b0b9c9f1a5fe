"""`mesa-mobility serve`: what it prints and refuses, and how it ends."""

import json
import re
import signal
import socket
import subprocess
import sys

import pytest

pytest.importorskip("websockets", reason="no websockets: pip install 'mesa-mobility[live]'")

from websockets.sync.client import connect

from mesa_mobility.commands import serve
from mesa_mobility.live.frames import read_frame
from tests.fixtures.buildings import two_storeys


@pytest.fixture
def serving():
    """Starts `mesa-mobility serve ARGUMENTS...` on a free port."""
    started = []

    def start(*arguments):
        words = [sys.executable, "-m", "mesa_mobility", "serve", *map(str, arguments)]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        started.append(subprocess.Popen([*words, "--port", "0"], **pipes))
        return started[-1]

    yield start
    for each in started:
        each.kill()
        each.communicate()


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_it_prints_the_address_with_the_token_and_ends_at_ctrl_c(serving):
    process = serving("doorway", "--seed", 1, "--set", "pedestrians=5", "--rate", 10)
    address = process.stdout.readline().strip()
    assert re.fullmatch(r"ws://127\.0\.0\.1:\d+/\?token=[\w-]{32,}", address)
    with connect(address) as client:
        scene = json.loads(client.recv(timeout=60))
        assert (scene["model"], scene["rate"]) == ("Doorway", 10)
        assert len(read_frame(client.recv(timeout=60))) == 5
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == "doorway, seed 1: connect to the address below (Ctrl-C ends)\n"


@pytest.mark.thorough
def test_a_model_in_a_file_is_served(serving, tmp_path):
    (tmp_path / "room.py").write_text(
        "from mesa_mobility import Exit, FloorPlan, PedestrianModel\n"
        "class Room(PedestrianModel):\n"
        "    def __init__(self, rng=None):\n"
        "        plan = FloorPlan('POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))',\n"
        "                         exits=[Exit('door', (6, 1.5), (6, 2.5))])\n"
        "        super().__init__(plan, rng=rng)\n"
    )
    process = serving(tmp_path / "room.py")
    with connect(process.stdout.readline().strip()) as client:
        assert json.loads(client.recv(timeout=60))["model"] == "Room"
        frames = [read_frame(client.recv(timeout=60)) for _ in range(5)]
    # Nobody is inside, and time goes by all the same.
    assert frames[-1].frame > frames[0].frame


@pytest.mark.thorough
@pytest.mark.parametrize("how", ["file", "setting", "model"])
def test_buildings_are_served(serving, tmp_path, how):
    building, file = two_storeys(), tmp_path / "office.geojson"
    building.write_geojson(file)
    arguments = {
        "file": [file, "--set", "pedestrians=6"],
        "setting": ["floor_plan", "--set", f"plan={file}", "--set", "pedestrians=6"],
        "model": ["office_tower", "--set", "pedestrians=12"],
    }
    process = serving(*arguments[how], "--seed", 1)
    with connect(process.stdout.readline().strip()) as client:
        plan = json.loads(client.recv(timeout=60))["plan"]
        frame = read_frame(client.recv(timeout=60))
    assert {"walkable", "stairs", "exit"} <= {
        each["properties"]["kind"] for each in plan["features"]
    }
    elevations = {
        each["properties"]["level"]: each["properties"]["elevation"]
        for each in plan["features"]
        if each["properties"]["kind"] == "walkable"
    }
    # Nobody has got far, and nobody begins on stairs.
    assert len(frame) > 0
    assert frame.z.tolist() == [elevations[level] for level in frame.level.tolist()]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["doorways"], "unknown model 'doorways', did you mean 'doorway'?"),
        (["doorway", "--rate", 7], "rate: got 7, expected 1, 2, 3, 5, 6, 10, 15 or 30 frames/s"),
        (["doorway", "--origin", "here"], "--origin here: expected such as http://localhost:8000"),
        (["doorway", "--port", 70000], "Invalid value for '--port'"),
        (["doorway", "--preset", "mine"], "preset 'mine' is unknown"),
        (["no_such.py"], "no_such.py: no such file"),
    ],
)
def test_what_it_cannot_do_is_one_line(command, arguments, message):
    if "--port" not in arguments:
        arguments = [*arguments, "--port", 0]
    ended = command("serve", *arguments)
    assert (ended.status, ended.out) == (2, "")
    assert message in ended.err
    assert len(ended.err.splitlines()) == 1


def test_a_port_that_is_taken_gives_an_error(command):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        ended = command("serve", "doorway", "--port", port)
    assert ended.status == 2
    assert f"127.0.0.1:{port} cannot be listened on" in ended.err


def test_without_websockets_it_says_what_to_install(command, monkeypatch):
    monkeypatch.setattr(serve, "find_spec", lambda name: None)
    ended = command("serve", "doorway")
    assert ended.status == 2
    assert ended.err == (
        "error: serve needs websockets: pip install 'mesa-mobility[live]' brings what it needs\n"
    )
