"""Escalators of buildings: their steps and times, what is refused, and how they are written."""

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import Building, Escalator, Exit, Level
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Belt, Router
from tests.fixtures.escalators import HALL, HEAD, LENGTH, RISE, hall

GROUND = Level(0, HALL, exits=[Exit("west", (0, 0.5), (0, 5.5))])
FIRST = Level(1, HALL, RISE, exits=[Exit("east", (24, 0.5), (24, 5.5))])


def escalator(name="esc", upper=1, lower=0, head=HEAD, length=LENGTH, **given):
    return Escalator.straight(name, upper, lower, head, length=length, **given)


def test_its_speed_is_that_along_the_slope():
    """4 m of rise at 30 degrees are 8 m along the slope: 0.75 m/s is 0.75 cos 30 in plan."""
    (flight,), landings = escalator().parts(RISE, 0.0)
    assert landings == []
    assert flight.moves == pytest.approx(0.75 * math.sqrt(3.0) / 2.0, abs=1e-3)
    assert escalator(direction="up").parts(RISE, 0.0)[0][0].moves == -flight.moves
    # 8 m are 20 steps of 0.4 m, each 0.2 m high.
    assert (flight.risers, flight.what) == (20, "escalator")
    assert flight.riser == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("given", "people_an_hour"),
    [
        ({}, 6750.0),  # 0.75 m/s / 0.4 m = 1.875 people a second
        ({"speed": 0.5}, 4500.0),
        ({"head": ((14.0, 2.7), (14.0, 3.3))}, 4050.0),  # 0.6 m wide
        ({"capacity": 5400.0}, 5400.0),
    ],
)
def test_it_takes_one_person_on_each_step_unless_told(given, people_an_hour):
    assert 3600.0 / escalator(**given).gap_s == pytest.approx(people_an_hour)


def test_with_speed_0_it_is_a_stair():
    building = hall(speed=0.0)
    (flight,) = building.flights
    assert (flight.what, flight.moves, flight.risers) == ("stairs", 0.0, 20)
    # Treads of 0.365 m: 0.861 * sqrt(0.365 / 0.2) / 1.40 * 0.365 / 0.416, SFPE.
    assert flight.factor == pytest.approx(0.729, abs=2e-3)
    (seam,) = building.floor_plan.seams
    assert seam.belt is None
    assert len(seam.links) == 2
    assert {zone.factor for zone in building.floor_plan.zones} == {flight.factor}


def test_routes_count_its_time_and_lead_one_way():
    building = hall(direction="down")
    router = Router(building.floor_plan, clearance=0.2)
    [above, below] = np.concatenate(
        [building.places([(16.0, 3.0)], 1), building.places([(2.0, 3.0)], 0)]
    )
    # 2 m to the head; 8 m at 0.75 m/s, in which people walk 1.34 m/s; 7.07 m from the foot.
    expected = 2.0 + 8.0 / 0.75 * 1.34 + (14.0 - LENGTH)
    west = router.destination(["west"])
    assert router.targets([above], [west]).distances[0] == pytest.approx(expected, abs=0.05)
    east = router.destination(["east"])
    assert np.isinf(router.targets([below], [east]).distances[0])
    up = hall(direction="up")
    router = Router(up.floor_plan, clearance=0.2)
    east = router.destination(["east"])
    assert np.isfinite(router.targets(up.places([(2.0, 3.0)], 0), [east]).distances[0])
    # Who cannot use stairs has no way over it.
    router = Router(up.floor_plan, clearance=0.2, climbs=False)
    east = router.destination(["east"])
    assert np.isinf(router.targets(up.places([(2.0, 3.0)], 0), [east]).distances[0])


def test_an_escalator_that_runs_up_leads_nobody_down():
    above = Level(1, HALL, RISE)
    for way, speed in (("down", 0.75), ("up", 0.0)):
        assert Building([GROUND, above], [escalator(direction=way, speed=speed)]).flights
    with pytest.raises(FloorPlanError, match="level 1: no stairs, ramp, escalator or lift lead"):
        Building([GROUND, above], [escalator(direction="up")])


@settings(max_examples=30)
@given(
    length=st.floats(5.8, 20.0),
    speed=st.just(0.0) | st.floats(0.1, 1.0),
    capacity=st.none() | st.floats(100.0, 13_500.0),
    direction=st.sampled_from(["up", "down"]),
    wide=st.floats(0.6, 1.0),
)
def test_what_is_written_is_read_again(length, speed, capacity, direction, wide):
    big = "POLYGON ((-30 -30, 30 -30, 30 30, -30 30, -30 -30))"
    levels = [
        Level(0, big, exits=[Exit("out", (-30, 0), (-30, 1))]),
        Level(1, big, 4.0, exits=[Exit("up", (-30, 0), (-30, 1))]),
    ]
    own = escalator(
        head=((1.0, 2.0), (1.0, 2.0 + wide)),
        length=length,
        speed=speed,
        capacity=capacity,
        direction=direction,
    )
    building = Building(levels, [own])
    read = Building.from_geojson(json.loads(json.dumps(building.to_geojson())))
    assert read.stairs == building.stairs
    assert read.to_geojson() == building.to_geojson()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"direction": "left"}, r"escalator 'esc': expected the direction 'up' or 'down'"),
        ({"speed": 1.5}, r"escalator 'esc': expected a speed of 0, or 0.1 to 1 m/s, found 1.5"),
        ({"speed": 1e-9}, r"expected a speed of 0, or 0.1 to 1 m/s, found 1e-09"),
        ({"speed": float("nan")}, r"expected a speed of 0, or 0.1 to 1 m/s, found nan"),
        ({"capacity": 0}, r"expected a capacity of 1 to 20000 people an hour, found 0"),
        ({"head": ((14, 2), (14, 4))}, r"expected a width of 0.58 to 1.1 m, found 2.0"),
        ({"length": 1.0}, r"expected a length of 1.5 to 200 m, found 1.0"),
        ({"length": 4.0}, r"escalator 'esc': 4 m down over 4 m is an inclination of 45.0 degrees"),
        ({"upper": 0, "lower": 1}, r"-4 m down"),
        (
            {"head": ((24, 2.5), (24, 3.5))},
            r"escalator 'esc' on level 1: no floor at \(24.25, 3.00\)",
        ),
    ],
)
def test_bad_escalators_get_one_line(given, said):
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building([GROUND, FIRST], [escalator(**given)])
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("length", None, r"feature \d+: length must be a number, found None"),
        ("speed", "fast", r"feature \d+: speed must be a number, found 'fast'"),
        ("direction", 3, r"feature \d+: escalator 'esc': expected the direction"),
        ("to", "cellar", r"feature \d+: to must be a whole number, found 'cellar'"),
        ("to", 7, r"escalator 'esc': there is no level 7"),
    ],
)
def test_bad_files_name_the_feature(name, value, said):
    collection = hall().to_geojson()
    collection["features"][-1]["properties"][name] = value
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building.from_geojson(collection)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("numbers", [(0.0, 5.0, 1.0), (1.0, 0.0, 1.0), (1.0, 5.0, math.inf)])
def test_bad_belts_are_refused(numbers):
    with pytest.raises(FloorPlanError, match="belt: "):
        Belt(*numbers)
