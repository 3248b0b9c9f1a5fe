"""Walking speed by age against the table that it comes from."""

import numpy as np
import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.populations import walking_speed

# Rows of the curve (Weidmann 1993, RiMEA test 7): years, mean and deviation in m/s.
CURVE = [(3, 0.60, 0.12), (20, 1.61, 0.31), (50, 1.41, 0.27), (80, 0.69, 0.13)]


@pytest.mark.parametrize(("age", "mean", "sd"), [*CURVE, (35 / 2, 1.535, 0.295)])
def test_mean_and_deviation_by_age(age, mean, sd):
    speeds = walking_speed(np.full(4000, age), np.random.default_rng(1))
    # Cut at three deviations, a normal curve's deviation is 1.3 % less.
    assert speeds.mean() == pytest.approx(mean, abs=0.015)
    assert speeds.std() == pytest.approx(sd, rel=0.04)
    assert np.abs(speeds - mean).max() <= 3 * sd


def test_each_has_the_speed_of_its_own_age():
    ages = np.repeat([5.0, 25.0], 500)
    speeds = walking_speed(ages, np.random.default_rng(2))
    assert speeds[:500].mean() == pytest.approx(0.78, abs=0.03)
    assert speeds[500:].mean() == pytest.approx(1.58, abs=0.05)


def test_nobody_is_drawn_faster_than_bodies_are():
    speeds = walking_speed(np.full(4000, 20.0), np.random.default_rng(3), fastest=1.85)
    # 1.61 and 0.31 m/s, cut 0.774 deviations above the mean and 3 below: that takes the mean down
    # by (0.2957 - 0.0044) / (0.7806 - 0.0013) deviations.
    assert speeds.max() <= 1.85
    assert speeds.mean() == pytest.approx(1.61 - 0.31 * 0.3738, abs=0.015)
    with pytest.raises(ModelError, match="fastest"):
        walking_speed([20.0], np.random.default_rng(0), fastest=1.6)


@pytest.mark.parametrize("ages", [[2.0], [81.0], [np.nan], 30.0])
def test_ages_that_the_curve_does_not_have(ages):
    with pytest.raises(ModelError, match="3 to 80"):
        walking_speed(ages, np.random.default_rng(0))
