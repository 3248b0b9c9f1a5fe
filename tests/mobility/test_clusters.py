"""Subtractive clustering against the textbook, written out in NumPy."""

import dataclasses

import numpy as np
import pytest

from mesa_mobility.errors import MapError
from mesa_mobility.mobility import cluster_poses, motion_graph
from tests.fixtures.poses import random_poses


def textbook_centres(points, wanted, radius):
    """Chiu's subtractive clustering: potentials, r_b = 1.5 r_a, a fixed number of centres."""
    d2 = ((points[:, None] - points[None]) ** 2).sum(axis=-1)
    potential = np.exp(-4 * d2 / radius**2).sum(axis=1)
    chosen = []
    for _ in range(wanted):
        best = int(np.argmax(potential))
        chosen.append(best)
        potential = potential - potential[best] * np.exp(-4 * d2[best] / (1.5 * radius) ** 2)
        potential[best] = -np.inf
    return chosen


@pytest.fixture
def graph():
    return motion_graph(random_poses(np.random.default_rng(2)))


def test_centres_are_those_of_the_textbook(graph):
    clusters = cluster_poses(graph, 9)
    moving = np.flatnonzero(graph.kept & (graph.poses.speed > 0.1))
    points = graph.poses.features[moving].astype(np.float64)
    spread = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
    centres = points[textbook_centres(points, 8, 0.4 * spread)]
    np.testing.assert_allclose(clusters.centres[1:], centres, atol=1e-6)
    nearest = ((points[:, None] - centres[None]) ** 2).sum(axis=-1).argmin(axis=1)
    np.testing.assert_array_equal(clusters.labels[moving], 1 + nearest)


def test_all_who_stand_share_cluster_zero_and_no_cluster_is_empty(graph):
    clusters = cluster_poses(graph, 20)
    standing = graph.kept & (graph.poses.speed < 0.1)
    assert standing.any()
    np.testing.assert_array_equal(clusters.labels == 0, standing)
    assert (clusters.sizes > 0).all()
    assert clusters.sizes.sum() == graph.kept.sum()
    assert (clusters.labels[~graph.kept] == -1).all()
    assert clusters.mean_speeds[0] == 0.0
    assert clusters.mean_speeds[1:] == pytest.approx(1.2)
    assert clusters.stopped_by == "reached the requested number of clusters (20)"


def test_more_clusters_than_poses_is_said(graph):
    clusters = cluster_poses(graph, 10_000)
    assert "every moving pose became a centre" in clusters.stopped_by


def test_one_cluster_is_refused(graph):
    with pytest.raises(MapError, match="clusters: got 1, expected at least 2"):
        cluster_poses(graph, 1)


def test_the_number_of_clusters_is_in_proportion_to_the_poses():
    graph = motion_graph(random_poses(np.random.default_rng(2), clips=10, length=60))
    assert 500 < graph.kept.sum() < 600
    assert len(cluster_poses(graph)) == 3  # one for 150 poses


def test_where_nobody_stands_the_standing_cluster_is_empty():
    poses = random_poses(np.random.default_rng(2))
    poses.speed[:] = 1.2
    clusters = cluster_poses(motion_graph(poses), 5)
    assert len(clusters) == 5
    assert clusters.sizes[0] == 0
    assert (clusters.sizes[1:] > 0).all()
    assert (clusters.labels != 0).all()
    assert np.isfinite(clusters.mean_joints).all()


def test_recordings_without_anybody_moving_are_refused():
    poses = random_poses(np.random.default_rng(2))
    poses.speed[:] = 0.0
    with pytest.raises(MapError, match="no moving poses among the"):
        cluster_poses(motion_graph(poses), 5)


def test_moving_poses_that_are_not_connected_are_counted():
    poses = random_poses(np.random.default_rng(2), clips=3, length=60)
    # The third clip alone moves, in poses unlike all others, and drifts so that none recurs.
    features = poses.features.copy()
    features[120:] = 50.0 + 0.01 * np.arange(60)[:, None]
    poses = dataclasses.replace(poses, features=features)
    poses.speed[:120] = 0.0
    poses.speed[120:] = 1.2
    with pytest.raises(MapError, match=r"no moving .*; 60 others are not connected with these"):
        cluster_poses(motion_graph(poses), 5)
