import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import Displacement, PreferredSpeed

from tests.fixtures.options import Ending, batches, one_option


def test_displacement_lowers_the_cost_by_its_metres():
    assert Displacement().cost(one_option(Ending(displacement=1.25))).tolist() == [-1.25]


@pytest.mark.parametrize(
    ("displacement", "duration", "preferred", "cost"),
    [
        (1.5, 1.5, 1.2, 0.3),  # |1.5 - 1.8| x 1.5 / 1.5
        (0.6, 0.4, 1.2, 0.45),  # |0.6 - 0.48| x 1.5 / 0.4
        (0.0, 0.4, 1.2, 1.8),  # |0 - 0.48| x 1.5 / 0.4: a standing person misses all of it
        (1.0, 0.8, 1.25, 0.0),
        (0.8, 0.8, 1.4, 0.6),  # |0.8 - 1.12| x 1.5 / 0.8
    ],
)
def test_preferred_speed(displacement, duration, preferred, cost):
    ending = Ending(displacement=displacement, duration=duration)
    options = one_option(ending, preferred_speed=preferred)
    assert PreferredSpeed().cost(options) == pytest.approx([cost])


def test_the_same_speed_costs_the_same_whatever_the_duration():
    costs = [
        PreferredSpeed().cost(one_option(Ending(displacement=0.9 * t, duration=t)))[0]
        for t in (0.4, 0.8, 1.5)
    ]
    assert costs == pytest.approx([0.15, 0.15, 0.15])


@given(batches)
@settings(deadline=None)
def test_displacement_of_any_batch(options):
    np.testing.assert_allclose(Displacement().cost(options), -options.displacements, rtol=1e-14)


@given(batches)
@settings(deadline=None)
def test_preferred_speed_of_any_batch(options):
    wanted = options.preferred_speeds[options.owner] * options.durations
    expected = np.abs(options.displacements - wanted) * 1.5 / options.durations
    np.testing.assert_allclose(PreferredSpeed().cost(options), expected, atol=1e-12)
