"""Recordings in which nobody stands, or turns, borrow that from the map that ships."""

import dataclasses

import numpy as np
import pytest

from mesa_mobility.mobility import build_map, cluster_poses, motion_graph, reachable_options
from mesa_mobility.mobility.standing.borrowing import borrow, missing
from mesa_mobility.mobility.standing.ways_back import check_ways_back
from tests.fixtures.maps import shipped_map
from tests.fixtures.poses import random_poses


@pytest.fixture(scope="module")
def walking():
    """Options and clusters of people who never stand, at 1.2 m/s."""
    poses = random_poses(np.random.default_rng(4))
    poses.speed[:] = 1.2
    graph = motion_graph(poses)
    clusters = cluster_poses(graph, 6)
    return reachable_options(graph, clusters), clusters


def test_a_standing_cluster_is_borrowed_whole(walking):
    options, clusters = walking
    lender = shipped_map()
    assert missing(options, clusters) == ("standing",)
    joined, complete = borrow(options, clusters, lender)
    theirs = np.asarray(lender.options_of(lender.standing))
    assert joined.offsets[1] == len(theirs)
    np.testing.assert_array_equal(joined.durations[: len(theirs)], lender.durations[theirs])
    # Own people walk at 1.2 m/s; those of the other map at their clusters' mean speeds.
    other = np.average(lender.mean_speeds[1:], weights=lender.sizes[1:])
    stride = min(1.0, 1.2 / other)
    ends = joined.paths[np.arange(len(theirs)), joined.durations[: len(theirs)] // 3 - 1]
    np.testing.assert_allclose(ends[:, :2], stride * lender.end_points[theirs], atol=1e-4)
    np.testing.assert_allclose(ends[:, 2], lender.end_headings[theirs], atol=1e-4)
    assert complete.sizes[0] == lender.sizes[0]
    assert joined.path_clusters.max() < len(complete)
    assert missing(joined, complete) == ()


def test_each_cluster_keeps_its_own_options_and_gets_ways_to_stop(walking):
    options, clusters = walking
    joined, _ = borrow(options, clusters, shipped_map())
    for cluster in range(1, len(clusters)):
        own = slice(*options.offsets[cluster : cluster + 2])
        now = slice(*joined.offsets[cluster : cluster + 2])
        kept = options.offsets[cluster + 1] - options.offsets[cluster]
        np.testing.assert_array_equal(joined.paths[now][:kept], options.paths[own])
        added = slice(now.start + kept, now.stop)
        last = joined.durations[added] // 3 - 1
        assert (joined.path_clusters[added][np.arange(len(last)), last] == 0).all()


def ends_of(options, rows):
    return options.paths[rows, options.durations[rows] // 3 - 1]


def steps_aside_or_back(ends):
    return (ends[:, 0] <= np.abs(ends[:, 1])) & (np.abs(ends[:, 2]) <= np.deg2rad(30.1))


def test_standers_who_never_turn_nor_step_borrow_that_alone():
    # A step has no turn at all here.
    poses = random_poses(np.random.default_rng(4))
    poses = dataclasses.replace(poses, step=poses.step * [1.0, 1.0, 0.0])
    graph = motion_graph(poses)
    clusters = cluster_poses(graph, 6)
    options = reachable_options(graph, clusters)
    assert missing(options, clusters) == ("turning on the spot", "steps aside and back")
    joined, same = borrow(options, clusters, shipped_map())
    assert same is clusters
    np.testing.assert_array_equal(np.diff(joined.offsets)[1:], np.diff(options.offsets)[1:])
    ends = ends_of(joined, np.arange(options.offsets[1], joined.offsets[1]))
    turns = np.abs(ends[:, 2]) >= np.deg2rad(29.9)
    steps = steps_aside_or_back(ends)
    assert turns.any()
    assert steps.any()
    assert (turns | steps).all()
    assert missing(joined, clusters) == ()


def test_standers_who_turn_and_never_step_aside_borrow_steps_alone():
    poses = random_poses(np.random.default_rng(4))
    graph = motion_graph(poses)
    clusters = cluster_poses(graph, 6)
    options = reachable_options(graph, clusters)
    # Two of the standers' options turn where they are instead.
    ends = options.paths.copy()
    for row, turn in ((0, 0.8), (1, -0.8)):
        samples = options.durations[row] // 3
        ends[row] = 0.0
        ends[row, :samples, 2] = turn * np.arange(1, samples + 1) / samples
    options = dataclasses.replace(options, paths=ends)
    assert missing(options, clusters) == ("steps aside and back",)
    joined, _ = borrow(options, clusters, shipped_map())
    added = ends_of(joined, np.arange(options.offsets[1], joined.offsets[1]))
    assert steps_aside_or_back(added).all()
    # To the left, to the right and back by 15 cm at least.
    assert added[:, 1].max() >= 0.15
    assert added[:, 1].min() <= -0.15
    assert added[:, 0].min() <= -0.15
    assert missing(joined, clusters) == ()


def test_steps_that_start_abruptly_do_not_count():
    """A crowd's default rules leave such options out: runners have few others from standing."""
    graph = motion_graph(random_poses(np.random.default_rng(4)))
    clusters = cluster_poses(graph, 6)
    options = reachable_options(graph, clusters)
    standers = np.arange(options.offsets[1])
    long = standers[options.durations[standers] == 45]
    evenly = np.arange(1, 16) / 15.0
    paths = options.paths.copy()
    for row, turn in zip(long, (0.8, -0.8), strict=False):
        paths[row] = 0.0
        paths[row, :, 2] = turn * evenly
    missed = {}
    # By 0.4 m in 1.5 s, or in its last 0.3 s: at 1.3 m/s from rest.
    for name, share in (("even", evenly), ("abrupt", np.maximum(0.0, np.arange(-11, 4) / 3.0))):
        for row, end in zip(long[2:], ((0.0, 0.4), (0.0, -0.4), (-0.4, 0.0)), strict=False):
            paths[row] = 0.0
            paths[row, :, :2] = share[:, None] * end
        missed[name] = missing(dataclasses.replace(options, paths=paths), clusters)
    assert missed == {"even": (), "abrupt": ("steps aside and back",)}


@pytest.mark.captures
def test_a_walk_without_a_stop_becomes_a_map_that_traps_nobody(captures_dir):
    from mesa_mobility.capture import load_clips, read_manifest, trim

    clips = load_clips(
        read_manifest(captures_dir / "manifest.tsv"), pedestrian_type="slow", mirrored=False
    ).recordings
    # The middle of each clip, in which she walks to and fro; then only frames without a stop.
    walks = [trim(clip, 90, 240) for clip in clips]
    built = build_map(walks, type_name="walking")
    check_ways_back(built)
    assert built.sizes[0] >= 1
    assert "stopping" in built.metadata["standing"]
