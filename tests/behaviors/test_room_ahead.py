import math

import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import RoomAhead
from shapely import LineString

from mesa_mobility.errors import ModelError
from tests.fixtures.options import (
    Chooser,
    Ending,
    candidates,
    crowded,
    mirrored,
    one_option,
    shifts,
    turned_and_moved,
    turns,
)
from tests.fixtures.oracles.costs import room_ahead
from tests.fixtures.oracles.movements import Body

EDGE = 1e-4
A_METRE_A_SECOND = Ending(displacement=1.5, duration=1.5)
STANDING = Ending(displacement=0.0, duration=0.4)

# Figures below are for these: as far as one walks in a second, half a metre at least.
ROUND = {"time": 1.0, "least": 0.5}
CORE = 0.2


def across(x: float, low: float = -5.0, high: float = 5.0):
    """A wall across the way of people who walk to the right."""
    return (x, low, x, high)


def cost(ending: Ending, *walls, **numbers) -> float:
    term = RoomAhead(**(ROUND | numbers))
    forth = term.cost(one_option(ending, core=CORE, walls=walls))
    back = term.cost(one_option(ending, core=CORE, walls=[(*w[2:], *w[:2]) for w in walls]))
    assert back == pytest.approx(forth, abs=1e-12)
    return float(forth[0])


@pytest.mark.parametrize(
    ("ending", "wall", "expected"),
    [
        # A metre is wanted. The core touches the wall 0.2 m before one is there.
        (A_METRE_A_SECOND, across(1.0), 0.2),
        (A_METRE_A_SECOND, across(0.45), 0.75),
        (A_METRE_A_SECOND, across(1.2), 0.0),
        (A_METRE_A_SECOND, across(3.0), 0.0),
        # Nearer than the core there is no room at all.
        (A_METRE_A_SECOND, across(0.1), 1.0),
        # The same speed for a shorter time.
        (Ending(displacement=0.4, duration=0.4), across(0.45), 0.75),
        # 2 m are wanted; half a metre by slow and standing people.
        (Ending(displacement=3.0, duration=1.5), across(1.2), 0.5),
        (Ending(displacement=0.1, duration=0.4), across(0.45), 0.5),
        (STANDING, across(0.45), 0.5),
        # Behind, beside, and along the way.
        (A_METRE_A_SECOND, across(-0.3), 0.0),
        (A_METRE_A_SECOND, (-5.0, 0.21, 5.0, 0.21), 0.0),
        (A_METRE_A_SECOND, (0.5, 0.0, 1.0, 0.0), 0.0),
        # At 45 degrees the core touches a wall sqrt(2) times as early.
        (A_METRE_A_SECOND, (0.0, -1.0, 2.0, 1.0), 0.2 * math.sqrt(2.0)),
        (A_METRE_A_SECOND, (0.0, 1.0, 2.0, -1.0), 0.2 * math.sqrt(2.0)),
        # One that ends on the way counts in full, 0.05 and 0.15 m beside it three quarters and one,
        # and nothing where the core of 0.2 m passes it.
        (A_METRE_A_SECOND, across(0.7, 0.0), 0.5),
        (A_METRE_A_SECOND, across(0.7, 0.05), 0.375),
        (A_METRE_A_SECOND, across(0.7, 0.15), 0.125),
        (A_METRE_A_SECOND, across(0.7, 0.21), 0.0),
        (A_METRE_A_SECOND, across(0.7, high=-0.05), 0.375),
        (A_METRE_A_SECOND, across(0.7, high=-0.15), 0.125),
        (A_METRE_A_SECOND, across(0.7, high=-0.21), 0.0),
        # So on a slant: the distance beside the way is at right angles to it. The line of the wall
        # meets the way a metre ahead, whether the wall ends before or after.
        (A_METRE_A_SECOND, (1.1, 0.1, 3.0, 2.0), 0.1 * math.sqrt(2.0)),
        (A_METRE_A_SECOND, (1.15, 0.15, 3.0, 2.0), 0.05 * math.sqrt(2.0)),
        (A_METRE_A_SECOND, (0.85, -0.15, -1.0, -2.0), 0.05 * math.sqrt(2.0)),
        (A_METRE_A_SECOND, (1.21, 0.21, 3.0, 2.0), 0.0),
    ],
)
def test_numbers_worked_out_by_hand(ending, wall, expected):
    assert cost(ending, wall) == pytest.approx(expected, abs=1e-12)


def test_the_numbers_given_are_used():
    assert cost(A_METRE_A_SECOND, across(1.2), time=4.0) == pytest.approx(0.75)
    assert cost(STANDING, across(1.2), least=2.0) == pytest.approx(0.5)
    assert cost(A_METRE_A_SECOND, across(1.2), least=2.0) == pytest.approx(0.5)


def test_a_slimmer_body_has_more_room():
    options = [one_option(A_METRE_A_SECOND, core=c, walls=[across(1.0)]) for c in (0.1, 0.3)]
    assert [RoomAhead(**ROUND).cost(o)[0] for o in options] == pytest.approx([0.1, 0.3])


def test_ahead_is_where_one_faces_at_the_mobility_point():
    # At (2, 3), facing up; the way there went to the right.
    up = Ending((2.0, 3.0), heading=math.pi / 2, displacement=1.5, duration=1.5)
    assert cost(up, (0.0, 4.0, 5.0, 4.0)) == pytest.approx(0.2)
    assert cost(up, (2.3, 0.0, 2.3, 5.0)) == 0.0
    assert cost(up, (0.0, 2.8, 5.0, 2.8)) == 0.0


@pytest.mark.parametrize("facing", [0.0, 1.0, math.pi / 2, -2.0])
def test_whoever_turns_on_the_spot_is_judged_by_the_way_to_the_target(facing):
    # Its jamb stops nobody from turning towards a door.
    turning = Ending(heading=facing, displacement=0.0, duration=0.4)
    term = RoomAhead(**ROUND)
    for target, expected in (((3.0, 0.0), 0.5), ((0.0, 3.0), 0.0)):
        options = one_option(turning, core=CORE, walls=[across(0.45)], target=target)
        assert term.cost(options) == pytest.approx([expected])


def test_the_worst_wall_counts_and_those_of_others_do_not():
    near, nearer = across(1.0), across(0.45)
    assert cost(A_METRE_A_SECOND, near, nearer) == pytest.approx(0.75)
    assert cost(A_METRE_A_SECOND, nearer, near) == pytest.approx(0.75)
    assert cost(A_METRE_A_SECOND) == 0.0
    options = candidates(
        Chooser([A_METRE_A_SECOND], core=CORE),
        Chooser([A_METRE_A_SECOND, STANDING], core=CORE, walls=[near, nearer]),
        Chooser([A_METRE_A_SECOND], core=CORE, walls=[near]),
    )
    assert RoomAhead(**ROUND).cost(options) == pytest.approx([0.0, 0.75, 0.5, 0.2])


def test_default_numbers_are_used():
    term = RoomAhead()
    # Half of the room that a standing person wants, and half of what a walker wants.
    for ending, wanted in ((STANDING, term.least), (A_METRE_A_SECOND, max(term.time, term.least))):
        options = one_option(ending, core=CORE, walls=[across(CORE + wanted / 2.0)])
        assert term.cost(options) == pytest.approx([0.5])


@pytest.mark.parametrize("name", ["time", "least"])
@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, math.inf])
def test_numbers_out_of_range_are_refused_in_one_line(name, value):
    says = rf"^room_ahead: {name} .*expected more than 0 m?/?s$"
    with pytest.raises(ModelError, match=says) as caught:
        RoomAhead(**{name: value})
    assert "\n" not in str(caught.value)


def walls_of(options, b):
    own = options.walls[options.wall_offsets[b] : options.wall_offsets[b + 1]]
    return tuple(LineString(wall.reshape(2, 2)) for wall in own)


def way_to_target(options, b):
    return np.asarray(options.targets[b]) - options.positions[b]


def decided(options):
    """(n,) where rounding does not decide on which side of a wall's line one is, or edge on."""
    sure = np.ones(len(options), dtype=bool)
    for k, b in enumerate(options.owner):
        way = np.array([math.cos(options.headings[k]), math.sin(options.headings[k])])
        length = np.hypot(*way_to_target(options, b))
        # Rounding decides, too, who stands, and where a target is that is all but here.
        sure[k] = abs(options.displacements[k] - 0.01) > 1e-6 and not 0.0 < length < 1e-6
        if options.displacements[k] <= 0.01 and length > 0.0:
            way = way_to_target(options, b) / length
        for wall in options.walls[options.wall_offsets[b] : options.wall_offsets[b + 1]]:
            ends = wall.reshape(2, 2) - options.points[k]
            along = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
            away = along[0] * ends[0, 1] - along[1] * ends[0, 0]
            slant = along[0] * way[1] - along[1] * way[0]
            sure[k] &= min(abs(away), abs(slant)) > EDGE
    return sure


@given(crowded)
@settings(deadline=None)
def test_the_worst_wall_of_any_batch(options):
    term = RoomAhead()
    of = room_ahead(term)
    sure, costs = decided(options), term.cost(options)
    for k, b in enumerate(options.owner):
        # The oracle measures speeds by the ground between start and end.
        start = options.points[k] - (options.displacements[k], 0.0)
        body = Body(
            None,
            *start,
            0.0,
            0.0,
            0.0,
            0,
            options.cores[b],
            target=tuple(start + way_to_target(options, b)),
            walls=walls_of(options, b),
        )
        end = (*options.points[k], options.headings[k])
        if sure[k]:
            assert costs[k] == pytest.approx(of(body, end, options.durations[k], [], 1.0), abs=1e-6)


@given(crowded)
@settings(deadline=None)
def test_costs_are_shares(options):
    costs = RoomAhead().cost(options)
    assert ((costs >= 0.0) & (costs <= 1.0)).all()


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_does_not_depend_on_where_north_is_nor_on_left_and_right(options, angle, by):
    sure, costs = decided(options), RoomAhead().cost(options)
    moved = RoomAhead().cost(turned_and_moved(options, angle, by))
    np.testing.assert_allclose(moved[sure], costs[sure], atol=1e-6)
    np.testing.assert_allclose(RoomAhead().cost(mirrored(options))[sure], costs[sure], atol=1e-9)
