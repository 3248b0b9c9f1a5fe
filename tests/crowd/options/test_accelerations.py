"""Options that begin or end abruptly are left out."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.crowd import PRESETS
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.mobility.standing.accelerations import GENTLE, peak_accelerations
from tests.fixtures.maps import STANDING, make_map, shipped_map, stand, straight, through


def peaks_of(map_):
    return peak_accelerations(map_.durations, map_.path_offsets, map_.paths)


def walk(metres, frames):
    return straight(metres, frames, to=STANDING)


def uniform(rate, frames, start=0.0):
    """An option with a constant acceleration, m/s2."""
    times = np.arange(3, frames + 1, 3) / 30.0
    return through(
        [(start * t + 0.5 * rate * t * t, 0.0, 0.0) for t in times.tolist()], to=STANDING
    )


def test_none_at_constant_velocity():
    peaks = peaks_of(make_map([[stand(), walk(1.0, 24), walk(2.0, 45)]]))
    np.testing.assert_allclose(peaks, 0.0, atol=1e-4)


@given(rate=st.floats(0.1, 3.0), start=st.floats(0.0, 1.0))
@settings(deadline=None, max_examples=20)
def test_uniform_acceleration_is_found_in_the_middle_of_a_long_option(rate, start):
    # Smoothing takes from either end, 0.75 s are two and a half standard deviations.
    peaks = peaks_of(make_map([[stand(), uniform(rate, 45, start)]]))
    assert peaks[1] == pytest.approx(rate, rel=0.05)


def test_abrupt_options_are_left_out_and_shorter_copies_of_them_kept():
    map_ = make_map([[stand(), walk(0.5, 24), uniform(2.0, 45), uniform(0.5, 45)]])
    whole = Capability(map_, (12, 24, 45))
    gentle = Capability(map_, (12, 24, 45), most_acceleration=0.95)
    assert len(whole.table.options) == 4
    assert sorted(gentle.table.options.x.tolist()) == pytest.approx([0.0, 0.5, 0.5625])
    # A quarter of an acceleration of 2 m/s2 is one of 0.5.
    halves = Capability(map_, (12, 24, 45), ((), (), (0.25,)), most_acceleration=0.95)
    ends = halves.table.options.x.tolist()
    assert pytest.approx(min(e for e in ends if e > 0.5)) == 0.25 * 2.25
    assert max(ends) == pytest.approx(0.5625)


def test_a_cluster_that_has_no_other_keeps_what_it_has():
    map_ = make_map([[uniform(3.0, 45)]])
    assert len(Capability(map_, (45,), most_acceleration=0.95).table.options) == 1


def test_most_options_of_the_map_that_ships_stay():
    whole, gentle = (
        Capability(shipped_map(), (12, 24, 45), most_acceleration=most) for most in (None, 0.95)
    )
    share = len(gentle.table.options) / len(whole.table.options)
    assert 0.55 < share < 0.95
    assert np.diff(gentle.table.offsets).min() >= 1


def test_a_map_is_built_for_what_the_default_preset_leaves_of_it():
    assert PRESETS["default"].most_acceleration == GENTLE
