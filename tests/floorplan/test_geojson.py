import copy
import json
import math
import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon, box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate

number = st.floats(0.37, 61.3, allow_nan=False)


@st.composite
def floor_plans(draw) -> FloorPlan:
    """Turned rectangles, with coordinates of all 17 digits, and an exit on the first side."""
    width, height = draw(number) + 5, draw(number) + 5
    turn, x, y = draw(st.floats(0, 6)), draw(number), draw(number)

    def place(u: float, v: float) -> tuple[float, float]:
        return (
            x + math.cos(turn) * u - math.sin(turn) * v,
            y + math.sin(turn) * u + math.cos(turn) * v,
        )

    corners = [place(0, 0), place(width, 0), place(width, height), place(0, height)]
    share = draw(st.floats(0.05, 0.6))
    ends = [place(share * width, 0), place((share + 0.3) * width, 0)]
    gates = [Gate("door ü", place(0.1, height / 2), place(width - 0.1, height / 2))]
    seats = [
        Polygon([place(1, 1), place(2 + k / 7, 1.5), place(1.2, 2)])
        for k in range(draw(st.integers(0, 3)))
    ]
    return FloorPlan(
        Polygon(corners),
        exits=[Exit("out", *ends)],
        gates=gates,
        obstacles=seats,
        name=draw(st.text(max_size=8)),
    )


def same(one: FloorPlan, other: FloorPlan) -> bool:
    """Equal to the last bit."""
    pairs = [
        (one.walkable, other.walkable),
        *zip(one.obstacles.values(), other.obstacles.values(), strict=True),
    ]
    return (
        all(a.equals_exact(b, 0) for a, b in pairs)
        and one.openings() == other.openings()
        and one.name == other.name
        and one.closed_gates() == other.closed_gates()
    )


def wkt(polygon: Polygon) -> str:
    """With all 17 digits; shapely writes 16."""
    ring = ", ".join(f"{x!r} {y!r}" for x, y in polygon.exterior.coords)
    return f"POLYGON (({ring}))"


@settings(deadline=None, max_examples=40)
@given(plan=floor_plans(), closed=st.booleans())
def test_geojson_round_trip_is_exact(plan: FloorPlan, closed: bool) -> None:
    if closed:
        plan.close_gate("door ü")
    again = FloorPlan.from_geojson(json.loads(json.dumps(plan.to_geojson())))
    assert same(plan, again)
    assert (again.walls == plan.walls).all()
    assert again.version == 0


@settings(deadline=None, max_examples=40)
@given(plan=floor_plans())
def test_wkt_round_trip_is_exact(plan: FloorPlan) -> None:
    again = FloorPlan.from_wkt(
        wkt(plan.walkable),
        exits=plan.exits,
        gates=plan.gates,
        obstacles=[wkt(obstacle) for obstacle in plan.obstacles.values()],
        name=plan.name,
    )
    assert same(plan, again)


def test_what_a_collection_says(plans) -> None:
    collection = plans["two_rooms"]().to_geojson()
    assert collection["type"] == "FeatureCollection"
    assert [f["properties"] for f in collection["features"]] == [
        {"kind": "walkable", "name": "two rooms"},
        {"kind": "gate", "name": "door"},
        {"kind": "exit", "name": "out"},
    ]
    assert collection["features"][1]["geometry"] == {
        "type": "LineString",
        "coordinates": [[6.1, 1.0], [6.1, 2.0]],
    }


def test_files(plans, tmp_path: Path) -> None:
    plan = plans["hall"]()
    path = tmp_path / "hall.geojson"
    path.write_text("something older")
    plan.write_geojson(path)
    assert same(plan, FloorPlan.from_geojson(path))
    assert same(plan, FloorPlan.from_geojson(str(path)))
    assert os.listdir(tmp_path) == ["hall.geojson"]


def test_nothing_half_written(plans, tmp_path: Path) -> None:
    blocked = tmp_path / "folder"
    blocked.mkdir()
    with pytest.raises(FloorPlanError, match="folder: cannot be written"):
        plans["room"]().write_geojson(blocked)
    with pytest.raises(FloorPlanError, match=r"cannot be written: No such file"):
        plans["room"]().write_geojson(tmp_path / "nowhere" / "plan.geojson")
    assert os.listdir(tmp_path) == ["folder"]


SQUARE = FloorPlan(
    box(0, 0, 10, 10), exits=[Exit("e", (0, 1), (0, 2))], obstacles=[box(4, 4, 5, 5)]
).to_geojson()


def damaged(change) -> dict:
    collection = copy.deepcopy(SQUARE)
    change(collection["features"])
    return collection


@pytest.mark.parametrize(
    ("collection", "says"),
    [
        ({}, "expected a GeoJSON FeatureCollection"),
        ({"type": "FeatureCollection"}, "features must be a list"),
        (
            {"type": "FeatureCollection", "features": [3]},
            "feature 0: expected a Feature, found int",
        ),
        ({"type": "FeatureCollection", "features": []}, "one walkable area, found 0"),
        (damaged(lambda f: f.append(f[0])), "one walkable area, found 2"),
        (
            damaged(lambda f: f[1]["properties"].update(kind="seat")),
            "feature 1: property kind must be one of walkable, .*, found 'seat'",
        ),
        (damaged(lambda f: f[1].pop("properties")), "feature 1: property kind .*, found None"),
        (damaged(lambda f: f[0].pop("geometry")), "feature 0: the geometry cannot be read"),
        (
            damaged(lambda f: f[0].update(geometry={"type": "Polygon", "coordinates": "ab"})),
            "feature 0: the geometry cannot be read",
        ),
        (
            damaged(lambda f: f[2].update(geometry=f[1]["geometry"])),
            "feature 2: exit must be a LineString, found Polygon",
        ),
        (
            damaged(lambda f: f[0].update(geometry=f[2]["geometry"])),
            "feature 0: walkable must be a Polygon, found LineString",
        ),
        (
            damaged(lambda f: f[2]["geometry"]["coordinates"].append([0, 3])),
            "feature 2: exit must have two points, found 3",
        ),
        (
            damaged(lambda f: f[2]["properties"].update(name="")),
            "feature 2: exit name must be a text",
        ),
        (damaged(lambda f: f.pop(2)), "GeoJSON: the floor plan has no exit"),
        (
            damaged(
                lambda f: f[1]["geometry"].update(
                    coordinates=[[[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]]
                )
            ),
            "GeoJSON: obstacle 0 is not valid",
        ),
    ],
)
def test_bad_collections(collection: dict, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says) as error:
        FloorPlan.from_geojson(collection)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is not JSON .line 1"),
        (b'{"type": "FeatureColl', "is not JSON .line 1"),
        (b"\xff\xfe\x00\x01binary", "is not text"),
        (b"[" * 100_000, "nested too deeply|is not JSON"),
        (b"[1, 2]", "expected a GeoJSON FeatureCollection"),
        (json.dumps(damaged(lambda f: f.pop(2))).encode(), "the floor plan has no exit"),
        (
            json.dumps(SQUARE).replace("10.0", "Infinity").encode(),
            "coordinates that are not finite",
        ),
    ],
)
def test_bad_files_are_named(content: bytes, says: str, tmp_path: Path) -> None:
    path = tmp_path / "plan.geojson"
    path.write_bytes(content)
    with pytest.raises(FloorPlanError, match=f"plan.geojson: .*({says})") as error:
        FloorPlan.from_geojson(path)
    assert "\n" not in str(error.value)


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(FloorPlanError, match=r"none.geojson: cannot be read .No such file"):
        FloorPlan.from_geojson(tmp_path / "none.geojson")
