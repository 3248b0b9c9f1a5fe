"""Models in files of one's own, and floor plans without a model."""

import sys

import pytest
from mesa_mobility.models import FloorPlanEgress

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.model_files import is_model_file, load_model_file
from tests.fixtures.maps import strider

ROOM = "from mesa_mobility import PedestrianModel\n\n\nclass Room(PedestrianModel):\n    pass\n"


@pytest.fixture(autouse=True)
def same_path(monkeypatch):
    """Loading a file makes what stands beside it importable; for one test alone."""
    monkeypatch.setattr(sys, "path", list(sys.path))


@pytest.mark.parametrize(
    ("text", "expected"),
    [("room.py", True), ("a/b c/room.py:Room", True), (r"C:\models\room.py:Room", True),
     ("doorway", False), ("room.pyc", False), ("room:Room", False)],
)  # fmt: skip
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
        (ROOM + "\n\nclass Hall(Room):\n    pass\n", "",
         "room.py: has several models, expected room.py:NAME, one of Room, Hall"),
        (ROOM, ":Rom", "room.py: has no model 'Rom', did you mean 'Room'?; it has Room"),
        ("x = (\n", "", "room.py:1: cannot be loaded: SyntaxError: '(' was never closed"),
        ("x = 1\nimport no_such_thing\n", "",
         "room.py:2: cannot be loaded: ModuleNotFoundError: No module named 'no_such_thing'"),
        ("def f():\n    1 / 0\n\n\nf()\n", "",
         "room.py:2: cannot be loaded: ZeroDivisionError: division by zero"),
        ("raise ValueError('two\\nlines')\n", "", "room.py:1: cannot be loaded: ValueError: two"),
        ("raise SystemExit(3)\n", "", "room.py:1: cannot be loaded: SystemExit: 3"),
    ],
)  # fmt: skip
def test_bad_model_files_give_one_line(tmp_path, monkeypatch, command, text, name, message):
    pytest.importorskip("solara", reason="no solara: pip install 'mesa-mobility[viz]'")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.py").write_text(text)
    ended = command("dashboard", f"room.py{name}", "--port", free_port())
    assert ended.status == 2
    assert ended.err.startswith(f"error: {message}")
    assert ended.err.count("\n") == 1


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
        "error: plan: got none, expected a file of a floor plan (.geojson, .wkt or .dxf)\n"
    )
