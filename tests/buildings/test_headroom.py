"""Floors above each other need 1.5 m between them, as the safety check of runs assumes."""

import pytest
import shapely

from mesa_mobility import Building, Exit, Level, Ramp, Stairs
from mesa_mobility.errors import FloorPlanError

HALL = "POLYGON ((0 0, 24 0, 24 8, 0 8, 0 0))"
GROUND = Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))])


def refusal(levels, stairs):
    with pytest.raises(FloorPlanError) as caught:
        Building(levels, stairs)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_levels_above_each_other():
    stage = "POLYGON ((10 0, 20 0, 20 8, 10 8, 10 0))"
    ramp = Ramp.straight("ramp", 1, 0, ((10, 2), (10, 4)), length=7.0)
    said = refusal([GROUND, Level(1, stage, 1.2)], [ramp])
    assert said.startswith("level 0 and level 1: one lies 1.20 m above the other at (")
    assert said.endswith("expected 1.5 m or no floor there")
    # Side by side they are fine.
    beside = Level(0, "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=GROUND.exits)
    assert Building([beside, Level(1, stage, 1.2)], [ramp])


@pytest.mark.parametrize(("rise", "fits"), [(2.88, False), (3.0, True)])
def test_the_landing_of_a_dog_leg_over_a_level(rise, fits):
    """It is halfway up: 1.44 m and 1.5 m. Its area is x 14.0 + 8 * 0.29 = 16.32 and 1.2 m on."""
    stairs = Stairs.dog_leg("north", 1, 0, ((14, 8), (14, 6.8)), risers=18, turn="right")
    levels = [GROUND, Level(1, HALL, rise)]
    if fits:
        assert Building(levels, [stairs])
        return
    said = refusal(levels, [stairs])
    assert said.startswith("level 0 and landing of north: one lies 1.44 m above the other at (16.9")


def test_a_ramp_over_another_level():
    """Down from 3 m at x = 4 to 0 m at x = 20: 0.1875 m a metre. Over the dais at 0.6 m, x 14 to
    16, it is 1.125 to 0.75 m high."""
    upper = Level(1, "POLYGON ((0 0, 4 0, 4 8, 0 8, 0 0))", 3.0)
    ground = Level(
        0, "POLYGON ((20 0, 30 0, 30 8, 20 8, 20 0))", exits=[Exit("out", (30, 3), (30, 5))]
    )
    ramp = Ramp.straight("ramp", 1, 0, ((4, 5), (4, 3)), length=16.0)
    dais = Level(
        2, "POLYGON ((14 0, 16 0, 16 8, 14 8, 14 0))", 0.6, exits=[Exit("up", (14, 0), (16, 0))]
    )
    said = refusal([upper, ground, dais], [ramp])
    assert said.startswith("ramp 'ramp' and level 2: one lies 0.3")
    assert "at (15." in said


def floor(number, x, y, elevation, exit_y):
    area = shapely.box(x[0], y[0], x[1], y[1])
    street = Exit(f"street {number}", (x[0], exit_y), (x[1], exit_y))
    return Level(number, area, elevation, exits=[street])


def crossing_ramps(higher):
    """Ramp A from 3 to 0 m eastwards, and ramp B from 4 to 1 m southwards across it, or higher."""
    levels = [
        floor(1, (-4, 0), (0, 8), 3.0, 8),
        floor(0, (20, 24), (0, 8), 0.0, 8),
        floor(3, (5, 15), (20, 24), 4.0 + higher, 24),
        floor(2, (5, 15), (-20, -16), 1.0 + higher, -20),
    ]
    one = Ramp.straight("A", 1, 0, ((0, 5), (0, 3)), length=20)
    return Building(levels, [one, Ramp.straight("B", 3, 2, ((11, 20), (9, 20)), length=36)])


# At (9, 3) A is 1.65 m and B 4 - 17 / 12 = 2.583 m high: the least difference, 0.933 m.
@pytest.mark.parametrize(
    ("higher", "between", "spot"),
    [(0.0, "0.93", r"9.00, 3.00"), (0.566, "1.50", r"9.00, 3.00"), (-1.1, "0.00", "")],
)
def test_flights_too_close_above_each_other_are_refused(higher, between, spot):
    said = f"ramp 'A' and ramp 'B': one lies {between} m above the other at \\({spot}"
    with pytest.raises(FloorPlanError, match=said) as caught:
        crossing_ramps(higher)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("higher", [0.567, -2.9])
def test_flights_may_cross_far_enough_above_each_other(higher):
    assert len(crossing_ramps(higher).flights) == 2
