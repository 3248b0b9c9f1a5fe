import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import lateral_sway


def walker(
    seconds=20.0,
    amplitude=0.03,
    stride=0.9,
    direction=0.0,
    drift=0.0,
    speed=1.3,
    wander=0.0,
    rate=30.0,
):
    """Sways like a sine of the given amplitude; drifts off like a parabola, wanders at 0.2 Hz."""
    t = np.arange(round(seconds * rate)) / rate
    along = speed * t
    across = amplitude * np.sin(2 * math.pi * stride * t) + drift * (t / seconds) ** 2
    across += wander * np.sin(2 * math.pi * 0.2 * t)
    c, s = math.cos(direction), math.sin(direction)
    return c * along - s * across, s * along + c * across


@given(
    amplitude=st.floats(0.015, 0.06),
    stride=st.floats(0.7, 1.2),
    direction=st.floats(-math.pi, math.pi),
    drift=st.floats(-0.5, 0.5),
)
@settings(max_examples=40, deadline=None)
def test_a_sine_sways_twice_its_amplitude(amplitude, stride, direction, drift):
    x, y = walker(amplitude=amplitude, stride=stride, direction=direction, drift=drift)
    sway = lateral_sway(x, y)
    assert sway.peak_to_peak == pytest.approx(2 * amplitude, rel=0.06)
    assert sway.stride_frequency == pytest.approx(stride, abs=0.02)


def test_a_slow_walker_has_slow_strides():
    assert lateral_sway(*walker(speed=0.5, stride=0.5)).stride_frequency == pytest.approx(
        0.5, abs=0.02
    )


def test_wandering_ten_times_as_wide_is_not_taken_for_the_stride():
    sway = lateral_sway(*walker(amplitude=0.03, wander=0.3, seconds=40.0))
    assert sway.stride_frequency == pytest.approx(0.9, abs=0.02)


def test_wandering_is_not_sway():
    # Of 5 cm of wandering at 0.2 Hz, the running mean over 1.1 s leaves 4 mm.
    sway = lateral_sway(*walker(amplitude=0.03, wander=0.05, seconds=40.0))
    assert sway.peak_to_peak == pytest.approx(0.06, rel=0.1)


def test_each_gait_cycle_has_its_own_figure():
    # 20 s at 0.9 Hz are 18 cycles; the first and the last half are lost to the running mean.
    assert len(lateral_sway(*walker()).per_cycle) in (16, 17)


def test_somebody_who_goes_dead_straight_does_not_sway():
    x, y = walker(amplitude=0.0)
    assert lateral_sway(x, y).peak_to_peak == pytest.approx(0.0, abs=1e-9)


def test_too_short_a_walk_is_refused():
    with pytest.raises(ResultsError, match=r"needs 9\.5 s of walking, got 5\.0 s"):
        lateral_sway(*walker(seconds=5.0))


def test_standing_is_no_walk():
    with pytest.raises(ResultsError, match="less than 1 m covered"):
        lateral_sway(np.zeros(600), np.zeros(600))
