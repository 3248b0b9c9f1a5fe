import math

import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import Headway

from mesa_mobility.errors import ModelError
from tests.fixtures.options import (
    Chooser,
    Ending,
    candidates,
    crowded,
    one_option,
    shifts,
    turned_and_moved,
    turns,
)

STILL = (0.0, 0.0)
A_METRE_A_SECOND = Ending(displacement=1.5, duration=1.5)
STANDING = Ending(displacement=0.0, duration=0.4)
EDGE = 1e-7

# Figures below are for these: half a metre apart when standing, one second, 0.4 m wide.  An excess
# of 0.2 m/s or more counts 0.1 less than it is.
ROUND = {"distance": 0.5, "time": 1.0, "width": 0.4, "softness": 0.2}


def cost(ending: Ending, *neighbours, **numbers) -> float:
    term = Headway(**(numbers or ROUND))
    return float(term.cost(one_option(ending, target=(20.0, 0.0), neighbours=neighbours))[0])


@pytest.mark.parametrize(
    ("ending", "place", "expected"),
    [
        # Room for v = d - 0.5: at 1.5 m for 1 m/s, at 1 m for half of it, at 0.5 m for nothing.
        (A_METRE_A_SECOND, (1.5, 0.0), 0.0),
        (A_METRE_A_SECOND, (1.75, 0.0), 0.0),
        (A_METRE_A_SECOND, (1.0, 0.0), 0.6),
        # A tenth too fast: 0.1^2 / 0.4.
        (A_METRE_A_SECOND, (1.4, 0.0), 0.0375),
        (A_METRE_A_SECOND, (1.3, 0.0), 0.15),
        (A_METRE_A_SECOND, (0.5, 0.0), 1.35),
        (A_METRE_A_SECOND, (0.25, 0.0), 1.725),
        # A metre over 1.5 s costs what it costs over 0.4 s.
        (Ending(displacement=0.4, duration=0.4), (1.0, 0.0), 0.6),
        # A standing person has room from half a metre on, but not nearer.
        (STANDING, (0.5, 0.0), 0.0),
        (STANDING, (0.25, 0.0), 0.225),
        # Beside: half a width off counts half; a width off, nothing. Either side.
        (A_METRE_A_SECOND, (1.0, 0.2), 0.3),
        (A_METRE_A_SECOND, (1.0, -0.2), 0.3),
        (A_METRE_A_SECOND, (1.0, 0.4), 0.0),
        (A_METRE_A_SECOND, (1.0, 1.0), 0.0),
        # Behind.
        (A_METRE_A_SECOND, (-0.1, 0.0), 0.0),
    ],
)
def test_numbers_worked_out_by_hand(ending, place, expected):
    assert cost(ending, (place, STILL)) == pytest.approx(expected, abs=1e-12)


def test_ahead_is_where_one_faces_at_the_mobility_point():
    facing_up = Ending((2.0, 1.0), heading=math.pi / 2, displacement=1.5, duration=1.5)
    assert cost(facing_up, ((2.0, 2.0), STILL)) == pytest.approx(0.6)
    assert cost(facing_up, ((3.0, 1.0), STILL)) == pytest.approx(0.0, abs=1e-12)
    assert cost(facing_up, ((2.0, 0.0), STILL)) == 0.0


def test_people_who_stand_make_no_room_by_looking_elsewhere():
    # Its target is to the right: it lacks 0.25 m there whichever way it faces, and nothing behind.
    for heading in (0.0, 1.0, -2.0, math.pi):
        standing = Ending(heading=heading, displacement=0.0, duration=0.4)
        term = Headway(**ROUND)
        for place, expected in (((0.25, 0.0), 0.225), ((-0.25, 0.0), 0.0)):
            options = one_option(standing, target=(5.0, 0.0), neighbours=[(place, STILL)])
            assert term.cost(options) == pytest.approx([expected])
        nowhere = one_option(standing, target=(0.0, 0.0), neighbours=[((0.25, 0.0), STILL)])
        assert term.cost(nowhere) == pytest.approx([0.0])
    # Two centimetres are a step.
    step = Ending((0.02, 0.0), heading=math.pi, displacement=0.02, duration=0.4)
    assert Headway(**ROUND).cost(
        one_option(step, target=(5.0, 0.0), neighbours=[((0.25, 0.0), STILL)])
    ) == pytest.approx([0.0])


def test_ahead_is_where_the_neighbour_will_be():
    # 1.5 s at 0.6 m/s: from 0.1 m ahead to 1 m; and from 2.5 m back to that.
    assert cost(A_METRE_A_SECOND, ((0.1, 0.0), (0.6, 0.0))) == pytest.approx(0.6)
    assert cost(A_METRE_A_SECOND, ((2.5, 0.0), (-1.0, 0.0))) == pytest.approx(0.6)
    # Ahead now, but behind by then.
    assert cost(A_METRE_A_SECOND, ((1.0, 0.0), (-1.0, 0.0))) == 0.0


@pytest.mark.parametrize("beyond", [0.0, 0.5, 1.0])
def test_people_beyond_the_target_count_by_their_factor(beyond):
    term = Headway(**ROUND, beyond=beyond)
    for x, expected in ((1.1, 0.6), (0.9, 0.6 * beyond)):
        options = one_option(A_METRE_A_SECOND, target=(x, 0.0), neighbours=[((1.0, 0.0), STILL)])
        assert term.cost(options) == pytest.approx([expected])


def test_neighbours_add_up_and_those_of_others_do_not_count():
    two = [((1.0, 0.0), STILL), ((1.0, 0.2), STILL)]
    alone = Chooser([A_METRE_A_SECOND])
    beset = Chooser([A_METRE_A_SECOND] * 2, neighbours=two)
    costs = Headway(**ROUND).cost(candidates(alone, beset, alone))
    assert costs == pytest.approx([0.0, 0.9, 0.9, 0.0])


def test_default_numbers_are_used():
    # At two thirds of the standing distance a person who stands lacks a third of it.
    term = Headway()
    excess = (term.distance / 3.0) / term.time
    assert excess < term.softness
    expected = 1.5 * excess**2 / (2.0 * term.softness)
    neighbour = ((2.0 * term.distance / 3.0, 0.0), STILL)
    options = one_option(STANDING, target=(20.0, 0.0), neighbours=[neighbour])
    assert term.cost(options) == pytest.approx([expected])


@pytest.mark.parametrize("name", ["distance", "time", "width", "softness"])
@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, math.inf])
def test_numbers_out_of_range_are_refused_in_one_line(name, value):
    with pytest.raises(
        ModelError, match=rf"^headway: {name} .*expected more than 0 m?/?s?$"
    ) as caught:
        Headway(**{name: value})
    assert "\n" not in str(caught.value)


def pairs(options):
    """Rows of options and of neighbours, and how far ahead and aside these will be."""
    rows, others = options.pairs()
    gap = options.predicted(rows, others) - options.points[rows]
    # Below a centimetre the direction counts that leads to the target.
    aim = (options.targets - options.positions)[options.owner[rows]]
    stands = options.speeds[rows] * options.durations[rows] <= 0.01
    way = np.where(stands, np.arctan2(aim[:, 1], aim[:, 0]), options.headings[rows])
    none = stands & (aim == 0.0).all(axis=1)
    c, s = np.where(none, 0.0, np.cos(way)), np.where(none, 0.0, np.sin(way))
    return rows, gap[:, 0] * c + gap[:, 1] * s, gap[:, 1] * c - gap[:, 0] * s


def decided(options):
    """(n,) where rounding does not decide which neighbours are ahead, or which stand."""
    rows, ahead, _ = pairs(options)
    beside = np.bincount(rows[np.abs(ahead) < EDGE], minlength=len(options)) > 0
    aim = np.hypot(*(options.targets - options.positions)[options.owner].T)
    stands = options.speeds * options.durations
    return ~beside & (np.abs(stands - 0.01) > EDGE) & ((stands > 0.01) | (aim > EDGE))


@given(crowded)
@settings(deadline=None)
def test_sum_over_the_neighbours_of_any_batch(options):
    rows, ahead, aside = pairs(options)
    allowed = (ahead - ROUND["distance"]) / ROUND["time"]
    excess = np.maximum(options.speeds[rows] - allowed, 0.0)
    share = np.maximum(1.0 - np.abs(aside) / ROUND["width"], 0.0)
    counts = np.where(excess < 0.2, excess**2 / 0.4, excess - 0.1)
    each = np.where(ahead > 0.0, 1.5 * counts * share, 0.0)
    expected = np.bincount(rows, weights=each, minlength=len(options))
    sure = decided(options)
    costs = Headway(**ROUND).cost(options)
    np.testing.assert_allclose(costs[sure], expected[sure], rtol=1e-9, atol=1e-9)


@given(crowded)
@settings(deadline=None)
def test_costs_are_finite_and_never_negative(options):
    costs = Headway().cost(options)
    assert np.isfinite(costs).all()
    assert (costs >= 0.0).all()


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_does_not_depend_on_where_north_is(options, angle, by):
    sure = decided(options)
    moved = Headway().cost(turned_and_moved(options, angle, by))
    np.testing.assert_allclose(moved[sure], Headway().cost(options)[sure], atol=1e-9)


@pytest.mark.parametrize("pace", [0.25, 0.5, 1.0])
def test_slow_ground_lets_people_walk_that_much_slower_at_the_same_distance(pace):
    # Room for v = pace (d - 0.5) at a distance d, so that flows fall with the pace as speeds do.
    ending, term, costs = Ending(displacement=1.5 * pace, duration=1.5), Headway(**ROUND), []
    for ahead in (1.5, 1.4):
        around = [((ahead, 0.0), STILL)]
        option = one_option(ending, target=(20.0, 0.0), neighbours=around, pace=pace)
        costs.append(float(term.cost(option)[0]))
    # A tenth of a metre nearer the speed is pace / 10 too high, which counts by its square.
    assert costs == pytest.approx([0.0, 1.5 * (0.1 * pace) ** 2 / 0.4])


def test_on_stairs_people_keep_a_tread_and_a_half_more():
    ending, term, costs = Ending(displacement=1.5, duration=1.5), Headway(**ROUND), []
    for ahead, tread in ((1.5, 0.0), (1.95, 0.3), (1.8, 0.2), (1.55, 0.1)):
        around = [((ahead, 0.0), STILL)]
        option = one_option(ending, target=(20.0, 0.0), neighbours=around, tread=tread)
        costs.append(float(term.cost(option)[0]))
    # The last is a tenth of a metre too near: 0.1 m/s too fast, which counts by its square.
    assert costs == pytest.approx([0.0, 0.0, 0.0, 1.5 * 0.1**2 / 0.4])
