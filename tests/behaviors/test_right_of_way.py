import math

import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import RightOfWay

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

STILL = (0.0, 0.0)
TO_THE_RIGHT, TO_THE_LEFT = (1.0, 0.0), (-1.0, 0.0)
EDGE = 1e-7

# Figures below are for these; one's own target is 20 m to the left.
ROUND = {"width": 0.5, "bias": 0.1, "ahead": 0.5}
GOAL = (-20.0, 0.0)


def cost(point, *neighbours, target=GOAL, **numbers) -> float:
    term = RightOfWay(**(ROUND | numbers))
    return float(term.cost(one_option(Ending(point), target=target, neighbours=neighbours))[0])


def oncoming(x: float, y: float, lead: float = 0.0):
    return ((x, y), TO_THE_RIGHT, TO_THE_RIGHT, lead)


def same_way(x: float, y: float, lead: float):
    return ((x, y), TO_THE_LEFT, TO_THE_LEFT, lead)


@pytest.mark.parametrize(
    ("aside", "expected"),
    [
        # Metres to the left of somebody who comes to the right, its line being y = 0: its left is
        # where one passes on the right. Nothing from 0.5 m there, and from 0.7 m on the wrong side;
        # the top lies halfway between, 0.1 m off.
        (0.6, 0.0),
        (0.5, 0.0),
        (0.2, 0.5),
        (-0.1, 1.0),
        (-0.4, 0.5),
        (-0.7, 0.0),
        (-0.8, 0.0),
    ],
)
def test_oncoming_people_are_passed_on_the_right(aside, expected):
    assert cost((-1.0, aside), oncoming(-3.0, 0.0)) == pytest.approx(expected, abs=1e-12)
    # Those who keep to the left make it the other side.
    assert cost((-1.0, -aside), oncoming(-3.0, 0.0), bias=-0.1) == pytest.approx(
        expected, abs=1e-12
    )


def test_the_top_is_on_the_line_without_a_bias():
    for aside, expected in ((0.0, 1.0), (0.25, 0.5), (-0.25, 0.5), (0.5, 0.0), (-0.5, 0.0)):
        found = cost((-1.0, aside), oncoming(-3.0, 0.0), bias=0.0)
        assert found == pytest.approx(expected, abs=1e-12)


def test_how_far_ahead_of_an_oncoming_person_does_not_count():
    near, far = (cost((x, 0.2), oncoming(-3.0, 0.0)) for x in (-2.9, 5.0))
    assert near == far == pytest.approx(0.5)
    # But behind its back nobody is in its way.
    assert cost((-3.1, 0.2), oncoming(-3.0, 0.0)) == 0.0


@pytest.mark.parametrize(
    ("point", "lead", "expected"),
    [
        # A neighbour at x = 1 on its way to the left, as oneself, and half a metre ahead of it.
        ((0.6, 0.0), 2.0, 0.5),
        ((0.6, 0.25), 2.0, 0.25),
        ((0.6, -0.25), 2.0, 0.25),  # no side is better than the other
        ((0.6, 0.5), 2.0, 0.0),
        ((0.4, 0.0), 2.0, 0.0),  # farther ahead than belongs to it
        ((1.1, 0.0), 2.0, 0.0),  # behind
        ((0.6, 0.0), -2.0, 0.0),  # has farther to go than oneself
        ((0.6, 0.0), 0.0, 0.0),
        ((0.6, 0.0), math.nan, 0.0),  # neither has a way
    ],
)
def test_who_has_less_far_to_go_has_it_over_those_right_beside(point, lead, expected):
    assert cost(point, same_way(1.0, 0.0, lead)) == pytest.approx(expected, abs=1e-12)


def test_oncoming_is_who_goes_against_where_oneself_goes():
    # Not how the two stand to one another: target to the right now, so this one goes the same way.
    assert cost((-1.0, 0.0), oncoming(-3.0, 0.0), target=(20.0, 0.0)) == 0.0
    # Upwards, and a little against: 1 m ahead of it and on its line, 0.1 m from the top.
    up = (-3.0, -1.0), (0.0, 1.0), (0.6, 0.8), -5.0
    assert cost((-2.4, -0.2), up) == pytest.approx(5.0 / 6.0)


def test_who_is_at_its_target_has_no_line():
    assert cost((-1.0, 0.0), ((-3.0, 0.0), STILL, STILL, 5.0)) == 0.0


def test_neighbours_add_up_and_those_of_others_do_not_count():
    alone = Chooser([Ending((0.6, 0.2))], target=GOAL)
    beset = Chooser(
        [Ending((0.6, 0.2))] * 2,
        target=GOAL,
        neighbours=[oncoming(-3.0, 0.0), same_way(1.0, 0.0, 1.0)],
    )
    costs = RightOfWay(**ROUND).cost(candidates(alone, beset, alone))
    assert costs == pytest.approx([0.0, 0.8, 0.8, 0.0])


def test_default_numbers_are_used():
    term = RightOfWay()
    halfway = one_option(
        Ending((-1.0, (term.width - term.bias) / 2.0)),
        target=GOAL,
        neighbours=[oncoming(-3.0, 0.0)],
    )
    assert term.cost(halfway) == pytest.approx([0.5])


@pytest.mark.parametrize(
    "wrong",
    [
        {"width": math.nan},
        {"width": math.inf},
        {"bias": math.nan},
        {"ahead": math.nan},
        {"ahead": math.inf},
        {"width": 0.0, "bias": 0.0},
        {"width": -0.4},
        {"width": 0.2, "bias": 0.2},
        {"width": 0.2, "bias": -0.3},
        {"ahead": -0.1},
    ],
)
def test_numbers_out_of_range_are_refused_in_one_line(wrong):
    with pytest.raises(ModelError, match=r"^right_of_way: .*expected") as caught:
        RightOfWay(**wrong)
    assert "\n" not in str(caught.value)


def seen_from(options):
    """Rows of options and of neighbours; ahead and aside of these, and below 0 those who come.

    That is the cosine of the angle between the two ways above that of 120 degrees.
    """
    rows, others = options.pairs()
    e = options.neighbour_directions[others]
    gap = options.points[rows] - options.neighbour_positions[others]
    aim = (options.targets - options.positions)[options.owner[rows]]
    along = (gap * e).sum(axis=1)
    aside = e[:, 0] * gap[:, 1] - e[:, 1] * gap[:, 0]
    return rows, others, along, aside, (aim * e).sum(axis=1) + 0.5 * np.hypot(*aim.T)


def decided(options, ahead):
    """(n,) where rounding does not decide which neighbours count."""
    rows, _, along, _, with_it = seen_from(options)
    edges = np.minimum(np.abs(along), np.abs(along - ahead))
    edges = np.minimum(edges, np.abs(with_it))
    return np.bincount(rows[edges < EDGE], minlength=len(options)) == 0


@given(crowded)
@settings(deadline=None)
def test_sum_over_the_neighbours_of_any_batch(options):
    rows, others, along, aside, with_it = seen_from(options)
    comes = with_it < 0.0
    first = (options.leads[others] > 0.0) & (along < 0.5)
    # Straight from the top to both ends: 0.6 m from 0.1 m on the wrong side, or 0.5 m and half.
    height = np.where(comes, 1.0 - np.abs(aside + 0.1) / 0.6, 0.5 - np.abs(aside) / 1.0)
    each = np.where((along > 0.0) & (comes | first), np.maximum(height, 0.0), 0.0)
    expected = np.bincount(rows, weights=each, minlength=len(options))
    sure = decided(options, 0.5)
    costs = RightOfWay(**ROUND).cost(options)
    np.testing.assert_allclose(costs[sure], expected[sure], rtol=1e-9, atol=1e-9)


@given(crowded)
@settings(deadline=None)
def test_a_cost_lies_between_none_and_one_a_neighbour(options):
    costs = RightOfWay().cost(options)
    assert np.isfinite(costs).all()
    assert (costs >= 0.0).all()
    assert (costs <= np.diff(options.neighbour_offsets)[options.owner]).all()


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_does_not_depend_on_where_north_is(options, angle, by):
    sure = decided(options, RightOfWay().ahead)
    moved = RightOfWay().cost(turned_and_moved(options, angle, by))
    np.testing.assert_allclose(moved[sure], RightOfWay().cost(options)[sure], atol=1e-9)


@given(crowded)
@settings(deadline=None)
def test_the_other_bias_is_the_same_in_a_mirror(options):
    keep_right = RightOfWay()
    keep_left = RightOfWay(width=keep_right.width, bias=-keep_right.bias, ahead=keep_right.ahead)
    np.testing.assert_allclose(
        keep_left.cost(mirrored(options)), keep_right.cost(options), atol=1e-12
    )


@pytest.mark.parametrize(("degrees", "counts"), [(119.0, False), (121.0, True), (180.0, True)])
def test_people_from_two_sides_of_a_door_do_not_come_towards_each_other(degrees, counts):
    # The neighbour walks to the right; one's own target lies at an angle to that.
    goal = (20.0 * math.cos(math.radians(degrees)), 20.0 * math.sin(math.radians(degrees)))
    assert (cost((-1.0, -0.1), oncoming(-3.0, 0.0), target=goal) > 0.5) == counts
