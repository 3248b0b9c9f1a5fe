"""Known facts about the real recordings, compared with the readers' results."""

import csv

import numpy as np
import pytest

from mesa_mobility.capture import (
    leg_joints,
    load_clips,
    read_amc,
    read_bvh,
    read_manifest,
)

pytestmark = pytest.mark.captures

CMU_UNIT_M = 0.0564444
TWINS = ("02_01", "07_01", "07_10", "08_04")


def rows_of(folder):
    with open(folder / "manifest.tsv", newline="") as file:
        return {row["file"]: row for row in csv.DictReader(file, delimiter="\t")}


def legs_of(recording):
    legs = leg_joints(recording.skeleton)
    return recording.positions()[:, [*legs.left, *legs.right]]


@pytest.fixture(scope="module")
def every_clip(captures_dir):
    """All clips, each followed by its mirror image."""
    return load_clips(read_manifest(captures_dir / "manifest.tsv"), minimum_frames=1)


@pytest.fixture(scope="module")
def able_bodied(every_clip):
    return [each for each in every_clip.recordings if each.clip.type == "able_bodied"]


@pytest.mark.parametrize("clip", TWINS)
def test_twins_agree_within_5_mm_at_every_leg_joint(captures_dir, clip):
    amc = read_amc(
        captures_dir / "reader_tests" / "cmu_amc_twins" / f"{clip}.amc", unit_to_m=CMU_UNIT_M
    )
    bvh = read_bvh(captures_dir / "able_bodied" / "cmu_other" / f"{clip}.bvh", unit_to_m=CMU_UNIT_M)
    # The BVH begins with a T-pose that the AMC has not.
    assert bvh.frames == amc.frames + 1
    assert bvh.frame_rate == amc.frame_rate == 120.0
    apart = np.linalg.norm(legs_of(bvh)[1:] - legs_of(amc), axis=2)
    assert apart.shape == (amc.frames, 8)
    assert apart.max() < 0.005


def test_the_fifth_twin_has_the_leg_bones_of_its_subject_s_bvh(captures_dir):
    # The BVH of 02_02 is not among the recordings; 02_01 has the same skeleton.
    amc = read_amc(
        captures_dir / "reader_tests" / "cmu_amc_twins" / "02_02.amc", unit_to_m=CMU_UNIT_M
    )
    bvh = read_bvh(captures_dir / "able_bodied" / "cmu_other" / "02_01.bvh", unit_to_m=CMU_UNIT_M)
    lengths = [
        np.linalg.norm(np.diff(legs_of(r).reshape(-1, 2, 4, 3), axis=2), axis=3)[0]
        for r in (amc, bvh)
    ]
    np.testing.assert_allclose(*lengths, atol=1e-5)


def test_every_clip_loads(captures_dir, every_clip):
    rows = rows_of(captures_dir)
    recordings = every_clip.recordings[::2]
    assert {recording.clip.file for recording in recordings} == set(rows)
    assert len(recordings) == len(rows)
    assert every_clip.skipped == []
    for recording in recordings:
        # The manifest rounds the number of poses in its own way.
        poses = int(rows[recording.clip.file]["poses_30hz"])
        assert abs(recording.frames - poses) <= 1, recording.name


def test_the_able_bodied_clips_give_the_poses_that_are_known(able_bodied):
    assert len(able_bodied) == 2 * 92
    assert sum(recording.frames for recording in able_bodied) == 23_978


def test_people_stand_upright_on_the_floor(able_bodied):
    for recording in able_bodied:
        left, right = np.split(legs_of(recording), 2, axis=1)
        hips = (left[:, 0] + right[:, 0])[:, 2] / 2
        ankles = np.minimum(left[:, 2], right[:, 2])[:, 2]
        assert 0.75 < np.median(hips) < 1.05, recording.name
        # The lower ankle is about a hand's breadth above the floor.
        assert 0.03 < np.median(ankles) < 0.15, recording.name
        for leg in (left, right):
            assert (leg[:, 0, 2] > leg[:, 1, 2]).all(), recording.name


def test_people_walk_where_the_pelvis_faces_with_toes_ahead(able_bodied):
    for recording in able_bodied:
        if "straight" not in recording.clip.tags:
            continue
        left, right = np.split(legs_of(recording), 2, axis=1)
        across = (left[:, 0] - right[:, 0])[:, :2]
        ahead = np.column_stack([across[:, 1], -across[:, 0]])
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        hips = (left[:, 0] + right[:, 0])[:, :2] / 2
        steps = np.gradient(hips, axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        walks = lengths > 0.01  # 0.3 m/s; one clip stops and turns around half-way
        along = (ahead * steps).sum(axis=1)[walks] / lengths[walks]
        assert along.mean() > 0.9, recording.name
        toes = ((left[:, 3] - left[:, 2]) + (right[:, 3] - right[:, 2]))[:, :2] / 2
        assert (toes * ahead).sum(axis=1).mean() > 0.05, recording.name


def test_speeds_are_those_of_the_manifest(captures_dir, able_bodied):
    rows = rows_of(captures_dir)
    for recording in able_bodied:
        row = rows[recording.clip.file]
        if "glitch" in row["tags"]:
            continue  # the manifest's speed is that of the spoilt frames, too
        steps = np.linalg.norm(np.diff(recording.root_position[:, :2], axis=0), axis=1)
        speed = steps.mean() * 30
        # The manifest's speeds are of smoothed paths, which are a little shorter.
        expected = float(row["mean_speed_mps"])
        assert speed == pytest.approx(expected, rel=0.07, abs=0.01), recording.name


@pytest.mark.parametrize(
    ("clip", "degrees"),
    [
        ("16_17", 90),
        ("16_20", -90),
        ("Male1_B9_WalkToTurnLeft90", 90),
        ("Male1_B12_WalkTurnRight90", -90),
        ("Male1_B14_WalkTurnRight135", -135),
    ],
)
def test_left_is_counter_clockwise_and_mirrors_turn_the_other_way(able_bodied, clip, degrees):
    turned = {}
    for recording in able_bodied:
        legs = legs_of(recording)
        across = (legs[:, 0] - legs[:, 4])[:, :2]
        heading = np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))
        turned[recording.name] = np.degrees(heading[-15:].mean() - heading[:15].mean())
    assert turned[clip] == pytest.approx(degrees, abs=25)
    assert turned[f"{clip}~mirror"] == pytest.approx(-turned[clip], abs=1e-6)


def test_mirrored_legs_are_exact_reflections(able_bodied):
    for original, mirrored in zip(able_bodied[::2], able_bodied[1::2], strict=True):
        assert mirrored.name == f"{original.name}~mirror"
        exchanged = legs_of(mirrored)[:, [4, 5, 6, 7, 0, 1, 2, 3]]
        np.testing.assert_allclose(exchanged, legs_of(original) * [1, -1, 1], atol=1e-12)


@pytest.mark.thorough
def test_the_recordings_for_research_use_load_too(captures_noncommercial_dir):
    manifest = read_manifest(captures_noncommercial_dir / "manifest.tsv")
    loaded = load_clips(manifest, mirrored=False)
    assert len(loaded.recordings) == 159
    assert sum(recording.frames for recording in loaded.recordings) == 30_506
    for recording in loaded.recordings:
        assert recording.skeleton.names[0] == "Hips"
        hips = legs_of(recording)[:, [0, 4], 2].mean()
        assert 0.8 < hips < 0.95, recording.name
