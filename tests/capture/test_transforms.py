import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from mesa_mobility.capture import Recording, Skeleton, mirror, resample, trim
from mesa_mobility.errors import CaptureError

NO_TURN = [0.0, 0.0, 0.0, 1.0]


def about_z(degrees):
    half = np.radians(degrees) / 2
    return [0.0, 0.0, np.sin(half), np.cos(half)]


def line(still, frames, frame_rate):
    """A root that moves 1 m along x and turns 10 degrees about z in each frame."""
    return still(
        ("root", "hand"),
        (-1, 0),
        ((0, 0, 0), (1, 0, 0)),
        rotations=[[about_z(10 * k), NO_TURN] for k in range(frames)],
        root_position=[[k, 0.0, 1.0] for k in range(frames)],
        frame_rate=frame_rate,
    )


def test_trim_keeps_the_frames_from_the_first_up_to_the_last(still):
    part = trim(line(still, 10, 30.0), 2, 5)
    assert part.root_position[:, 0].tolist() == [2.0, 3.0, 4.0]
    np.testing.assert_allclose(part.rotations[:, 0], [about_z(20), about_z(30), about_z(40)])


@pytest.mark.parametrize(("use_from", "use_to"), [(-1, 5), (5, 5), (6, 5), (0, 11)])
def test_trim_refuses_ranges_beyond_the_recording(still, use_from, use_to):
    with pytest.raises(CaptureError, match=f"still: frames {use_from}:{use_to}, .* within 0:10"):
        trim(line(still, 10, 30.0), use_from, use_to)


@pytest.mark.parametrize(
    ("frames", "kept"), [(9, [0, 4, 8]), (8, [0, 4]), (1, [0]), (10, [0, 4, 8])]
)
def test_whole_ratios_pick_frames_unchanged(still, frames, kept):
    recording = line(still, frames, 120.0)
    slow = resample(recording, 30.0)
    assert slow.frame_rate == 30.0
    np.testing.assert_array_equal(slow.root_position, recording.root_position[kept])
    np.testing.assert_array_equal(slow.rotations, recording.rotations[kept])


def test_the_same_rate_changes_nothing(still):
    recording = line(still, 7, 30.0)
    np.testing.assert_array_equal(resample(recording, 30.0).rotations, recording.rotations)


def test_other_ratios_interpolate_positions_and_turns_at_even_speed(still):
    # From 25 to 30 Hz: a new frame every 5/6 of an old one; 6 frames last 5 steps, 6 of the new.
    faster = resample(line(still, 6, 25.0), 30.0)
    at = np.array([0, 5, 10, 15, 20, 25, 30]) / 6
    np.testing.assert_allclose(faster.root_position[:, 0], at, atol=1e-12)
    np.testing.assert_allclose(faster.rotations[:, 0], [about_z(10 * t) for t in at], atol=1e-12)
    np.testing.assert_allclose(faster.rotations[:, 1], np.tile(NO_TURN, (7, 1)), atol=1e-12)


def test_resampling_never_goes_beyond_the_last_frame(still):
    # From 50 to 30 Hz: every 5/3 of a frame; 5 frames last 4 steps, so that 10/3 is the last.
    slower = resample(line(still, 5, 50.0), 30.0)
    np.testing.assert_allclose(slower.root_position[:, 0], [0, 5 / 3, 10 / 3], atol=1e-12)


def test_one_frame_stays_one_frame(still):
    assert resample(line(still, 1, 25.0), 30.0).frames == 1


def test_turns_take_the_short_way_whatever_the_sign_of_the_quaternion(still):
    turns = [[about_z(0)], [[-value for value in about_z(60)]], [about_z(120)]]
    recording = still(("root",), (-1,), ((0, 0, 0),), rotations=turns, frame_rate=20.0)
    twice = resample(recording, 40.0)
    x = np.array([1.0, 0.0, 0.0, 0.0])
    assert x @ twice.rotations[0, 0] == 0.0
    angles = 2 * np.degrees(np.arctan2(twice.rotations[:, 0, 2], twice.rotations[:, 0, 3]))
    np.testing.assert_allclose(angles % 360, [0, 30, 60, 90, 120], atol=1e-10)


def test_turns_are_interpolated_in_the_axes_that_the_joint_has_then(still):
    # From Rx(90) to Rx(90) Rz(60): half-way is Rx(90) Rz(30), which takes x to (cos 30, 0, sin 30).
    half, c, s = np.sqrt(0.5), np.cos(np.radians(30)), np.sin(np.radians(30))
    turns = [[[half, 0, 0, half], NO_TURN], [[half * c, -half * s, half * s, half * c], NO_TURN]]
    recording = still(
        ("root", "hand"), (-1, 0), ((0, 0, 0), (1, 0, 0)), rotations=turns, frame_rate=15.0
    )
    hand = resample(recording, 30.0).positions()[:, 1]
    expected = [[1, 0, 0], [c, 0, s], [0.5, 0, np.sqrt(0.75)]]
    np.testing.assert_allclose(hand, expected, atol=1e-12)


@pytest.mark.parametrize("rate", [0.0, -30.0, float("nan"), float("inf")])
def test_rates_must_be_positive(still, rate):
    with pytest.raises(CaptureError, match="expected more than 0"):
        resample(line(still, 5, 30.0), rate)


SIDES = ("Hips", "LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg", "Spine")
SIDE_PARENTS = (-1, 0, 1, 0, 3, 0)
SIDE_OTHERS = [0, 3, 4, 1, 2, 5]


def test_a_mirrored_step_to_the_left_is_a_step_to_the_right(still):
    # The file's X is to the left.  Only the left leg is long.
    offsets = [[0, 0, 0], [0.1, 0, 0], [0, -0.9, 0], [-0.1, 0, 0], [0, -0.5, 0], [0, 0.4, 0]]
    to_world = [0.5, 0.5, 0.5, 0.5]
    recording = still(
        SIDES,
        SIDE_PARENTS,
        offsets,
        rotations=[[to_world, *[NO_TURN] * 5]],
        root_position=[[1.0, 2.0, 1.0]],
    )
    left_leg, right_leg = [[1, 2.1, 1], [1, 2.1, 0.1]], [[1, 1.9, 1], [1, 1.9, 0.5]]
    stands = [[1, 2, 1], *left_leg, *right_leg, [1, 2, 1.4]]
    np.testing.assert_allclose(recording.positions()[0], stands, atol=1e-15)
    mirrored = mirror(recording)
    left_leg, right_leg = [[1, -1.9, 1], [1, -1.9, 0.5]], [[1, -2.1, 1], [1, -2.1, 0.1]]
    expected = [[1, -2, 1], *left_leg, *right_leg, [1, -2, 1.4]]
    np.testing.assert_allclose(mirrored.positions()[0], expected, atol=1e-15)
    assert mirrored.name == "still~mirror"
    # At rest the mirrored skeleton stands as the original does, with the legs exchanged.
    assert mirrored.skeleton.offsets[1].tolist() == [0.1, 0, 0]
    assert mirrored.skeleton.offsets[2].tolist() == [0, -0.5, 0]


offsets_of_sides = arrays(float, (6, 3), elements=st.floats(-2, 2))
quaternions = arrays(float, (3, 6, 4), elements=st.floats(-1, 1)).filter(
    lambda q: np.linalg.norm(q, axis=2).min() > 1e-3
)


@settings(deadline=None, max_examples=80)
@given(offsets_of_sides, quaternions, arrays(float, (3, 3), elements=st.floats(-50, 50)))
def test_mirrored_kinematics_are_the_reflection_with_the_sides_exchanged(offsets, quats, root):
    quats /= np.linalg.norm(quats, axis=2, keepdims=True)
    recording = Recording("any", Skeleton(SIDES, SIDE_PARENTS, offsets), 30.0, root, quats)
    mirrored = mirror(recording)
    reflected = recording.positions() * [1, -1, 1]
    np.testing.assert_allclose(mirrored.positions(), reflected[:, SIDE_OTHERS], atol=1e-12)
    again = mirror(mirrored)
    np.testing.assert_allclose(again.positions(), recording.positions(), atol=1e-12)
    np.testing.assert_allclose(again.skeleton.offsets, offsets, atol=0)


def test_sides_that_differ_in_structure_cannot_be_exchanged(still):
    names = ("Hips", "LeftUpLeg", "LeftFoot", "RightUpLeg", "RightFoot")
    recording = still(names, (-1, 0, 1, 0, 0), np.zeros((5, 3)))
    with pytest.raises(CaptureError, match=r"^still: joints 'LeftFoot' and 'RightFoot' hang from"):
        mirror(recording)
