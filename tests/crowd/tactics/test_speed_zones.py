"""Slower in some places: at a share of the preferred speed."""

import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, SpeedZone
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.results import Trajectories, crossings
from tests.fixtures.maps import make_map, shipped_map, stand, straight
from tests.fixtures.scenes import advance, model_of, put


def strip(*zones: SpeedZone) -> FloorPlan:
    return FloorPlan(box(0, 0, 40, 2), exits=[Exit("out", (40, 0), (40, 2))], zones=zones)


def wanted_at(x: float, *zones: SpeedZone, speed: float = 1.25) -> float:
    """Speed that somebody wants who walks towards +x and decides at ``x``."""
    on = straight(0.5, 12)
    model = model_of(strip(*zones), make_map([(stand(), on), (on, stand())]))
    person = put(model, x, 1.0, preferred_speeds=[speed])
    advance(model, 1)
    assert person.preferred_speed == speed
    return float(model.crowd.preferred[0])


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        (6.0, 0.625),  # inside for more than 1.5 s
        (0.5, 1.25),  # the zone is 2.5 m away, and 1.5 s lead 1.875 m far
        # 1 m takes 0.8 s, and 0.7 s at 0.625 m/s are 0.4375 m.
        (2.0, 1.4375 / 1.5),
        # 0.5 m at 0.625 m/s take 0.8 s, and 0.7 s at 1.25 m/s are 0.875 m.
        (9.5, 1.375 / 1.5),
        (10.1, 1.25),
    ],
)
def test_a_movement_has_the_mean_speed_of_the_way_ahead(x, expected):
    # To a fifteenth of the way that is looked at.
    found = wanted_at(x, SpeedZone(box(3, 0, 10, 2), 0.5))
    assert found == pytest.approx(expected, abs=1.25 / 15 / 2)


def test_a_way_through_a_narrow_zone_takes_what_each_part_of_it_takes():
    # 0.5 m at 1.25 m/s, 0.25 m at 0.25 m/s, 0.1 s left at 1.25 m/s: 0.4 + 1.0 + 0.1 s.
    found = wanted_at(2.0, SpeedZone(box(2.5, 0, 2.75, 2), 0.2))
    assert found == pytest.approx(0.875 / 1.5, abs=0.04)


def test_people_ahead_leave_room_for_as_small_a_share_of_the_speed():
    model = model_of(strip(SpeedZone(box(3, 0, 10, 2), 0.5)), shipped_map())
    people = [put(model, x, 1.0, preferred_speeds=1.25) for x in (5.0, 11.0)]
    advance(model, 1)
    paces = [model.crowd.agenda["pace"][person.row] for person in people]
    assert paces == [model.crowd.preferred[people[0].row] / 1.25, 1.0]


def test_where_zones_overlap_their_factors_multiply():
    plan = strip(SpeedZone(box(0, 0, 10, 2), 0.5), SpeedZone(box(5, 0, 15, 2), 0.4))
    points = [(2.0, 1.0), (7.0, 1.0), (12.0, 1.0), (20.0, 1.0), (10.0, 1.0)]
    assert plan.speed_factors(points).tolist() == pytest.approx([0.5, 0.2, 0.4, 1.0, 0.2])


def test_people_walk_uphill_at_a_factor_of_its_own():
    slope = SpeedZone(box(3, 0, 30, 2), 0.8, uphill=0.5, downhill=(-2.0, 0.0))
    assert wanted_at(10.0, slope) == pytest.approx(0.5 * 1.25)
    falling = SpeedZone(box(3, 0, 30, 2), 0.8, uphill=0.5, downhill=(1.0, 0.1))
    assert wanted_at(10.0, falling) == pytest.approx(0.8 * 1.25)
    # Of those who do not say where they walk, nobody walks uphill.
    assert strip(slope).speed_factors([(10.0, 1.0)]).tolist() == [0.8]


def test_treads_count_as_far_as_the_way_ahead_leads_over_stairs():
    model = model_of(strip(SpeedZone(box(3, 0, 10, 2), 1.0, tread=0.3)), shipped_map())
    # In 1.5 s at 1.25 m/s they come 1.875 m far: over stairs, half-way onto them, not so far.
    people = [put(model, x, 1.0, preferred_speeds=1.25) for x in (5.0, 3.0 - 0.9375, 0.5)]
    advance(model, 1)
    treads = [model.crowd.agenda["tread"][person.row] for person in people]
    assert treads == pytest.approx([0.3, 0.15, 0.0], abs=0.3 / 15)


def test_ten_metres_at_half_a_metre_a_second():
    # ISO 20414 test 3, flat: 1 m/s, half of it from x = 10 to 20 m.
    plan = strip(SpeedZone("POLYGON ((10 0, 20 0, 20 2, 10 2, 10 0))", 0.5, name="stair"))
    model = PedestrianModel(plan, mobility_map=shipped_map(), record=True, rng=1)
    model.add_pedestrians([(1.0, 1.0)], preferred_speeds=[1.0])
    model.run(max_seconds=100)
    tracks = Trajectories.of(model)
    times = [crossings(tracks, (x, 0.0), (x, 2.0)).time[0] for x in (11.5, 18.5, 22.0, 38.0)]
    assert 7.0 / (times[1] - times[0]) == pytest.approx(0.5, abs=0.05)
    assert 16.0 / (times[3] - times[2]) == pytest.approx(1.0, abs=0.05)


def test_zones_survive_a_file(tmp_path):
    steps = SpeedZone(box(5, 0, 8, 2), 0.7, "steps", uphill=0.5, downhill=(1, 0), tread=0.3)
    plan = strip(steps, SpeedZone(box(1, 0, 2, 2), 0.3, name="mud"))
    plan.write_geojson(tmp_path / "plan.geojson")
    again = FloorPlan.from_geojson(tmp_path / "plan.geojson")
    first, zone = again.zones
    assert (zone.name, zone.factor, zone.uphill, zone.tread) == ("mud", 0.3, None, 0.0)
    assert zone.area.equals(box(1, 0, 2, 2))
    assert (first.uphill, first.downhill, first.tread) == (0.5, (1.0, 0.0), 0.3)
    broken = plan.to_geojson()
    broken["features"][-1]["properties"]["factor"] = "slow"
    with pytest.raises(FloorPlanError, match="feature 3: speed zone 'mud': factor"):
        FloorPlan.from_geojson(broken)


@pytest.mark.parametrize("factor", [0.0, -0.5, 1.5, float("nan"), "half"])
def test_factors_that_cannot_be(factor):
    with pytest.raises(FloorPlanError, match="factor"):
        SpeedZone(box(0, 0, 1, 1), factor)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"uphill": 0.0, "downhill": (1, 0)}, "uphill must be above 0, at most 1, found 0.0"),
        ({"uphill": 0.5}, "downhill must be a direction .*, found None"),
        ({"downhill": (0, 0)}, "downhill must be a direction .*, found \\(0, 0\\)"),
        ({"downhill": "down"}, "downhill must be a direction"),
        ({"tread": -0.1}, "tread must be 0 to 1 m, found -0.1"),
        ({"tread": True}, "tread must be 0 to 1 m, found True"),
    ],
)
def test_slopes_and_treads_that_cannot_be(given, what):
    with pytest.raises(FloorPlanError, match=f"^speed zone: {what}"):
        SpeedZone(box(0, 0, 1, 1), 0.5, **given)


def test_zones_that_cannot_be():
    with pytest.raises(FloorPlanError, match="speed zone 'x'"):
        SpeedZone("POLYGON EMPTY", 0.5, name="x")
    with pytest.raises(FloorPlanError, match="no floor"):
        strip(SpeedZone(box(50, 0, 60, 2), 0.5))
    with pytest.raises(FloorPlanError, match="SpeedZone"):
        strip(box(0, 0, 1, 1))
