"""Poses of a walker whose motion is known in closed form."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mesa_mobility.capture import Recording, Skeleton
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import pose_table

NAMES = (
    "Hips",
    "LeftUpLeg",
    "LeftLeg",
    "LeftFoot",
    "LeftToeBase",
    "RightUpLeg",
    "RightLeg",
    "RightFoot",
    "RightToeBase",
)
PARENTS = np.array([-1, 0, 1, 2, 3, 0, 5, 6, 7])
# File axes: y up, x to the left, z forwards.
OFFSETS = np.array(
    [
        [0, 0, 0],
        [0.1, 0, 0],
        [0, -0.4, 0],
        [0, -0.4, 0],
        [0, 0, 0.15],
        [-0.1, 0, 0],
        [0, -0.4, 0],
        [0, -0.4, 0],
        [0, 0, 0.15],
    ]
)
UP = Rotation.from_matrix([[0, 0, 1], [1, 0, 0], [0, 1, 0]])  # file (x, y, z) -> world (z, x, y)


def walker(x, y, heading, swing):
    """A walker with hips at (x, y), facing ``heading``, thighs swung by +-``swing``."""
    frames = len(x)
    rotations = np.zeros((frames, 9, 4))
    rotations[..., 3] = 1.0
    rotations[:, 0] = (Rotation.from_euler("z", np.asarray(heading)[:, None]) * UP).as_quat()
    rotations[:, 1] = Rotation.from_euler("x", np.asarray(swing)[:, None]).as_quat()
    rotations[:, 5] = Rotation.from_euler("x", -np.asarray(swing)[:, None]).as_quat()
    return Recording(
        name="walk",
        skeleton=Skeleton(NAMES, PARENTS, OFFSETS),
        frame_rate=30.0,
        root_position=np.column_stack([x, y, np.full(frames, 0.9)]),
        rotations=rotations,
    )


def straight(frames=60, speed=1.2, heading=0.0, origin=(0.0, 0.0)):
    s = np.arange(frames) / 30 * speed
    swing = 0.4 * np.sin(2 * np.pi * np.arange(frames) / 30)
    return walker(
        origin[0] + s * np.cos(heading),
        origin[1] + s * np.sin(heading),
        np.full(frames, heading),
        swing,
    )


def test_a_straight_walk_steps_four_centimetres_a_frame():
    poses = pose_table([straight()])
    np.testing.assert_allclose(poses.step[:-1], np.tile([0.04, 0, 0], (59, 1)), atol=1e-9)
    np.testing.assert_array_equal(poses.step[-1], 0.0)
    np.testing.assert_allclose(poses.speed[10:-10], 1.2, atol=1e-6)
    assert not poses.is_standing().any()


def test_joints_are_seen_from_the_pelvis_and_the_floor():
    joints = pose_table([straight(heading=2.0, origin=(5, -3))]).joints
    np.testing.assert_allclose(joints[0, 0], [0, 0, 0.9], atol=1e-6)
    np.testing.assert_allclose(joints[0, 1], [0, 0.1, 0.9], atol=1e-6)  # left hip to the left
    np.testing.assert_allclose(joints[0, 4], [0.15, 0.1, 0.1], atol=1e-6)  # toe in front
    np.testing.assert_allclose(joints[0, 5], [0, -0.1, 0.9], atol=1e-6)


def test_a_walk_on_a_circle_turns_by_its_rate():
    t = np.arange(120) / 30
    rate, radius = 0.5, 2.4
    record = walker(
        radius * np.sin(rate * t), -radius * np.cos(rate * t), rate * t, 0.3 * np.sin(6 * t)
    )
    poses = pose_table([record])
    inner = slice(40, -41)
    # Motion is rounded to 0.02 mm and 0.02 mrad.
    np.testing.assert_allclose(poses.step[inner, 2], rate / 30, atol=1.1e-5)
    length = np.hypot(*poses.step[inner, :2].T)
    np.testing.assert_allclose(length, 2 * radius * np.sin(rate / 60), atol=1.5e-5)
    np.testing.assert_allclose(poses.turn_rate[inner], rate, atol=1e-5)


def test_the_swing_of_the_hips_is_not_a_change_of_facing():
    t = np.arange(240) / 30
    swing = np.deg2rad(6) * np.sin(2 * np.pi * t)  # one gait cycle a second
    poses = pose_table([walker(1.2 * t, 0 * t, swing, 0.4 * np.sin(2 * np.pi * t))])
    assert np.ptp(poses.facing[30:-30]) < np.deg2rad(3)
    # The path itself keeps its straight line, seen in the facing frame.
    np.testing.assert_allclose(poses.position[:, 1], 0.0, atol=1e-12)


def test_somebody_who_shifts_a_millimetre_stands():
    t = np.arange(60) / 30
    poses = pose_table([walker(0.001 * np.sin(t), 0 * t, 0 * t, 0 * t)])
    assert poses.is_standing().all()


@settings(max_examples=15, deadline=None)
@given(
    heading=st.floats(-6, 6),
    x=st.floats(-50, 50),
    y=st.floats(-50, 50),
)
def test_place_and_direction_of_the_recording_do_not_matter(heading, x, y):
    here, there = pose_table([straight()]), pose_table([straight(heading=heading, origin=(x, y))])
    np.testing.assert_allclose(there.features, here.features, atol=1e-5)
    np.testing.assert_allclose(there.step, here.step, atol=1e-9)


def test_features_are_unit_directions_and_three_times_their_change():
    poses = pose_table([straight()])
    directions = poses.features[:, :18].reshape(-1, 6, 3)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=-1), 1.0, atol=1e-6)
    # Left thigh: swung by a, it points (-sin a, 0, -cos a) or its mirror image, forwards or back.
    swing = 0.4 * np.sin(2 * np.pi * np.arange(60) / 30)
    np.testing.assert_allclose(np.abs(directions[:, 0, 0]), np.abs(np.sin(swing)), atol=1e-6)
    np.testing.assert_allclose(directions[:, 0, 2], -np.cos(swing), atol=1e-6)
    change = (directions[2:] - directions[:-2]) / 2
    np.testing.assert_allclose(poses.features[1:-1, 18:], 3.0 * change.reshape(-1, 18), atol=1e-5)


def test_another_frame_rate_and_no_recordings_are_refused():
    record = straight()
    slow = Recording("slow", record.skeleton, 60.0, record.root_position, record.rotations)
    with pytest.raises(MapError, match="slow: frame rate 60, expected 30 Hz"):
        pose_table([slow])
    with pytest.raises(MapError, match="no recordings"):
        pose_table([])
