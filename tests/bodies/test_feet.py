import numpy as np
import pytest

from mesa_mobility.bodies.feet import bend, plant, soles
from mesa_mobility.bodies.rotations import about_z
from mesa_mobility.bodies.skeleton import JOINT, OFFSETS, TURNING, forward_kinematics

HIP, KNEE, ANKLE, TOE = (JOINT[f"left_{j}"] for j in ("hip", "knee", "ankle", "toe"))
HEIGHT = 0.860 + 0.075


def standing(frames):
    turns = np.tile(np.eye(3), (frames, len(TURNING), 1, 1))
    positions, oriented = forward_kinematics(turns)
    positions[..., 2] += HEIGHT
    return positions, oriented


def test_the_neutral_skeleton_stands_on_its_soles():
    positions, oriented = standing(1)
    heel, ball = soles(positions[:, ANKLE], oriented[:, ANKLE])
    np.testing.assert_allclose([heel[0, 2], ball[0, 2]], 0.0, atol=1e-12)


def test_a_bent_leg_reaches_its_target_and_keeps_its_bones():
    positions, oriented = standing(1)
    target = positions[:, ANKLE] + [[0.10, 0.05, 0.20]]
    bend(positions, oriented, (HIP, KNEE, ANKLE), target)
    np.testing.assert_allclose(positions[:, ANKLE], target, atol=1e-12)
    thigh = np.linalg.norm(positions[0, KNEE] - positions[0, HIP])
    shank = np.linalg.norm(positions[0, ANKLE] - positions[0, KNEE])
    assert thigh == pytest.approx(0.429)
    assert shank == pytest.approx(0.431)
    assert positions[0, KNEE, 0] > 0.1  # forwards
    # Orientations lead to the same places.
    np.testing.assert_allclose(
        positions[0, HIP] + oriented[0, HIP] @ OFFSETS[KNEE], positions[0, KNEE], atol=1e-12
    )


def test_a_target_out_of_reach_stretches_the_leg_towards_it():
    positions, oriented = standing(1)
    bend(positions, oriented, (HIP, KNEE, ANKLE), positions[:, ANKLE] + [[0.0, 0.0, -0.5]])
    reach = np.linalg.norm(positions[0, ANKLE] - positions[0, HIP])
    assert 0.8590 < reach < 0.8600


def test_a_foot_that_bears_stays_where_it_is_while_the_body_moves_on():
    positions, oriented = standing(8)
    positions[..., 2] -= 0.02
    positions[..., 0] += 0.01 * np.arange(8)[:, None]  # slides by 7 cm
    bearing = np.tile([True, True, False, False], (8, 1))
    held = plant(positions, oriented, bearing)
    assert (held == bearing).all()
    np.testing.assert_allclose(positions[:, TOE, 0], positions[0, TOE, 0], atol=1e-9)
    heel, ball = soles(positions[:, ANKLE], oriented[:, ANKLE])
    np.testing.assert_allclose(np.minimum(heel, ball)[:, 2], 0.0, atol=1e-9)


def test_who_goes_too_far_takes_a_step():
    positions, oriented = standing(40)
    positions[..., 2] -= 0.02
    positions[..., 0] += 0.02 * np.arange(40)[:, None]
    held = plant(positions, oriented, np.tile([True, True, False, False], (40, 1)))
    assert not held[:, :2].all()
    # After a step the foot is near the body again: 0.15 m are allowed, and 9 frames of a step.
    assert abs(positions[-1, ANKLE, 0] - positions[-1, HIP, 0]) < 0.15 + 10 * 0.02


def test_feet_never_enter_the_floor():
    rng = np.random.default_rng(3)
    positions, oriented = standing(30)
    positions[..., 2] += rng.normal(0.0, 0.03, 30)[:, None]
    oriented[:] = about_z(rng.normal(0, 0.3, 30))[:, None] @ oriented
    plant(positions, oriented, rng.random((30, 4)) < 0.5)
    for side in ("left", "right"):
        ankle = JOINT[f"{side}_ankle"]
        for sole in soles(positions[:, ankle], oriented[:, ankle]):
            # Where the leg does not reach, the foot stays above the floor.
            assert sole[:, 2].min() > -1e-9
