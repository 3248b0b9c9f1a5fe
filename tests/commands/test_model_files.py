"""Models in files of one's own, and floor plans without a model."""

import json
import sys
from importlib.util import find_spec

import pytest
from mesa_mobility.models import FloorPlanEgress

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel
from mesa_mobility.crowd.model_files import is_model_file, load_model_file
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider

ROOM = "from mesa_mobility import PedestrianModel\n\n\nclass Room(PedestrianModel):\n    pass\n"


@pytest.fixture(autouse=True)
def same_path(monkeypatch):
    """Loading a file makes what stands beside it importable; for one test alone."""
    monkeypatch.setattr(sys, "path", list(sys.path))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("room.py", True),
        ("a/b c/room.py:Room", True),
        (r"C:\models\room.py:Room", True),
        ("doorway", False),
        ("room.pyc", False),
        ("room:Room", False),
    ],
)
def test_what_names_a_file(text, expected):
    assert is_model_file(text) is expected


@pytest.mark.parametrize("name", ["", ":Room"])
def test_a_file_with_one_model_needs_no_name(tmp_path, name):
    (tmp_path / "room.py").write_text(ROOM)
    kind = load_model_file(f"{tmp_path / 'room.py'}{name}")
    assert kind.__name__ == "Room"
    assert issubclass(kind, PedestrianModel)


def test_imported_models_do_not_count_and_neighbours_are_found(tmp_path):
    (tmp_path / "beside_the_room.py").write_text("WIDTH = 3\n")
    (tmp_path / "room.py").write_text(
        "import beside_the_room\nfrom mesa_mobility.models import Doorway\n" + ROOM
    )
    assert load_model_file(str(tmp_path / "room.py")).__name__ == "Room"


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        ("x = 1\n", "", "room.py: has no model, expected a subclass of PedestrianModel"),
        (
            ROOM + "\n\nclass Hall(Room):\n    pass\n",
            "",
            "room.py: has several models, expected room.py:NAME, one of Room, Hall",
        ),
        (ROOM, ":Rom", "room.py: has no model 'Rom', did you mean 'Room'?; it has Room"),
        ("x = (\n", "", "room.py:1: cannot be loaded: SyntaxError: '(' was never closed"),
        (
            "x = 1\nimport no_such_thing\n",
            "",
            "room.py:2: cannot be loaded: ModuleNotFoundError: No module named 'no_such_thing'",
        ),
        (
            "def f():\n    1 / 0\n\n\nf()\n",
            "",
            "room.py:2: cannot be loaded: ZeroDivisionError: division by zero",
        ),
        ("raise ValueError('two\\nlines')\n", "", "room.py:1: cannot be loaded: ValueError: two"),
        ("raise SystemExit(3)\n", "", "room.py:1: cannot be loaded: SystemExit: 3"),
    ],
)
def test_bad_model_files_give_the_same_line_in_every_command(
    tmp_path, monkeypatch, command, text, name, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.py").write_text(text)
    for ended in every_command(command, tmp_path, f"room.py{name}"):
        assert ended.status == 2
        # An experiment knows a file by its whole path.
        said = ended.err.replace(f"{tmp_path}/", "")
        assert said.startswith(f"error: {message}")
        assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("dorway", "unknown model 'dorway', did you mean 'doorway'?; installed: "),
        ("room", "unknown model 'room', did you mean 'room.py'?; installed: "),
        ("none.py", "none.py: no such file, expected a Python file with a model"),
        ("no_such:Room", "model no_such:Room: cannot be loaded: ModuleNotFoundError: No module"),
        ("math:pi", "model math:pi: is not a class"),
    ],
)
def test_a_model_that_is_not_there_gives_the_same_line_in_every_command(
    tmp_path, monkeypatch, command, name, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.py").write_text(ROOM)
    for ended in every_command(command, tmp_path, name):
        assert (ended.status, ended.err.count("\n")) == (2, 1)
        assert ended.err.replace(f"{tmp_path}/", "").startswith(f"error: {message}")


def every_command(command, folder, model):
    """What the commands that take a model say of one that there is not."""
    (folder / "many.toml").write_text(f'model = "{model}"\n')
    yield command("run", model, "--no-progress")
    yield command("experiment", "run", folder / "many.toml", "--no-progress")
    if find_spec("solara") is not None:
        yield command("dashboard", model, "--port", free_port())
    if find_spec("websockets") is not None:
        yield command("serve", model, "--port", 0)


def test_a_model_in_a_file_runs_with_its_own_parameters(tmp_path, command):
    (tmp_path / "own_room.py").write_text(
        "from mesa_mobility import Exit, FloorPlan, PedestrianModel\n"
        "class Room(PedestrianModel):\n"
        "    def __init__(self, people: int = 2, rng=None):\n"
        "        plan = FloorPlan('POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))',\n"
        "                         exits=[Exit('door', (6, 1.5), (6, 2.5))])\n"
        "        super().__init__(plan, rng=rng)\n"
        "        self.add_pedestrians([(1 + i, 2) for i in range(people)])\n"
    )
    file, out = tmp_path / "own_room.py", tmp_path / "out"
    done = command(
        "run",
        file,
        "--set",
        "people=3",
        "--seconds",
        1,
        "--out",
        out,
        "--json",
        "--record",
        "decisions",
        "--seed",
        4,
    )
    assert done.status == 0, done.err
    summary = json.loads(done.out.splitlines()[-1])
    said = {"model": str(file), "pedestrians": 3, "preset": "default", "parameters": {"people": 3}}
    assert {key: summary[key] for key in said} == said
    # The run is repeated from the file.
    assert command("explain", out, "--person", 0, "--time", 0.5).status == 0
    wrong = command("run", file, "--set", "peple=3")
    assert f"model {file}: unknown parameter 'peple', did you mean 'people'?" in wrong.err
    refused = command("run", file, "--preset", "paper")
    assert "its constructor does not take preset (--preset)" in refused.err


def free_port():
    import socket

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ModelError, match=r"room\.py: no such file, expected a Python file"):
        load_model_file(str(tmp_path / "room.py"))
    (tmp_path / "folder.py").mkdir()
    with pytest.raises(ModelError, match=r"folder\.py: no such file"):
        load_model_file(str(tmp_path / "folder.py"))


def test_a_plan_of_ones_own_and_what_is_no_plan(tmp_path, command):
    pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")
    cases = {
        "none.geojson": (None, "none.geojson: cannot be read (No such file or directory)"),
        "text.geojson": ("hello", "text.geojson: is not JSON (line 1: Expecting value)"),
        "other.geojson": ("{}", "other.geojson: expected a GeoJSON FeatureCollection"),
    }
    for name, (text, message) in cases.items():
        if text is not None:
            (tmp_path / name).write_text(text)
        ended = command("dashboard", "--plan", tmp_path / name)
        assert ended.status == 2
        assert message in ended.err
        assert ended.err.count("\n") == 1
    round_and_round = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
        gates=[Gate("left", (3, 0), (3, 8)), Gate("right", (7, 0), (7, 8))],
    )
    round_and_round.write_geojson(tmp_path / "closed.geojson")
    ended = command("dashboard", "--plan", tmp_path / "closed.geojson")
    assert ended.status == 2
    assert "closed.geojson has no exit, expected one to leave by" in ended.err
    ended = command("dashboard", "doorway", "--plan", tmp_path / "closed.geojson")
    assert ended.status == 2
    assert "got model 'doorway' as well, expected one of the two" in ended.err


def test_people_leave_any_floor_plan(tmp_path, command):
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
        exits=[Exit("door", (10, 3), (10, 5))],
        obstacles=["POLYGON ((6 3, 7 3, 7 5, 6 5, 6 3))"],
    )
    plan.write_geojson(tmp_path / "room.geojson")
    model = FloorPlanEgress(
        plan=tmp_path / "room.geojson", pedestrians=12, mobility_map=strider(), rng=1
    )
    assert model.inside == 12
    assert model.floor_plan.contains([person.position for person in model.agents]).all()
    with pytest.raises(ModelError, match="plan: got none, expected a file of a floor plan"):
        FloorPlanEgress()
    setting = f"plan={tmp_path / 'room.geojson'}"
    arguments = ("--set", setting, "--set", "pedestrians=3", "--seconds", "1")
    assert command("run", "floor_plan", *arguments).status == 0
    assert command("run", "floor_plan").err == (
        "error: plan: got none, expected a file of a floor plan (.dxf, .geojson, "
        ".ifc, .zip, .osm, .scenario, .wkt)\n"
    )
