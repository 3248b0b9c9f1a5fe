"""Buildings as GeoJSON, written and read."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import (
    Building,
    Escalator,
    Exit,
    FloorPlan,
    Level,
    Lift,
    PedestrianModel,
    Refuge,
    SpeedZone,
    Stairs,
)
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Gate
from tests.fixtures.buildings import HALL, two_storeys


def parts(building):
    """All that a building has been made of."""
    levels = [
        (
            each.number,
            each.elevation,
            each.name,
            each.area.wkt,
            tuple(each.exits),
            tuple(each.gates),
            tuple(one.wkt for one in each.blocked),
            tuple(
                (zone.area.wkt, zone.factor, zone.name, zone.uphill, zone.downhill)
                for zone in each.zones
            ),
        )
        for each in building.levels
    ]
    return building.name, levels, building.stairs


def furnished():
    ground = Level(
        0,
        HALL,
        exits=[Exit("street", (0, 3), (0, 5))],
        gates=[Gate("door", (20, 0), (20, 8))],
        obstacles=["POLYGON ((21 1, 22 1, 22 2, 21 2, 21 1))"],
        zones=[SpeedZone("POLYGON ((2 1, 3 1, 3 2, 2 2, 2 1))", 0.7, "bank", 0.5, (0.0, 1.0))],
        name="ground floor",
    )
    cellar = Level(-1, HALL, -2.72)
    stairs = Stairs.straight("down", ground, cellar, ((8, 1.2), (8, 0)), risers=16, tread=0.3)
    return Building([ground, cellar], [stairs], name="shop")


@pytest.mark.parametrize("make", [two_storeys, furnished])
def test_what_is_written_is_read_again(make, tmp_path):
    building = make()
    building.write_geojson(tmp_path / "building.geojson")
    read = Building.from_geojson(tmp_path / "building.geojson")
    assert parts(read) == parts(building)
    assert read.to_geojson() == building.to_geojson()


@given(
    risers=st.integers(18, 24),
    tread=st.floats(0.25, 0.4),
    well=st.floats(0.1, 0.5),
    landing=st.none() | st.floats(1.2, 2.0),
    turn=st.sampled_from(["left", "right"]),
    wide=st.floats(0.8, 1.6),
)
def test_stairs_of_any_measures_are_read_again(risers, tread, well, landing, turn, wide):
    hall = "POLYGON ((-30 -30, 30 -30, 30 30, -30 30, -30 -30))"
    ground = Level(0, hall, exits=[Exit("out", (-30, 0), (-30, 1))])
    first = Level(1, hall, 0.17 * risers)
    stairs = Stairs.dog_leg(
        "s",
        first,
        ground,
        ((1.1, 2.2 + wide), (1.1, 2.2)),
        risers=risers,
        tread=tread,
        turn=turn,
        well=well,
        landing=landing,
    )
    building = Building([ground, first], [stairs])
    text = json.dumps(building.to_geojson())
    assert parts(Building.from_geojson(json.loads(text))) == parts(building)


@pytest.mark.parametrize("handrails", ["both", "left", "right", "none"])
def test_handrails_are_read_again_and_both_are_left_out(handrails):
    ground = Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))])
    upper = Level(1, HALL, 3.06)
    head = ((8, 1.2), (8, 0))
    stairs = Stairs.straight("s", upper, ground, head, risers=18, handrails=handrails)
    building = Building([ground, upper], [stairs])
    written = building.to_geojson()["features"][-1]["properties"]
    assert written.get("handrails", "both") == handrails
    assert ("handrails" in written) == (handrails != "both")
    assert Building.from_geojson(building.to_geojson()).stairs == (stairs,)


def test_features_have_the_number_of_their_level():
    features = two_storeys().to_geojson()["features"]
    kinds = [(each["properties"]["kind"], each["properties"]["level"]) for each in features]
    assert kinds == [
        ("walkable", 0),
        ("exit", 0),
        ("exit", 0),
        ("walkable", 1),
        ("stairs", 1),
        ("stairs", 1),
    ]
    assert features[3]["properties"]["elevation"] == 3.06
    assert features[4]["properties"] == {
        "kind": "stairs",
        "name": "south",
        "level": 1,
        "from": 1,
        "to": 0,
        "risers": 18,
        "tread": 0.29,
        "type": "straight",
    }
    assert features[5]["properties"]["turn"] == "right"


def test_a_floor_plan_is_a_building_of_one_level(tmp_path):
    plan = FloorPlan(HALL, exits=[Exit("out", (0, 3), (0, 5))], name="hall")
    plan.write_geojson(tmp_path / "plan.geojson")
    building = Building.from_geojson(tmp_path / "plan.geojson")
    assert [each.number for each in building.levels] == [0]
    assert building.to_geojson() == plan.to_geojson()


def test_closed_exits_stay_closed():
    building = two_storeys()
    building.floor_plan.close_gate("west")
    read = Building.from_geojson(building.to_geojson())
    assert [read.floor_plan.is_open(name) for name in ("west", "east")] == [False, True]


@pytest.mark.parametrize(
    ("feature", "name", "value", "said"),
    [
        (4, "risers", "many", "GeoJSON: feature 4: risers must be a whole number, found 'many'"),
        (4, "risers", 12, "GeoJSON: stairs 'south': 12 risers for a rise of 3.06 m"),
        (4, "tread", None, "GeoJSON: feature 4: tread must be a number, found None"),
        (4, "type", "spiral", "GeoJSON: feature 4: stairs 'south': expected one of the shapes"),
        (4, "to", 7, "GeoJSON: stairs 'south': there is no level 7"),
        (4, "handrails", "up", "feature 4: stairs 'south': expected handrails both, left, right"),
        (4, "handrails", ["left"], "feature 4: stairs 'south': expected handrails both"),
        (5, "turn", 3, "GeoJSON: feature 5: stairs 'north': expected a turn"),
        (1, "level", "zero", "GeoJSON: feature 1: level must be a whole number, found 'zero'"),
        (1, "level", 5, "GeoJSON: level 5: expected one walkable area, found 0"),
        (3, "elevation", "high", "GeoJSON: level 1: elevation must be metres"),
        (3, "kind", "ramps", "GeoJSON: feature 3: property kind must be one of"),
    ],
)
def test_what_is_wrong_is_named_with_its_feature(feature, name, value, said):
    collection = two_storeys().to_geojson()
    collection["features"][feature]["properties"][name] = value
    with pytest.raises(FloorPlanError, match=said) as error:
        Building.from_geojson(collection)
    assert "\n" not in str(error.value)


def test_stairs_are_lines():
    collection = two_storeys().to_geojson()
    collection["features"][4]["geometry"] = {"type": "Point", "coordinates": [0, 0]}
    with pytest.raises(FloorPlanError, match="feature 4: stairs must be a LineString, found Point"):
        Building.from_geojson(collection)


def test_a_building_has_no_pieces_cut_off():
    collection = two_storeys().to_geojson()
    collection["features"][0]["properties"]["cut_off"] = True
    with pytest.raises(FloorPlanError, match="level 0: cut_off is for floor plans"):
        Building.from_geojson(collection)


def of_all_kinds():
    """Two storeys with stairs, an escalator, a lift and a refuge."""
    ground = Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))])
    lobby = Refuge("lobby", "POLYGON ((19 1, 22 1, 22 3, 19 3, 19 1))")
    first = Level(1, HALL, 3.06, refuges=[lobby])
    return Building(
        [ground, first],
        [
            Stairs.dog_leg("stairs", first, ground, ((8, 1.4), (8, 0.2)), risers=18),
            Escalator.straight("escalator", first, ground, ((16, 3), (16, 4)), length=5.3),
        ],
        lifts=[Lift("car", [0, 1], ((20.0, 6.5), (20.9, 6.5)))],
    )


def test_closed_doors_of_lifts_and_closed_flights_are_read_again():
    building = of_all_kinds()
    shut = ["street", "car at level 1", "stairs 2 before", "escalator after"]
    for name in shut:
        building.floor_plan.close_gate(name)
    collection = building.to_geojson()
    read = Building.from_geojson(collection)
    plan = read.floor_plan
    assert sorted(shut) == sorted(e.name for e in plan.openings() if not plan.is_open(e.name))
    assert read.to_geojson() == collection
    assert "closed" not in str(of_all_kinds().to_geojson())


@pytest.mark.parametrize(
    ("kind", "change", "said"),
    [
        ("escalator", {"spede": 0.5}, "escalator has no property 'spede', expected some of kind"),
        ("refuge", {"capacity": 5}, "refuge has no property 'capacity', expected some of kind"),
        ("escalator", {"level": 0}, "level must be that of from, 1, found 0"),
        ("stairs", {"level": 7}, "level must be that of from, 1, found 7"),
        ("lift", {"level": 7}, r"level must be one of its levels \[0, 1\], found 7"),
        ("escalator", {"name": 5}, "name must be a text, found 5"),
        ("refuge", {"name": ["a"]}, r"name must be a text, found \['a'\]"),
        ("lift", {"closed": True}, "closed must be a list of names of gates, found True"),
        ("lift", {"closed": ["car at level 9"]}, "'car at level 9'"),
    ],
)
def test_a_bad_property_gets_one_line(kind, change, said):
    collection = of_all_kinds().to_geojson()
    for feature in collection["features"]:
        if feature["properties"]["kind"] == kind:
            feature["properties"] |= change
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building.from_geojson(collection)
    assert str(caught.value).startswith("GeoJSON: ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("kind", ["refuge", "walkable", "escalator"])
def test_a_coordinate_that_is_no_number_gives_no_further_warning(kind, recwarn):
    collection = of_all_kinds().to_geojson()
    for feature in collection["features"]:
        if feature["properties"]["kind"] == kind:
            points = feature["geometry"]["coordinates"]
            (points if kind == "escalator" else points[0])[1] = [23.0, float("nan")]
    with pytest.raises(FloorPlanError):
        Building.from_geojson(collection)
    assert not recwarn


HOLLOW = "POLYGON ((-30 -30, 30 -30, 30 30, -30 30, -30 -30), (0 -5, 9 -5, 9 9, 0 9, 0 -5))"
"""A floor with a hole for stairs that lead down from x = 0."""


def test_people_leave_by_stairs_of_several_flights_that_are_read_again():
    ground = Level(
        0, "POLYGON ((-30 3, 0.1 3, 0.1 9, -30 9, -30 3))", exits=[Exit("out", (-30, 5), (-30, 9))]
    )
    first, head = Level(1, HOLLOW, 3.06), ((0, 1.2), (0, 0))
    # The last foot is at x = 0.87 + 0.1 - 0.87 m, from y = 3.91 to 5.11 m.
    stairs = Stairs.of_flights("s", first, ground, head, risers=[4, 10, 4], turns=["left", "left"])
    building = Building([ground, first], [stairs])
    again = Building.from_geojson(json.loads(json.dumps(building.to_geojson())))
    assert again.stairs == (stairs,)
    model = PedestrianModel(again, rng=1)
    model.add_pedestrians(again.places([[-1.0, y] for y in (-1.0, 0.0, 1.0, 2.0)], level=1))
    model.run(max_seconds=60)
    assert model.inside == 0


@pytest.mark.parametrize("name", ["flights", "turns"])
def test_flights_that_are_no_list_are_named(name):
    given = two_storeys().to_geojson()
    feature = next(each for each in given["features"] if each["properties"]["kind"] == "stairs")
    feature["properties"][name] = 3
    with pytest.raises(FloorPlanError, match=f"{name} must be a list, found 3"):
        Building.from_geojson(given)
