"""The map that ships, and maps built from the real recordings."""

import numpy as np
import pytest

from mesa_mobility.capture import load_clips, read_manifest
from mesa_mobility.mobility import (
    MobilityMap,
    build_map,
    cluster_poses,
    coverage,
    motion_graph,
    pose_table,
    shipped_map_path,
    shortest_paths,
)


@pytest.fixture(scope="module")
def shipped():
    return MobilityMap.load()


def test_the_shipped_map_is_complete(shipped):
    info = shipped.info()
    assert info["pedestrian_type"] == "able_bodied"
    assert info["clusters"] == 157
    assert info["poses_per_cluster"]["min"] >= 1
    assert info["build"]["share_in_component"] > 0.92
    assert set(info["options_by_frames"]) == {"12", "24", "45"}
    assert shipped_map_path("able_bodied").stat().st_size <= 1.2e6
    assert info["command"].startswith("mesa-mobility map build ")
    assert 0.4 < info["build"]["edits"]["options"] / info["options"] < 0.6


def test_the_shipped_map_says_where_it_comes_from(shipped):
    clips = shipped.metadata["provenance"]
    assert len(clips) == 92
    assert {c["session"] for c in clips} == {"accad_male1", "cmu_16", "cmu_other"}
    assert all(c["licence"] and len(c["sha256"]) == 64 and c["mirrored"] for c in clips)
    assert not any("NC" in c["licence"] for c in clips)
    thanks = " ".join(shipped.metadata["acknowledgements"])
    assert "EIA-0196217" in thanks
    assert "ACCAD, The Ohio State University" in thanks


def test_walking_options_look_like_walking(shipped):
    long = shipped.durations == 45
    reach = np.hypot(*shipped.end_points[long].T)
    assert np.percentile(reach, 99) < 3.45  # few steps are faster than about 2.3 m/s
    assert reach.max() > 2.2
    samples = np.diff(shipped.path_offsets)
    steps = np.diff(shipped.paths[:, :2], axis=0)
    inner = np.ones(len(steps), bool)
    inner[shipped.path_offsets[1:-1] - 1] = False
    assert samples.min() == 4
    assert np.hypot(*steps[inner].T).max() < 0.3  # 0.1 s at 3 m/s


def test_a_stander_can_stand_walk_off_and_turn_either_way(shipped):
    rows = np.asarray(shipped.options_of(shipped.standing))
    frames, ends = shipped.durations[rows], shipped.end_points[rows]
    turns = shipped.end_headings[rows]
    stand = (frames == 12) & (np.hypot(*ends.T) == 0) & (turns == 0)
    assert stand.sum() == 1
    assert (ends[frames == 45][:, 0] > 1.2).any()
    assert turns.max() > np.deg2rad(60)
    assert turns.min() < -np.deg2rad(60)
    # Mirrored recordings: left and right come alike.
    assert abs((turns > 0.1).sum() / (turns < -0.1).sum() - 1) < 0.1


@pytest.mark.captures
@pytest.mark.slow
def test_held_out_clips_are_covered_and_builds_repeat(captures_dir, tmp_path):
    manifest = read_manifest(captures_dir / "manifest.tsv")
    recordings = load_clips(manifest, pedestrian_type="able_bodied").recordings
    sessions: dict[str, list[str]] = {}
    for recording in recordings[::2]:
        sessions.setdefault(recording.clip.session, []).append(recording.name)
    held = {name for names in sessions.values() for name in names[6::7]}
    assert len(held) == 12
    train = [r for r in recordings if r.name.removesuffix("~mirror") not in held]
    test = [r for r in recordings if r.name in held]
    built = build_map(train)
    figures = coverage(built, test)
    assert figures["endpoint_error_m"]["median"] <= 0.02
    assert figures["share_within_15cm_20deg"] >= 0.95
    built.save(tmp_path / "a.npz")
    build_map(train).save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


@pytest.mark.captures
@pytest.mark.slow
def test_literal_shortest_paths_hardly_ever_have_45_frames(captures_dir):
    """Why the map uses paths of exactly 45 frames (unconstrained: hundreds of frames)."""
    manifest = read_manifest(captures_dir / "manifest.tsv")
    clips = load_clips(manifest, pedestrian_type="able_bodied", mirrored=False).recordings
    clips = [clip for clip in clips if clip.clip.session == "accad_male1"]
    graph = motion_graph(pose_table(clips))
    found = shortest_paths(graph, np.flatnonzero(graph.kept)[::400])
    assert found.median_frames > 90
    assert found.share_of_exactly(45) < 0.02


@pytest.mark.captures
@pytest.mark.slow
def test_clusters_of_real_poses_hold_alike_poses(captures_dir):
    manifest = read_manifest(captures_dir / "manifest.tsv")
    clips = load_clips(manifest, pedestrian_type="able_bodied", mirrored=False).recordings
    clips = [clip for clip in clips if clip.clip.session == "accad_male1"]
    graph = motion_graph(pose_table(clips))
    clusters = cluster_poses(graph, 60)
    features = graph.poses.features[clusters.labels >= 0]
    labels = clusters.labels[clusters.labels >= 0]
    within = np.mean((features - clusters.centres[labels]) ** 2)
    assert within < 0.35 * features.var(axis=0).mean()
