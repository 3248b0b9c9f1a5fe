"""Types derived by scaling: their speeds, bodies and what their maps say of themselves."""

from functools import cache

import numpy as np
import pytest

from mesa_mobility.capture import find_clips, load_clips, scale
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import derived_type, pose_table

# Free speeds and body sizes as published: m/s, metres.
SPEEDS = {
    "child": 1.13,  # 1.34 m/s at the Froude number of an adult, 1.25 m against 1.75 m tall
    "older_adult": 1.23,
    "frail_older_adult": 0.80,
    "cane": 0.81,
    "crutches": 0.94,
    "walking_frame": 0.57,
}


@pytest.mark.parametrize("name", SPEEDS)
def test_free_speeds_are_those_of_the_source(name):
    assert derived_type(name).speed.mean == pytest.approx(SPEEDS[name], abs=0.005)


def test_a_child_is_dynamically_similar_to_an_adult():
    child = derived_type("child")
    speed = child.length / child.time
    # Froude number: speed squared over g times leg length.
    assert speed**2 / child.length == pytest.approx(1.0)
    assert 2 * child.core_radius / 0.28 * 0.46 == pytest.approx(0.42, abs=0.03)


def test_an_older_adult_takes_the_steps_that_were_measured():
    """Per leg length 0.715 and 0.722, at 121 and 118 a minute, at 1.23 and 1.25 m/s."""
    older = derived_type("older_adult")
    assert older.length / older.time == pytest.approx(1.23 / 1.25)
    assert 1 / older.time == pytest.approx(121 / 118)


def test_an_unknown_type_is_refused():
    with pytest.raises(MapError, match="no derived type 'giant', expected one of child, older"):
        derived_type("giant")


@cache
def recorded(folder, pedestrian_type):
    """The recordings of a type, without mirror images."""
    clips = load_clips(find_clips(folder), pedestrian_type=pedestrian_type, mirrored=False)
    return clips.recordings


@pytest.mark.thorough
@pytest.mark.captures
@pytest.mark.parametrize("name", ["frail_older_adult", "cane", "crutches", "walking_frame"])
def test_steady_walks_have_the_speed_of_the_source(captures_dir, name):
    kind = derived_type(name)
    recordings = recorded(captures_dir, kind.source)
    factor = kind.time_factor(recordings)
    scaled, metadata = kind.derive(recordings, factor)
    poses = pose_table(scaled)
    steady = np.percentile(poses.speed[~poses.is_standing()], 75)
    # People who stand in the recordings may creep in quicker ones.
    assert steady == pytest.approx(SPEEDS[name], rel=0.05)
    assert metadata["derived"]["from"] == kind.source


@pytest.mark.captures
def test_lengths_and_times_are_scaled(captures_dir):
    clip = recorded(captures_dir, "slow")[0]
    small = scale(clip, 0.5, 0.8)
    assert small.frame_rate == clip.frame_rate
    assert small.duration == pytest.approx(0.8 * clip.duration, abs=1 / 30)
    np.testing.assert_allclose(small.positions()[0], 0.5 * clip.positions()[0], atol=1e-9)
    np.testing.assert_allclose(small.root_position[4], 0.5 * clip.root_position[5], atol=1e-9)
