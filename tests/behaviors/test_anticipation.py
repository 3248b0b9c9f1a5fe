import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import Anticipation

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
from tests.fixtures.oracles.costs import anticipation
from tests.fixtures.oracles.movements import Body

STILL = (0.0, 0.0)
ELSEWHERE = (9.0, 0.0)
A_METRE_A_SECOND = Ending((1.5, 0.0), displacement=1.5, duration=1.5)
STANDING = Ending(displacement=0.0, duration=0.4)

# Figures below are for these: a metre apart, three seconds, 0.6 of the present distance; from
# 0.9 m/s on.
ROUND = {"distance": 1.0, "horizon": 3.0, "share": 0.6, "slowest": 0.9}


def cost(ending: Ending, *neighbours, target=ELSEWHERE, **numbers) -> float:
    term = Anticipation(**(ROUND | numbers))
    return float(term.cost(one_option(ending, target=target, neighbours=neighbours))[0])


@pytest.mark.parametrize(
    ("ending", "place", "velocity", "expected"),
    [
        # Towards each other at 2 m/s: 4 m apart they count half, at 2 m 4 / 6.
        (A_METRE_A_SECOND, (4.0, 0.0), (-1.0, 0.0), 0.5),
        (A_METRE_A_SECOND, (2.0, 0.0), (-1.0, 0.0), 4.0 / 6.0),
        # It does not matter how long the option takes to walk at that velocity.
        (Ending((0.4, 0.0), displacement=0.4, duration=0.4), (4.0, 0.0), (-1.0, 0.0), 0.5),
        # Passing each other at 0.6 and 0.8 m, on either side, from 1.85 and 1.7 m away; the squares
        # of 0.6 and 0.8 are missing. At a metre nothing is left.
        (A_METRE_A_SECOND, (1.75, 0.6), (-1.0, 0.0), 0.64 * 4.0 / 5.85),
        (A_METRE_A_SECOND, (1.75, -0.6), (-1.0, 0.0), 0.64 * 4.0 / 5.85),
        (A_METRE_A_SECOND, (1.5, 0.8), (-1.0, 0.0), 0.36 * 4.0 / 5.7),
        (A_METRE_A_SECOND, (4.0, 1.0), (-1.0, 0.0), 0.0),
        # In 3.25 s, which is beyond the horizon: in 3 s they are half a metre apart.
        (A_METRE_A_SECOND, (6.5, 0.0), (-1.0, 0.0), 0.75 * 4.0 / 10.5),
        (A_METRE_A_SECOND, (7.0, 0.0), (-1.0, 0.0), 0.0),
        # Across: both at the corner of a square of 2 m in 2 s.
        (A_METRE_A_SECOND, (2.0, -2.0), (0.0, 1.0), 4.0 / (4.0 + 2.0 * math.sqrt(2.0))),
        # Somebody from behind, at 2 m/s more.
        (A_METRE_A_SECOND, (-2.0, 0.0), (3.0, 0.0), 4.0 / 6.0),
        # Away from each other, one after the other, and at the same velocity.
        (A_METRE_A_SECOND, (-0.5, 0.0), (-1.0, 0.0), 0.0),
        (A_METRE_A_SECOND, (0.5, 0.0), (3.0, 0.0), 0.0),
        (A_METRE_A_SECOND, (0.5, 0.0), (1.0, 0.0), 0.0),
        # Relative speeds of 0.9, 1, 1.1 and 1.4 m/s: of their squares 0.81, 1, 1.21 and 1.96 the
        # first counts nothing and the last in full. All are 2 m apart.
        (A_METRE_A_SECOND, (2.0, 0.0), (0.1, 0.0), 0.0),
        (A_METRE_A_SECOND, (2.0, 0.0), STILL, 0.19 / 1.15 * 4.0 / 6.0),
        (A_METRE_A_SECOND, (2.0, 0.0), (-0.1, 0.0), 0.4 / 1.15 * 4.0 / 6.0),
        (A_METRE_A_SECOND, (2.0, 0.0), (-0.4, 0.0), 4.0 / 6.0),
        # People who stand see others come as well: 2.8 m at 1.4 m/s.
        (STANDING, (2.8, 0.0), (-1.4, 0.0), 4.0 / 6.8),
        (STANDING, (2.8, 0.0), STILL, 0.0),
        # Half a metre off the passing distance is 0.3 m, 0.6 of it: at 1 m/s straight on, 0.14 m
        # aside, and 0.3 m aside.
        (A_METRE_A_SECOND, (0.5, 0.0), STILL, 0.19 / 1.15 * 4.0 / 4.5),
        (A_METRE_A_SECOND, (0.48, 0.14), STILL, 0.19 / 1.15 * (1 - 0.0196 / 0.09) * 4.0 / 4.5),
        (A_METRE_A_SECOND, (0.4, 0.3), STILL, 0.0),
    ],
)
def test_numbers_worked_out_by_hand(ending, place, velocity, expected):
    assert cost(ending, (place, velocity)) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("ending", [STANDING, A_METRE_A_SECOND])
def test_people_who_stay_leave_it_to_others_to_step_aside(ending):
    # Head on at 1.4 m/s or more, from 2.8 m away: 4 / 6.8, for a target a millimetre away as well.
    coming = ((2.8, 0.0), (-1.4, 0.0))
    for target in ((0.001, 0.0), (0.0, -0.001)):
        assert cost(ending, coming, target=target) == pytest.approx(4.0 / 6.8)
    assert cost(ending, coming, target=(0.0, 0.0)) == 0.0


def test_only_those_who_stay_get_no_cost():
    # All stand at (1, 2), which is the target of the first and the last. The target of the other is
    # (0, 0), a place like any other.
    coming, place = [((3.8, 2.0), (-1.4, 0.0))], (1.0, 2.0)
    halting = Ending(place, displacement=0.0, duration=0.4)
    stays, goes = (
        Chooser([halting], target=target, position=place, neighbours=coming)
        for target in (place, (0.0, 0.0))
    )
    costs = Anticipation(**ROUND).cost(candidates(stays, goes, stays))
    assert costs == pytest.approx([0.0, 4.0 / 6.8, 0.0])


@pytest.mark.parametrize(("target", "expected"), [((9.0, 0.0), 4.0 / 6.8), ((0.0, 0.0), 0.0)])
def test_the_bound_for_people_who_stay_is_nought(target, expected):
    # A group of one, that stands.
    least = Anticipation.bound.function(
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.0, *target, 2.8, 0.0, -1.4, 0.0,
        -1.0, 0.0, 0.0, tuple(ROUND.values()),
    )  # fmt: skip
    assert least == pytest.approx(expected)


def test_the_numbers_given_are_used():
    # 1.85 m away, 0.6 m aside.
    oncoming, far = ((1.75, 0.6), (-1.0, 0.0)), 4.0 / 5.85
    nearer = cost(A_METRE_A_SECOND, oncoming, distance=0.75)
    assert nearer == pytest.approx(0.36 * far)
    # In a quarter of a second they are still 1.39 m apart.
    assert cost(A_METRE_A_SECOND, oncoming, horizon=0.25) == 0.0
    # 0.4 of 1.85 m is 0.74 m.
    queueing = cost(A_METRE_A_SECOND, oncoming, share=0.4)
    assert queueing == pytest.approx((1.0 - 0.36 / 0.5476) * far)
    # The squares of 1.75, 2 and 2.25 are 3.0625, 4 and 5.0625.
    slow = cost(A_METRE_A_SECOND, oncoming, slowest=1.75)
    assert slow == pytest.approx(0.64 * 0.46875 * far)


def test_people_who_walk_away_do_not_count_whatever_the_share():
    # The room asked for is three times the distance; there is less of it at every time.
    assert cost(A_METRE_A_SECOND, ((-0.3, 0.0), (-1.0, 0.0)), share=3.0) == 0.0
    assert cost(A_METRE_A_SECOND, ((0.0, 0.3), (1.0, 2.0)), share=3.0) == 0.0


def test_from_any_place():
    moved = one_option(
        Ending((-1.5, 7.0), displacement=1.5, duration=1.5),
        position=(-3.0, 7.0),
        neighbours=[((-1.25, 7.6), (-1.0, 0.0))],
    )
    assert Anticipation(**ROUND).cost(moved) == pytest.approx([0.64 * 4.0 / 5.85])


def test_neighbours_add_up_and_those_of_others_do_not_count():
    two = [((4.0, 0.0), (-1.0, 0.0)), ((1.75, 0.6), (-1.0, 0.0))]
    alone = Chooser([A_METRE_A_SECOND], target=ELSEWHERE)
    beset = Chooser([A_METRE_A_SECOND, STANDING], target=ELSEWHERE, neighbours=two)
    costs = Anticipation(**ROUND).cost(candidates(alone, beset, alone))
    # They come upon somebody who stands at 1 m/s: after 3 s the first is still a metre off.
    second = 0.64 * 4.0 / 5.85
    assert costs == pytest.approx([0.0, 0.5 + second, second * 0.19 / 1.15, 0.0])


def test_default_numbers_are_used():
    # Head on, at three times the speed from which people count, half way to the horizon.
    term = Anticipation()
    assert term.parameters() == (term.distance, term.horizon, term.share, term.slowest)
    speed, time = 3.0 * term.slowest, term.horizon / 2.0
    coming = ((speed * time, 0.0), (-speed, 0.0))
    options = one_option(STANDING, target=ELSEWHERE, neighbours=[coming])
    fast = min(8.0 * term.slowest**2 / (term.slowest + 0.25), 1.0)
    assert term.cost(options) == pytest.approx([fast * 4.0 / (4.0 + speed * time)])


@pytest.mark.parametrize("name", ["distance", "horizon", "share", "slowest"])
@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, math.inf])
def test_numbers_out_of_range_are_refused_in_one_line(name, value):
    says = rf"^anticipation: {name} is .*expected more than 0$"
    with pytest.raises(ModelError, match=says) as caught:
        Anticipation(**{name: value})
    assert "\n" not in str(caught.value)


def nearby(options, b):
    """The neighbours of somebody as bodies."""
    own = range(options.neighbour_offsets[b], options.neighbour_offsets[b + 1])
    return [
        Body(None, *options.neighbour_positions[k], 0.0, *options.neighbour_velocities[k], 0, 0.15)
        for k in own
    ]


@given(crowded, st.booleans())
@settings(deadline=None)
def test_sum_over_the_neighbours_of_any_batch(options, first_stays):
    if first_stays:
        options = replace(options, targets=np.vstack([options.positions[:1], options.targets[1:]]))
    term = Anticipation()
    of = anticipation(term)
    expected = [
        of(Body(None, *options.positions[b], 0.0, 0.0, 0.0, 0, 0.15, tuple(options.targets[b])),
           (*options.points[k], 0.0), options.durations[k], nearby(options, b), 1.0)
        for k, b in enumerate(options.owner)
    ]  # fmt: skip
    np.testing.assert_allclose(term.cost(options), expected, atol=1e-6)


@given(crowded)
@settings(deadline=None)
def test_costs_are_finite_and_never_negative(options):
    costs = Anticipation().cost(options)
    assert np.isfinite(costs).all()
    assert (costs >= 0.0).all()


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_does_not_depend_on_where_north_is_nor_on_left_and_right(options, angle, by):
    costs = Anticipation().cost(options)
    moved = turned_and_moved(options, angle, by)
    np.testing.assert_allclose(Anticipation().cost(moved), costs, atol=1e-6)
    np.testing.assert_allclose(Anticipation().cost(mirrored(options)), costs, atol=1e-9)


@given(
    distance=st.floats(1.5, 6.0),
    aside=st.floats(0.0, 1.5),
    closer=st.floats(0.0, 1.0),
    speed=st.floats(0.0, 2.0),
)
def test_a_nearer_approach_never_costs_less(distance, aside, closer, speed):
    far, near = (
        cost(A_METRE_A_SECOND, ((distance, y), (-speed, 0.0))) for y in (aside, closer * aside)
    )
    assert near >= far - 1e-9
