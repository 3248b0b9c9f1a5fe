"""Rooms in GeoJSON of other programs, IMDF and OpenStreetMap indoor."""

import json
import math
import warnings

import pytest

from mesa_mobility import FloorPlan
from mesa_mobility.buildings import read_floor
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.indoor.shapes import _levels
from tests.floorplan.formats.mutations import read_all

EAST, NORTH = 70197.68, 111248.28
"""Metres in a degree at 51 degrees north on WGS 84."""


def area(x0, y0, x1, y1, scale=(1.0, 1.0), zero=(0.0, 0.0), **properties):
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]
    ring = [[zero[0] + x / scale[0], zero[1] + y / scale[1]] for x, y in corners]
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


def feature(kind, coordinates, **more):
    return {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": kind, "coordinates": coordinates},
        **more,
    }


@pytest.fixture
def read(tmp_path):
    def reading(features, name="hall.geojson", **options):
        text = json.dumps({"type": "FeatureCollection", "features": features})
        (tmp_path / name).write_text(features if isinstance(features, str) else text)
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            plan = read_floor(tmp_path / name, **options)
        assert isinstance(plan, FloorPlan)
        return plan, "\n".join(str(each.message) for each in found)

    return reading


def test_rooms_that_touch_are_joined_and_others_named(read):
    rooms = [area(0, 0, 4, 3), area(4.04, 0, 8, 3), area(9, 0, 11, 3, name="shed")]
    plan, said = read(rooms, exits="longest")
    assert plan.area == pytest.approx(24)
    assert "2 areas that touch are joined" in said
    assert "left out shed: 6.00 m² around (10.00, 1.50), 1.00 m from the rest" in said


def indoor(**level):
    """Two rooms on a corridor of 10 m by 2 m, a door of each, and a way out at its end."""
    kept = {"scale": (EAST, NORTH), "zero": (7.0, 51.0)}
    spots = {(2.5, 2): "no", (7.5, 2): "no", (0, 1): "main"}
    doors = [
        feature(
            "Point",
            [7 + x / EAST, 51 + y / NORTH],
            properties={"door": "yes", "entrance": entrance, **level},
        )
        for (x, y), entrance in spots.items()
    ]
    return [
        area(0, 0, 10, 2, indoor="corridor", **kept, **level),
        area(0, 2, 5, 6, indoor="room", name="A", **kept, **level),
        area(5, 2, 10, 6, indoor="room", name="B", **kept, **level),
        *doors,
    ]


def test_openstreetmap_has_walls_and_doors(read):
    plan, said = read(indoor())
    # Each room loses 5 cm on every side.
    rooms = 9.9 * 1.9 + 2 * 4.9 * 3.9
    # A door of 0.9 m leads through a wall of 0.1 m.
    assert plan.area == pytest.approx(rooms + 2 * 0.9 * 0.1, abs=0.02)
    (way_out,) = plan.exits
    assert way_out.length == pytest.approx(0.9, abs=0.01)
    assert "degrees became metres" in said


def test_one_level_of_several(read):
    both = [*indoor(level="0"), *indoor(level="1;2")]
    plan, said = read(both)
    assert "level 0 of 0, 1, 2" in said
    again, _ = read(both, level="2")
    assert again.area == pytest.approx(plan.area)
    with pytest.raises(FloorPlanError, match="has no level '7', expected one of 0, 1, 2"):
        read(both, level="7")


def test_openstreetmap_in_xml(read):
    nodes, ways = [], []
    for each in indoor():
        tags = "".join(f'<tag k="{k}" v="{v}"/>' for k, v in each["properties"].items())
        points = each["geometry"]["coordinates"]
        points = points[0] if each["geometry"]["type"] == "Polygon" else [points]
        refs = []
        for lon, lat in points[:4]:
            refs.append(len(nodes))
            inner = tags if len(points) == 1 else ""
            nodes.append(f'<node id="{len(nodes)}" lon="{lon}" lat="{lat}">{inner}</node>')
        if len(refs) > 1:
            nd = "".join(f'<nd ref="{ref}"/>' for ref in [*refs, refs[0]])
            ways.append(f'<way id="w{len(ways)}">{nd}{tags}</way>')
    text = f"<osm>{''.join(nodes)}{''.join(ways)}</osm>"
    plan, _ = read(text, name="hall.osm")
    assert plan.area == pytest.approx(read(indoor())[0].area)
    with pytest.raises(FloorPlanError, match="is not XML that can be read"):
        read(text[:-9], name="hall.osm")
    with pytest.raises(FloorPlanError, match="has a document type"):
        read('<!DOCTYPE a [<!ENTITY b "c">]>' + text, name="hall.osm")


def test_imdf(read):
    kept = {"scale": (EAST, NORTH), "zero": (7.0, 51.0)}
    level = {**area(0, 0, 10, 6, ordinal=0, **kept), "id": "ground", "feature_type": "level"}
    units = [
        area(0, 0, 10, 2, category="walkway", level_id="ground", **kept),
        area(0, 2, 5, 6, category="room", level_id="ground", **kept),
        area(5, 2, 10, 6, category="opentobelow", level_id="ground", **kept),
    ]
    for each in units:
        each["feature_type"] = "unit"
    openings = [
        feature(
            "LineString",
            [[7 + x / EAST, 51 + y / NORTH] for x, y in ends],
            feature_type="opening",
            properties={"category": "pedestrian", "level_id": "ground"},
        )
        for ends in (((2, 2), (3, 2)), ((0, 0.5), (0, 1.5)))
    ]
    plan, _ = read([level, *units, *openings])
    assert plan.area == pytest.approx(9.9 * 1.9 + 4.9 * 3.9 + 0.1, abs=0.02)
    assert [each.length for each in plan.exits] == pytest.approx([1.0], abs=0.01)


def test_a_door_at_a_corner_that_is_there_twice(read):
    """The first corner of the room is repeated, and the door is at it."""
    room = area(0, 0, 6, 4, (EAST, NORTH), (7, 51), indoor="room", level="0")
    room["geometry"]["coordinates"][0].insert(0, room["geometry"]["coordinates"][0][0])
    [corner, *_] = room["geometry"]["coordinates"][0]
    door = feature("Point", corner, properties={"door": "yes", "level": "0"})
    plan, _ = read([room, door], exits="longest")
    assert plan.area == pytest.approx(5.9 * 3.9, abs=0.1)


def test_levels_of_many_features_are_kept_once():
    assert _levels("0-2") == ("0", "1", "2")
    assert _levels("-1;3.0; 4") == ("-1", "3", "4")
    assert _levels("-999-999") is _levels("-999-999")


def test_metres_in_a_degree():
    from mesa_mobility.floorplan.formats.assembling.projection import metres_in_degree

    assert metres_in_degree(51) == pytest.approx((EAST, NORTH), abs=0.1)
    assert metres_in_degree(0)[0] == pytest.approx(math.radians(1) * 6_378_137)


@pytest.mark.parametrize("count", [40, pytest.param(1500, marks=pytest.mark.slow)])
def test_damaged_files_are_plans_or_refused(tmp_path, count):
    whole = json.dumps({"type": "FeatureCollection", "features": indoor(level="0")})
    assert read_all(whole.encode(), tmp_path / "hall.geojson", count) > 0
    whole = (
        '<osm><node id="1" lon="7" lat="51"/><node id="2" lon="7.0001" lat="51"/>'
        '<node id="3" lon="7.0001" lat="51.0001"><tag k="door" v="yes"/></node>'
        '<way id="9"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="1"/>'
        '<tag k="indoor" v="room"/><tag k="level" v="0"/></way></osm>'
    )
    assert read_all(whole.encode(), tmp_path / "hall.osm", count) > 0


def test_named_rooms_are_those_of_the_plan(read):
    rooms = [area(0, 0, 4, 5, name="hall"), area(4, 0, 8, 5, name="hall"), area(0, 5, 4, 9)]
    plan, _ = read(rooms, exits="longest")
    names = {each.name: each.area for each in plan.rooms}
    assert names == {"hall": 20.0, "hall 2": 20.0, "room": 16.0}
    nameless, _ = read([area(0, 0, 4, 5), area(4, 0, 8, 5)], exits="longest")
    assert [(each.name, each.area) for each in nameless.rooms] == [("room 1", 40.0)]


def test_areas_of_rooms_are_those_of_the_file_where_walls_take_some_floor(read):
    door = feature("LineString", [[8, 1], [8, 2]], properties={"name": "exit"})
    plan, _ = read([area(0, 0, 8, 5, name="hall"), door])
    assert [(each.name, each.area) for each in plan.rooms] == [("hall", 40.0)]
    assert plan.area == pytest.approx(7.9 * 4.9, abs=0.1)
