import math

import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import Interference

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Chooser, Ending, batches, candidates, one_option

STILL = (0.0, 0.0)
A_METRE_A_SECOND = Ending(displacement=1.5, duration=1.5)
ONE_E_FOLD = 3.8627341323  # 10.5 / e
TWO_E_FOLDS = 1.4210204740  # 10.5 / e^2


def cost(ending: Ending, *neighbours) -> float:
    return float(Interference().cost(one_option(ending, neighbours=neighbours))[0])


def test_constants_are_the_papers():
    assert (Interference().a, Interference().b) == (10.5, 0.09)


def test_a_neighbour_at_the_mobility_point_costs_a():
    assert cost(A_METRE_A_SECOND, ((0.0, 0.0), STILL)) == pytest.approx(10.5)


def test_falls_by_e_each_nine_centimetres_at_a_metre_a_second():
    assert cost(A_METRE_A_SECOND, ((0.09, 0.0), STILL)) == pytest.approx(ONE_E_FOLD)
    assert cost(A_METRE_A_SECOND, ((0.18, 0.0), STILL)) == pytest.approx(TWO_E_FOLDS)


def test_who_moves_slower_accepts_to_be_closer():
    half_a_metre_a_second = Ending(displacement=0.4, duration=0.8)
    assert cost(half_a_metre_a_second, ((0.09, 0.0), STILL)) == pytest.approx(TWO_E_FOLDS)
    two_metres_a_second = Ending(displacement=0.8, duration=0.4)
    assert cost(two_metres_a_second, ((0.18, 0.0), STILL)) == pytest.approx(ONE_E_FOLD)


def test_distance_is_that_to_where_the_neighbour_will_be():
    # 1.5 s at (0.8, -0.4) m/s from (-1.2 + 0.18, 0.6): 0.18 m ahead of the mobility point.
    neighbour = ((-1.02, 0.6), (0.8, -0.4))
    assert cost(A_METRE_A_SECOND, neighbour) == pytest.approx(TWO_E_FOLDS)


def test_neighbours_add_up():
    both = cost(A_METRE_A_SECOND, ((0.09, 0.0), STILL), ((0.0, 0.18), STILL))
    assert both == pytest.approx(ONE_E_FOLD + TWO_E_FOLDS)


def test_neighbours_of_others_do_not_count():
    alone = Chooser([A_METRE_A_SECOND])
    beset = Chooser([A_METRE_A_SECOND] * 2, neighbours=[((0.09, 0.0), STILL)])
    costs = Interference().cost(candidates(alone, beset, alone))
    assert costs == pytest.approx([0.0, ONE_E_FOLD, ONE_E_FOLD, 0.0])


@pytest.mark.parametrize(
    ("heading", "counts"),
    [
        (0.0, True),
        (math.radians(89), True),
        (math.radians(91), False),
        (math.pi, False),
        (math.radians(269), False),
        (math.radians(271), True),
    ],
)
def test_who_is_behind_the_facing_at_the_mobility_point_does_not_count(heading, counts):
    ending = Ending(heading=heading, displacement=1.5, duration=1.5)
    expected = ONE_E_FOLD if counts else 0.0
    assert cost(ending, ((0.09, 0.0), STILL)) == pytest.approx(expected)


def test_behind_is_judged_by_where_the_neighbour_will_be():
    # Now 1 m ahead, but coming at 2 m/s: 2 m behind after 1.5 s.
    assert cost(A_METRE_A_SECOND, ((1.0, 0.0), (-2.0, 0.0))) == 0.0
    # Now 0.5 m behind, but 0.09 m ahead by then.
    coming = ((-0.51, 0.0), (0.4, 0.0))
    assert cost(A_METRE_A_SECOND, coming) == pytest.approx(ONE_E_FOLD)


@pytest.mark.parametrize("displacement", [0.0, 1e-12, 1e-300])
def test_tends_to_nothing_as_the_speed_does(displacement):
    ending = Ending(displacement=displacement, duration=0.4)
    assert cost(ending, ((0.01, 0.0), STILL), ((0.3, 0.0), STILL)) == 0.0


def test_standing_on_the_spot_costs_nothing_even_at_contact():
    assert cost(Ending(displacement=0.0, duration=0.4), ((0.0, 0.0), STILL)) == 0.0


def test_other_constants():
    options = one_option(A_METRE_A_SECOND, neighbours=[((0.5, 0.0), STILL)])
    assert Interference(a=2.0, b=0.25).cost(options) == pytest.approx([2.0 / math.e**2])


@pytest.mark.parametrize(
    "constants", [{"a": -1.0}, {"a": math.nan}, {"b": 0.0}, {"b": -0.09}, {"b": math.nan}]
)
def test_constants_out_of_range_are_refused(constants):
    # A negative cost would break the lower bound that the choice relies on; b divides.
    with pytest.raises(ModelError):
        Interference(**constants)


@given(batches)
@settings(deadline=None)
def test_sum_over_the_neighbours_of_any_batch(options):
    least, most = np.zeros(len(options)), np.zeros(len(options))
    for row, owner in enumerate(options.owner):
        point, heading = options.points[row], options.headings[row]
        first, last = options.neighbour_offsets[owner : owner + 2]
        for k in range(first, last):
            gap = options.neighbour_positions[k] - point
            gap = gap + options.neighbour_velocities[k] * options.durations[row]
            ahead = gap[0] * math.cos(heading) + gap[1] * math.sin(heading)
            if options.speeds[row] > 0.0 and ahead > -1e-9:
                cost = 10.5 * math.exp(-math.hypot(*gap) / (0.09 * options.speeds[row]))
                most[row] += cost
                # Exactly beside, rounding decides.
                least[row] += cost if ahead > 1e-9 else 0.0
    cost = Interference().cost(options)
    assert (cost >= least * (1 - 1e-9) - 1e-12).all()
    assert (cost <= most * (1 + 1e-9) + 1e-12).all()
