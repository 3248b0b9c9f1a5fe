"""Lifts of buildings: what is refused, and how they are written."""

import pytest
import shapely

from mesa_mobility.buildings import Building, Level, Lift, Stairs
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit

HALL = "POLYGON ((0 0, 12 0, 12 6, 0 6, 0 0))"
GROUND = Level(0, HALL, exits=[Exit("out", (0, 2), (0, 4))])
FIRST = Level(1, HALL, 3.0)
DOOR = ((8.0, 4.0), (8.9, 4.0))
AWAY = ((1.0, 4.0), (1.9, 4.0))
BESIDE = ((6.9, 4.0), (6.0, 4.0))


def building(door=DOOR, levels=(GROUND, FIRST), **given):
    return Building(levels, lifts=[Lift("car", [0, 1], door, **given)])


def test_the_car_is_drawn_behind_its_door_on_each_level():
    plan = building().floor_plan
    shaft = plan.shafts[0]
    # The door is 0.9 m wide, the car 1.1 m, and 0.1 m behind it.
    assert shaft.car(0).bounds == pytest.approx((7.9, 4.1, 9.0, 5.5))
    dx = shaft.shift(0, 1)[0]
    assert shaft.car(1).bounds == pytest.approx((7.9 + dx, 4.1, 9.0 + dx, 5.5))
    assert plan.contains([(8.45, 4.05), (8.45, 5.4), (7.95, 4.05), (7.87, 4.5)]).tolist() == [
        True,
        True,
        False,  # the wall beside the door
        False,  # and beside the car
    ]
    assert [gate.name for gate in plan.gates] == ["car at level 0", "car at level 1"]


def test_the_car_may_lie_outside_the_level():
    assert building(door=((8.0, 6.0), (8.9, 6.0))).floor_plan.contains([(8.45, 7.0)])[0]


def test_a_level_without_an_exit_has_the_door_in_its_own_plan():
    plan = building().floor_plan_of(1)
    assert [(each.name, each.a, each.b) for each in plan.exits] == [("car", *DOOR)]
    # The hall less the doorway of 0.1 m, the car, and 0.05 m of wall beside and behind it.
    assert plan.free.area == pytest.approx(12 * 6 - (1.1 + 0.1) * (0.1 + 1.4 + 0.05))


def test_it_is_written_and_read():
    own = building(capacity=12, speed=2.5, everybody=True)
    read = Building.from_geojson(own.to_geojson())
    assert read.lifts == own.lifts
    assert read.lifts[0].capacity == 12
    assert read.to_geojson() == own.to_geojson()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"door": ((8, 4), (8.5, 4))}, r"lift 'car': expected a door 0.7 to 10 m wide, found 0.5"),
        ({"width": 0.8}, "lift 'car': expected a car 0.9 to 10 m wide, found 0.8"),
        ({"depth": 0.5}, "expected a car 0.8 to 10 m deep, found 0.5"),
        ({"speed": 0}, "expected a speed 0.1 to 20 m/s, found 0"),
        ({"door_s": -1}, "expected doors that open in 0 to 60 s, found -1"),
        ({"capacity": 2.5}, "expected a capacity of 1 to 100, found 2.5"),
        ({"door": "here"}, "lift 'car': door must be two points"),
        ({"door": ((8, 1), (8.9, 1))}, "lift 'car' on level 0: no floor at .*1.5 m before lifts"),
        ({"door": ((0.9, 3), (0, 3))}, "lift 'car' on level 0: exit 'out' is in their way"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(given, said):
    with pytest.raises(FloorPlanError, match=said) as error:
        building(**given)
    assert "\n" not in str(error.value)


def test_a_lift_needs_two_known_levels():
    with pytest.raises(FloorPlanError, match="lift 'car': expected two levels or more"):
        Lift("car", [0], DOOR)
    with pytest.raises(FloorPlanError, match="lift 'car': there is no level 7; there are 0, 1"):
        Building([GROUND, FIRST], lifts=[Lift("car", [0, 7], DOOR)])
    with pytest.raises(FloorPlanError, match="escalator or lift 'car' is there twice"):
        Building([GROUND, FIRST], lifts=[Lift("car", [0, 1], DOOR)] * 2)


def test_a_level_has_no_floor_in_the_shaft_of_a_lift_that_passes_it():
    levels = [GROUND, FIRST, Level(2, HALL, 6.0)]
    stairs = [
        Stairs.dog_leg("low", 1, 0, ((3, 1.2), (3, 0)), risers=18, turn="left"),
        Stairs.dog_leg("high", 2, 1, ((3, 5.9), (3, 4.7)), risers=18, turn="right"),
    ]
    express = Building(levels, stairs, lifts=[Lift("car", [0, 2], DOOR)])
    # The car lies behind the door, from x = 7.9 to 9.0 and from y = 4.1 to 5.5.
    on_first = express.places([(8.45, 4.8), (8.45, 4.05), (8.45, 3.95), (7.8, 4.8)], level=1)
    assert express.floor_plan.contains(on_first).tolist() == [False, False, True, True]
    assert express.floor_plan_of(1).exits[0].name.startswith("low")
    # A column in the shaft is no obstacle to it.
    column = Level(1, HALL, 3.0, obstacles=[shapely.box(8.2, 4.5, 8.6, 5.0)])
    assert Building([GROUND, column, levels[2]], stairs, lifts=express.lifts)


def test_a_landing_in_the_shaft_of_a_lift_that_passes_it():
    levels = [GROUND, FIRST, Level(2, HALL, 6.0), Level(3, HALL, 9.0)]
    # Flights of 8 * 0.29 m end at x = 7.42, the landing 1.2 m on; the car begins at x = 7.9.
    high = Stairs.dog_leg("high", 2, 1, ((5.1, 5.4), (5.1, 4.2)), risers=18, turn="right")
    with pytest.raises(FloorPlanError, match=r"lift 'car': landing of high lies in its shaft at"):
        Building(levels, [high], lifts=[Lift("car", [0, 1, 3], DOOR), Lift("other", [0, 2], AWAY)])


def test_stairs_in_the_shaft_of_a_lift_between_other_levels():
    """They fall 12 m on 69 * 0.29 m from x = -4.5 on: 2 m above the lowest stop at x = 7.3."""
    upper = Level(3, shapely.box(-10.0, 0.0, -4.0, 6.0), 9.0)
    cellar = Level(-1, shapely.box(10.0, 0.0, 20.0, 6.0), -3.0, exits=[Exit("a", (20, 1), (20, 3))])
    ledge = shapely.box(0.0, 4.0, 10.0, 6.0)
    ground = Level(0, ledge, exits=[Exit("b", (0, 4.2), (0, 5.8))])
    long = Stairs.straight("long", 3, -1, ((-4.5, 3.4), (-4.5, 2.0)), risers=70, tread=0.29)
    levels, lift = [ground, cellar, Level(1, ledge, 3.0), upper], Lift("car", [0, 1], BESIDE)
    with pytest.raises(FloorPlanError, match=r"lift 'car': stairs 'long' lies in its shaft at \(6"):
        Building(levels, [long], lifts=[lift])
