import math

import numpy as np
import pytest
from hypothesis import given, settings
from mesa_mobility.behaviors import FacingDeviation, TargetDistance

from tests.fixtures.options import Chooser, Ending, batches, candidates, one_option


def test_distance_is_that_of_the_mobility_point_to_the_target():
    options = one_option(Ending(point=(1.0, 2.0)), target=(4.0, 6.0))
    assert TargetDistance().cost(options) == pytest.approx([5.0])


def test_distance_is_taken_to_the_target_of_each_options_owner():
    first = Chooser([Ending(point=(0.0, 0.0)), Ending(point=(3.0, 0.0))], target=(3.0, 4.0))
    second = Chooser([Ending(point=(3.0, 0.0))], target=(-5.0, 15.0))
    assert TargetDistance().cost(candidates(first, second)) == pytest.approx([5.0, 4.0, 17.0])


@pytest.mark.parametrize(
    ("heading", "target", "angle"),
    [
        (0.0, (4.0, 6.0), 0.9272952180016122),  # 3 along, 4 up: atan(4 / 3)
        (math.pi / 2, (4.0, 6.0), 0.6435011087932844),  # atan(3 / 4)
        (0.0, (-9.0, 2.0), math.pi),  # straight behind
        (math.pi, (-9.0, 2.0), 0.0),
        (0.0, (1.0, -5.0), math.pi / 2),  # to the right counts as much as to the left
        (7 * math.pi / 4, (2.0, 3.0), math.pi / 2),  # 315 degrees against 45: 90, not 270
        (-9 * math.pi / 4, (1.0, 3.0), 3 * math.pi / 4),  # -405 degrees are -45
    ],
)
def test_deviation_is_the_angle_between_facing_and_target_at_the_mobility_point(
    heading, target, angle
):
    options = one_option(Ending(point=(1.0, 2.0), heading=heading), target=target)
    assert FacingDeviation().cost(options) == pytest.approx([angle])


def test_at_the_target_itself_no_facing_deviates():
    options = one_option(Ending(point=(1.0, 2.0), heading=2.5), target=(1.0, 2.0))
    assert FacingDeviation().cost(options).tolist() == [0.0]


@given(batches)
@settings(deadline=None)
def test_distance_of_any_batch(options):
    gap = options.points - options.targets[options.owner]
    np.testing.assert_allclose(
        TargetDistance().cost(options), np.linalg.norm(gap, axis=1), rtol=1e-12, atol=1e-12
    )


@given(batches)
@settings(deadline=None)
def test_deviation_of_any_batch(options):
    aim = options.targets[options.owner] - options.points
    facing = np.column_stack([np.cos(options.headings), np.sin(options.headings)])
    across = facing[:, 0] * aim[:, 1] - facing[:, 1] * aim[:, 0]
    expected = np.abs(np.arctan2(across, (facing * aim).sum(axis=1)))
    expected[(aim == 0.0).all(axis=1)] = 0.0
    np.testing.assert_allclose(FacingDeviation().cost(options), expected, atol=1e-9)


@given(batches)
@settings(deadline=None)
def test_deviation_lies_between_none_and_a_half_turn(options):
    cost = FacingDeviation().cost(options)
    assert ((cost >= 0.0) & (cost <= math.pi)).all()
