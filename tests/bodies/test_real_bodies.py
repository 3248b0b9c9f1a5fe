"""Bodies against the recordings, and in runs."""

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.bodies import PoseBank, body_motion, quality
from mesa_mobility.bodies.landmarks import landmarks
from mesa_mobility.bodies.retargeting import bone_directions, retarget
from mesa_mobility.bodies.rotations import about_z, angles
from mesa_mobility.bodies.skeleton import JOINT, PARENTS, forward_kinematics
from mesa_mobility.capture import Recording, find_clips, load_clips
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.mobility import pose_table
from mesa_mobility.results import Trajectories
from tests.fixtures.maps import shipped_map


@pytest.fixture(scope="module")
def bank() -> PoseBank:
    return PoseBank.of(shipped_map().digest)


@pytest.fixture(scope="module")
def walk() -> PedestrianModel:
    plan = FloorPlan(
        "POLYGON ((0 0, 14 0, 14 4, 0 4, 0 0))", exits=[Exit("door", (14, 1.0), (14, 3.0))]
    )
    model = PedestrianModel(plan, record="decisions", rng=5)
    model.add_pedestrians([(1.0, 1.0), (1.5, 2.5), (3.0, 1.8)])
    model.run(max_seconds=5)
    return model


def recording_named(captures_dir, name: str) -> Recording:
    found = load_clips(
        find_clips(captures_dir / "manifest.tsv"), pedestrian_type="able_bodied", mirrored=False
    )
    return next(each for each in found.recordings if each.name == name)


@pytest.mark.captures
@pytest.mark.slow
@pytest.mark.parametrize("name", ["16_17", "Male1_A4_LookAround", "08_02"])
def test_poses_of_the_bank_point_where_the_recorded_bones_do(captures_dir, bank, name):
    recording = recording_named(captures_dir, name)
    clip = [each["clip"] for each in bank.metadata["clips"]].index(name)
    rows = np.arange(bank.clips[clip], bank.clips[clip + 1])
    facing = pose_table([recording]).facing
    positions, _ = forward_kinematics(bank.turns(2 * rows))
    away = about_z(-facing)
    seen = {k: np.einsum("nij,nj->ni", away, v) for k, v in landmarks(recording).items()}
    for joint, direction in bone_directions(seen).items():
        if joint.endswith("shoulder"):
            continue  # where a neck begins differs between skeletons
        j = JOINT[joint]
        start = JOINT["pelvis"] if joint == "chest" else int(PARENTS[j])
        own = positions[:, j] - positions[:, start]
        own /= np.linalg.norm(own, axis=1, keepdims=True)
        off = np.rad2deg(np.arccos(np.clip(np.einsum("ni,ni->n", own, direction), -1, 1)))
        assert np.median(off) < 0.1, joint  # 2 degrees are wanted


@pytest.mark.captures
@pytest.mark.slow
def test_both_skeletons_walk_with_the_same_feet_on_the_floor(captures_dir, bank):
    for name in ("16_17", "08_02"):
        recording = recording_named(captures_dir, name)
        clip = retarget(recording, pose_table([recording]).facing)
        assert 0.80 < np.median(clip.heights) < 0.95
        # A walker has a foot on the floor always; not every contact is found (record 19).
        assert clip.contacts.any(axis=1).mean() > 0.7


def test_bodies_of_a_run_walk_along_its_tracks(walk, bank):
    run = Trajectories.of(walk)
    for person in range(3):
        motion = run.poses(person)
        rows = run.rows_of(person)
        np.testing.assert_allclose(motion.positions[:, 0, 0], run.x[rows], atol=1e-9)
        np.testing.assert_allclose(motion.positions[:, 0, 1], run.y[rows], atol=1e-9)
        found = quality(motion)
        assert np.median(found.slides) < 0.02
        assert found.depths.max() < 1e-6
        # They walk: legs take steps of which each foot has its share.
        assert len(found.slides) >= 4


def test_feet_slide_far_more_without_being_held(walk, bank):
    run = Trajectories.of(walk)
    rows = run.rows_of(0)
    track = np.column_stack([run.x[rows], run.y[rows], run.heading[rows]])
    movements = run.decisions.movements_of(0)
    loose = quality(
        body_motion(bank, movements, run.frame[rows].astype(np.int64), track, planted=False)
    )
    held = quality(run.poses(0))
    assert np.median(held.slides) < 0.2 * np.median(loose.slides)


def test_joins_jump_no_more_than_recordings_do(walk, bank):
    numbers = np.arange(0, 2 * len(bank.rotations), 2)
    turns = bank.turns(numbers)
    steps = angles(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    within = np.delete(steps, bank.clips[1:-1] - 1, axis=0).max()
    run = Trajectories.of(walk)
    assert max(quality(run.poses(p)).jumps.max() for p in range(3)) < 1.5 * within


def test_bones_keep_their_lengths_and_times_between_frames_lie_between(walk):
    run = Trajectories.of(walk)
    motion = run.poses(0, [3, 3.5, 4])
    assert motion.frames.tolist() == [3.0, 3.5, 4.0]
    np.testing.assert_allclose(
        motion.positions[1], (motion.positions[0] + motion.positions[2]) / 2, atol=1e-12
    )
    thigh = motion.positions[:, JOINT["left_knee"]] - motion.positions[:, JOINT["left_hip"]]
    np.testing.assert_allclose(np.linalg.norm(thigh[[0, 2]], axis=1), 0.429, atol=1e-9)


def test_a_pedestrian_tells_its_pose_as_the_run_does(walk):
    run = Trajectories.of(walk)
    for person in walk.agents:
        now = person.pose()
        later = run.poses(person.row, [walk.frame])
        assert now.positions.shape == (1, 22, 3)
        np.testing.assert_allclose(now.positions, later.positions, atol=0.02)


def test_poses_need_decisions_and_a_person_who_is_there(walk):
    run = Trajectories.of(walk)
    with pytest.raises(ResultsError, match="person 9"):
        run.poses(9)
    with pytest.raises(ResultsError, match="frame 0 to"):
        run.poses(0, [1e6])
    plain = PedestrianModel(walk.floor_plan, record=True, rng=1)
    (person,) = plain.add_pedestrians([(2.0, 2.0)])
    plain.step()
    with pytest.raises(ModelError, match='record="decisions"'):
        person.pose()
    with pytest.raises(ResultsError, match="--record decisions"):
        Trajectories.of(plain).poses(0)


def test_decisions_change_nothing_about_a_run(walk):
    same = PedestrianModel(walk.floor_plan, record=True, rng=5)
    same.add_pedestrians([(1.0, 1.0), (1.5, 2.5), (3.0, 1.8)])
    same.run(max_seconds=5)
    one, two = Trajectories.of(walk), Trajectories.of(same)
    for name in ("frame", "person", "x", "y", "heading"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
