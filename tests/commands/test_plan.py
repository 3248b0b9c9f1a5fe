"""`mesa-mobility plan`, and runs on plans of files."""

import json

import pytest

from mesa_mobility import Building, Escalator, Exit, FloorPlan, Level, Refuge
from tests.fixtures.buildings import HALL

WKT = """walkable POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))
obstacle POLYGON ((1 1, 2 1, 2 2, 1 2, 1 1))
exit street LINESTRING (6 1, 6 3)
"""


@pytest.fixture(autouse=True)
def drawn_elsewhere(tmp_path, monkeypatch):
    """Pictures are drawn in the folder of the test."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def drawing(tmp_path):
    """A room of 6 by 4 m in millimetres, which does not say so, on layers of its own names."""
    ezdxf = pytest.importorskip("ezdxf", reason="no ezdxf: pip install 'mesa-mobility[cad]'")
    document = ezdxf.new(units=0)
    space = document.modelspace()
    corners = [(0, 0), (6000, 0), (6000, 4000), (0, 4000)]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "A-SLAB"})
    space.add_line((6000, 1000), (6000, 2200), dxfattribs={"layer": "A-DOOR"})
    document.saveas(tmp_path / "room.dxf")
    return tmp_path / "room.dxf"


NAMED = ["--layer", "A-SLAB=walkable", "--layer", "A-DOOR=exit street", "--unit", "mm"]


def test_what_a_plan_holds(command, tmp_path):
    (tmp_path / "room.wkt").write_text(WKT)
    done = command("plan", str(tmp_path / "room.wkt"), "--json")
    assert json.loads(done.out) == {
        "name": "",
        "size_m": [6.0, 4.0],
        "free_area_m2": 23.0,
        "exits": {"street": 2.0},
        "gates": {},
        "obstacles": 1,
        "zones": [],
        "rooms": [
            {
                "name": "room 1",
                "level": 0,
                "use": "",
                "area_m2": 24.0,
                "stated_area_m2": None,
                "doors": ["street"],
            }
        ],
    }
    assert "street (2.00 m)" in command("plan", str(tmp_path / "room.wkt")).out
    assert (tmp_path / "room_plan.png").read_bytes().startswith(b"\x89PNG")


def test_exits_of_a_plan_that_has_none(command, tmp_path):
    (tmp_path / "bare.wkt").write_text("POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))")
    for arguments, exits in (
        (["--exits", "longest"], {"door": 1.2}),
        (["--exit", "6 1, 6 3", "--exit", "0 1, 0 2"], {"exit 1": 2.0, "exit 2": 1.0}),
    ):
        done = command("plan", "bare.wkt", *arguments, "--json", "--picture", "bare.svg")
        found = json.loads(done.out)["exits"]
        assert {name: round(length, 6) for name, length in found.items()} == exits
    assert "<svg" in (tmp_path / "bare.svg").read_text()
    refused = command("plan", "bare.wkt")
    assert refused.status == 2
    assert "the floor plan has no exit" in refused.err
    both = command("plan", "bare.wkt", "--exits", "longest", "--exit", "6 1, 6 3")
    assert "expected one of the two" in both.err
    other = command("run", "doorway", "--exits", "longest", "--no-progress")
    assert "its constructor does not take exits" in other.err


def test_a_drawing_becomes_geojson(command, drawing, tmp_path):
    out = tmp_path / "room.geojson"
    done = command("plan", str(drawing), *NAMED, "-o", str(out))
    assert done.status == 0
    plan = FloorPlan.from_geojson(out)
    assert plan.area == pytest.approx(24.0)
    assert plan.exits[0].length == pytest.approx(1.2)


def test_options_that_a_format_does_not_take_are_refused(command, tmp_path):
    (tmp_path / "room.wkt").write_text(WKT)
    for arguments, message in (
        (["--unit", "mm"], "format wkt: unknown option 'unit'; it takes none"),
        (["--set", "unit"], "--set unit: expected NAME=VALUE"),
        (["-o", "room.shp"], "room.shp: expected a name that ends in .geojson, .json"),
        (["-o", "room.wkt"], "room.wkt: expected a name that ends in .geojson, .json"),
    ):
        done = command("plan", tmp_path / "room.wkt", *arguments)
        assert done.err == f"error: {message}\n"
        assert done.status == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "does not say its unit ($INSUNITS), expected one of mm, cm"),
        (["--unit", "mm"], "has no layer of kind walkable; it has drawings on A-DOOR, A-SLAB"),
        (["--unit", "mm", "--layer", "A-SLAB"], "--layer: got 'A-SLAB', expected LAYER=KIND"),
    ],
)
def test_what_a_drawing_lacks_is_said_in_one_line(command, drawing, arguments, message):
    done = command("plan", str(drawing), *arguments)
    assert message in done.err
    assert (done.status, done.err.count("\n")) == (2, 1)


def test_what_a_building_holds(command, tmp_path):
    first, second = tmp_path / "office.geojson", tmp_path / "again.geojson"
    lobby = Refuge("lobby", "POLYGON ((19 1, 23 1, 23 4, 19 4, 19 1))")
    ground = Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))])
    belt = Escalator.straight("belt", 1, 0, ((16, 3), (16, 4)), length=5.3)
    Building([ground, Level(1, HALL, 3.06, refuges=[lobby])], [belt]).write_geojson(first)
    done = command("plan", str(first), "--json", "-o", str(second))
    said = json.loads(done.out)
    rooms = said.pop("rooms")
    # A hall of 24 m by 8 m on each level, less what the escalator takes.
    assert [each["name"] for each in rooms] == ["level 0 room 1", "level 1 room 1"]
    assert [each["doors"] for each in rooms] == [["street", "belt"], ["belt"]]
    assert all(180.0 < each["area_m2"] < 192.0 for each in rooms)
    assert said == {
        "name": "",
        "levels": {"0": 0.0, "1": 3.06},
        "stairs": {"belt": "escalator"},
        "lifts": [],
        "refuges": ["lobby"],
        "exits": {"street": 2.0},
    }
    assert second.read_text() == first.read_text()
    assert "1 at 3.06 m" in command("plan", str(first)).out
    refused = command("plan", str(first), "-o", str(tmp_path / "office.svg"))
    assert refused.status != 0
    assert refused.err.count("\n") == 1


CORNERS = [[7, 51], [7.0003, 51], [7.0003, 51.0001], [7, 51.0001], [7, 51]]
TWO_LEVELS = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"indoor": "area", "level": level},
            "geometry": {"type": "Polygon", "coordinates": [CORNERS]},
        }
        for level in ("0", "1")
    ],
}
"""Two levels 21 m by 11 m, which nothing joins."""


def test_one_level_of_several(command, tmp_path):
    (tmp_path / "two.geojson").write_text(json.dumps(TWO_LEVELS))
    done = command("plan", "two.geojson", "--exits", "longest", "--json")
    assert json.loads(done.out)["exits"]["door"] == pytest.approx(1.2)
    assert "level 0 of 0, 1; --level names another" in done.err
    done = command("plan", "two.geojson", "--exits", "longest", "--level", "1", "--json")
    assert "--level names another" not in done.err
    done = command("plan", "two.geojson", "--level", "2")
    assert done.status == 2
    assert "two.geojson: has no level '2', expected one of 0, 1" in done.err


def test_a_building_needs_a_level_where_a_floor_plan_is_expected(command, tmp_path):
    ground = Level(0, HALL, exits=[Exit("street", (0, 2), (0, 4))])
    upper = Level(1, HALL, elevation=4.0)
    join = Escalator.straight("up", 1, 0, ((12, 3), (12, 4)), length=6.93)
    Building([ground, upper], [join]).write_geojson(tmp_path / "hall.geojson")
    done = command("estimate", "none.txt", "--plan", "hall.geojson")
    assert "hall.geojson: has the levels 0, 1, expected --level with one" in done.err
    done = command("plan", "hall.geojson", "--level", "1", "--json")
    assert list(json.loads(done.out)["exits"]) == ["up"]


def test_what_is_odd_is_listed_and_marked(command, tmp_path):
    (tmp_path / "room.wkt").write_text(WKT.replace("6 1, 6 3", "6 1, 6 1.6"))
    done = command("plan", "room.wkt", "--check", "--json")
    (odd, *others) = json.loads(done.out)["odd"]
    assert (odd["number"], odd["kind"], odd["place"]) == (1, "narrow door", [6.0, 1.3])
    assert {each["kind"] for each in others} == {"no way out for wheelchairs"}
    before = (tmp_path / "room_plan.png").stat().st_size
    said = " ".join(command("plan", "room.wkt", "--check").out.split())
    assert "exit street is 0.60 m wide: wheelchairs need 0.80 m" in said
    command("plan", "room.wkt")
    assert (tmp_path / "room_plan.png").stat().st_size < before
    (tmp_path / "room.wkt").write_text(
        "walkable POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))\nexit street LINESTRING (6 1, 6 3)\n"
    )
    assert "nothing odd was found" in command("plan", "room.wkt", "--check").out


@pytest.mark.thorough
def test_a_file_runs_in_place_of_a_model(command, tmp_path):
    (tmp_path / "room.wkt").write_text(WKT)
    done = command("run", "room.wkt", "--set", "pedestrians=2", "--seed", "1", "--json")
    assert json.loads(done.out.splitlines()[-1])["model"] == "floor_plan"
