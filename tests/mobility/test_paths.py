"""Exact-duration least-cost paths against a dynamic programme over dictionaries."""

import numpy as np
import pytest

from mesa_mobility.mobility import cluster_poses, motion_graph, reachable_options
from tests.fixtures.poses import random_poses

BUDGET, PENALTY, CELL = 3.3, 1.0, (0.08, 0.08, np.deg2rad(30.0))


def least_costs(graph, source, frames):
    """{pose: (cost, x, y, heading)} after exactly ``frames`` frames from ``source``."""
    step = graph.poses.step
    layer = {int(source): (0.0, 0.0, 0.0, 0.0)}
    for _ in range(frames):
        following = {}
        for node, (cost, x, y, h) in layer.items():
            for e in range(graph.offsets[node], graph.offsets[node + 1]):
                via, then = int(graph.via[e]), int(graph.successors[e])
                c = cost + float(graph.costs[e]) + (PENALTY if via != node else 0.0)
                if c <= BUDGET and (then not in following or c < following[then][0]):
                    dx, dy, dh = step[via]
                    following[then] = (
                        c,
                        x + np.cos(h) * dx - np.sin(h) * dy,
                        y + np.sin(h) * dx + np.cos(h) * dy,
                        h + dh,
                    )
        layer = following
    return layer


def cell_of(x, y, h):
    turn = int(np.floor(h / CELL[2] + 0.5)) % 12
    return int(np.floor(x / CELL[0] + 0.5)), int(np.floor(y / CELL[1] + 0.5)), turn


@pytest.fixture(scope="module")
def built():
    graph = motion_graph(random_poses(np.random.default_rng(3), clips=4, length=60, wobble=0.05))
    clusters = cluster_poses(graph, 6)
    return graph, clusters, reachable_options(graph, clusters)


@pytest.mark.parametrize("frames", [12, 24, 45])
def test_each_cell_keeps_its_cheapest_path(built, frames):
    graph, clusters, options = built
    for cluster in range(len(clusters)):
        best = {}
        for source in np.flatnonzero(clusters.labels == cluster):
            for cost, x, y, h in least_costs(graph, source, frames).values():
                cell = cell_of(x, y, h)
                best[cell] = min(best.get(cell, np.inf), cost)
        rows = np.arange(options.offsets[cluster], options.offsets[cluster + 1])
        rows = rows[options.durations[rows] == frames]
        ends = options.paths[rows, frames // 3 - 1]
        # A float32 end on a cell's edge may round to the next cell: compare with the costs only.
        assert len(rows) == len(best)
        np.testing.assert_allclose(
            np.sort(options.costs[rows]), np.sort(list(best.values())), atol=1e-4
        )
        inside = [cell_of(*end) in best for end in ends.astype(float)]
        assert np.mean(inside) > 0.98


def test_paths_move_no_faster_than_the_recording(built):
    graph, _, options = built
    longest = 3 * np.hypot(*graph.poses.step[:, :2].T).max()
    for row in range(0, len(options.durations), 7):
        samples = options.durations[row] // 3
        path = np.concatenate([np.zeros((1, 3)), options.paths[row, :samples]])
        assert (np.hypot(*np.diff(path[:, :2], axis=0).T) <= longest + 1e-6).all()
        assert (options.paths[row, samples:] == 0).all()


def test_samples_lie_in_clusters_and_the_result_repeats(built):
    graph, clusters, options = built
    assert options.path_clusters.max() < len(clusters)
    again = reachable_options(graph, clusters)
    for name in ("offsets", "durations", "costs", "paths", "path_clusters"):
        np.testing.assert_array_equal(getattr(again, name), getattr(options, name))
