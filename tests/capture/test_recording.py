import dataclasses

import numpy as np
import pytest

from mesa_mobility.capture import Recording, Skeleton
from mesa_mobility.errors import CaptureError

HALF = np.sqrt(0.5)
QUARTER_TURN_Z = [0.0, 0.0, HALF, HALF]
QUARTER_TURN_X = [HALF, 0.0, 0.0, HALF]
NO_TURN = [0.0, 0.0, 0.0, 1.0]
ARM = (("root", "elbow", "hand"), (-1, 0, 1), ((7.0, 7.0, 7.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)))


def test_joints_without_rotation_add_up_their_offsets_and_not_the_root_s(still):
    recording = still(*ARM, root_position=[[10.0, 20.0, 30.0]])
    expected = [[10, 20, 30], [11, 20, 30], [13, 20, 30]]
    np.testing.assert_allclose(recording.positions()[0], expected, atol=1e-15)


def test_rotations_accumulate_down_the_chain(still):
    # The root turns x to y; the elbow turns on to -x.
    rotations = [[QUARTER_TURN_Z, QUARTER_TURN_Z, NO_TURN]]
    positions = still(*ARM, rotations=rotations).positions()
    np.testing.assert_allclose(positions[0], [[0, 0, 0], [0, 1, 0], [-2, 1, 0]], atol=1e-15)


def test_a_joint_turns_what_hangs_from_it_in_its_own_axes(still):
    # The elbow turns about the x axis that the root has turned to y: z goes to x, not to -y.
    names, parents, _ = ARM
    offsets = [[0, 0, 0], [1, 0, 0], [0, 0, 2]]
    rotations = [[QUARTER_TURN_Z, QUARTER_TURN_X, NO_TURN]]
    positions = still(names, parents, offsets, rotations=rotations).positions()
    np.testing.assert_allclose(positions[0], [[0, 0, 0], [0, 1, 0], [2, 1, 0]], atol=1e-15)


def test_frames_are_independent(still):
    rotations = [[NO_TURN] * 3, [QUARTER_TURN_Z, NO_TURN, NO_TURN]]
    recording = still(*ARM, rotations=rotations, root_position=[[0, 0, 1], [0, 0, 2]])
    expected = [[[0, 0, 1], [1, 0, 1], [3, 0, 1]], [[0, 0, 2], [0, 1, 2], [0, 3, 2]]]
    np.testing.assert_allclose(recording.positions(), expected, atol=1e-15)


def test_two_branches_hang_from_one_joint(still):
    recording = still(
        ("root", "left", "left end", "right"),
        (-1, 0, 1, 0),
        ((0, 0, 0), (0, 1, 0), (0, 0, -3), (0, -1, 0)),
    )
    expected = [[0, 0, 0], [0, 1, 0], [0, 1, -3], [0, -1, 0]]
    np.testing.assert_allclose(recording.positions()[0], expected, atol=1e-15)


def test_duration_counts_steps_not_frames(still):
    recording = still(*ARM, root_position=np.zeros((46, 3)))
    assert recording.frames == 46
    assert recording.duration == pytest.approx(1.5)


def test_recordings_and_skeletons_cannot_be_changed(still):
    recording = still(*ARM)
    with pytest.raises(dataclasses.FrozenInstanceError):
        recording.frame_rate = 1.0
    for array in (recording.root_position, recording.rotations, recording.skeleton.offsets):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_making_a_recording_leaves_the_caller_s_array_writable(still):
    positions = np.zeros((1, 3))
    still(*ARM, root_position=positions)
    positions[0] = 1.0
    assert positions.sum() == 3.0


@pytest.mark.parametrize(
    ("names", "parents", "offsets", "message"),
    [
        ((), (), np.zeros((0, 3)), "skeleton without joints"),
        (("a", "b"), (-1,), np.zeros((2, 3)), r"parents have shape \(1,\)"),
        (("a", "b"), (-1, 0), np.zeros((2, 2)), r"expected \(2,\) and \(2, 3\)"),
        (("a", "a"), (-1, 0), np.zeros((2, 3)), "joint 'a' occurs twice"),
        (("a", "b"), (0, 0), np.zeros((2, 3)), "'a' comes first: expected the root"),
        (("a", "b", "c"), (-1, 2, 0), np.zeros((3, 3)), "'b' has parent 2"),
        (("a", "b"), (-1, -1), np.zeros((2, 3)), "'b' has parent -1"),
        (("a", "b"), (-1, 0), [[0, 0, 0], [0, np.nan, 0]], "'b' has an offset that is not finite"),
    ],
)
def test_broken_skeletons_are_refused(names, parents, offsets, message):
    with pytest.raises(CaptureError, match=message):
        Skeleton(names, parents, offsets)


def test_joints_are_found_by_name():
    skeleton = Skeleton(*ARM)
    assert skeleton.index("hand") == 2
    with pytest.raises(CaptureError, match="no joint 'foot': the skeleton has root, elbow, hand"):
        skeleton.index("foot")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frame_rate": 0.0}, "frame rate 0.0"),
        ({"frame_rate": np.nan}, "frame rate nan"),
        ({"root_position": np.zeros((0, 3))}, "no frames"),
        ({"root_position": np.zeros((2, 3))}, r"expected \(2, 3\) and \(2, 3, 4\)"),
        ({"root_position": [[0, np.inf, 0]]}, "not finite"),
        ({"rotations": np.full((1, 3, 4), np.nan)}, "not finite"),
        ({"rotations": np.zeros((1, 3, 4))}, "no unit quaternions"),
    ],
)
def test_broken_recordings_are_refused(changes, message):
    good = {
        "name": "clip",
        "skeleton": Skeleton(*ARM),
        "frame_rate": 30.0,
        "root_position": np.zeros((1, 3)),
        "rotations": np.tile(NO_TURN, (1, 3, 1)),
    }
    Recording(**good)
    with pytest.raises(CaptureError, match=f"^clip: .*{message}"):
        Recording(**(good | changes))
