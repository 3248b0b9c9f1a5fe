"""Edited options fill cells that no recorded option ends in, at least cost."""

import numpy as np
import pytest

from mesa_mobility.mobility import cluster_poses, motion_graph, reachable_options
from mesa_mobility.mobility.edits import EDITS, Edit, edit_paths
from tests.fixtures.poses import random_poses


def cell_of(end):
    """The cell of 15 cm x 15 cm x 20 degrees."""
    x, y, heading = (end / [0.15, 0.15, np.pi / 9] + 0.5).astype(float)
    return int(np.floor(x)), int(np.floor(y)), int(np.floor(heading)) % 18


def ends(options, cluster, edited):
    rows = np.arange(*options.offsets[cluster : cluster + 2])
    rows = rows[(options.edits[rows] > 0) == edited]
    last = options.durations[rows] // 3 - 1
    return rows, options.paths[rows, last].astype(float)


@pytest.mark.parametrize("frames", [(45,), (12, 24, 45), (24,)])
def test_edited_options_fill_free_cells_at_least_cost(frames):
    graph = motion_graph(random_poses(np.random.default_rng(3), clips=3, length=40, wobble=0.05))
    clusters = cluster_poses(graph, 6)
    plain = reachable_options(graph, clusters)
    edits = (Edit(0.3, 1.0), Edit(-0.3, 1.0), Edit(0.0, 0.8))
    both = reachable_options(graph, clusters, edits, edited_frames=frames)
    assert not plain.edits.any()
    assert both.edits.any()
    for cluster in range(len(clusters)):
        recorded, recorded_ends = ends(both, cluster, False)
        own = slice(*plain.offsets[cluster : cluster + 2])
        np.testing.assert_array_equal(both.paths[recorded], plain.paths[own])
        np.testing.assert_array_equal(both.costs[recorded], plain.costs[own])
        taken = {
            (duration, cell_of(end))
            for duration, end in zip(both.durations[recorded], recorded_ends, strict=True)
        }
        # Every edit of every option by hand: the least cost of each cell that is free.
        best: dict[tuple, float] = {}
        for row in recorded[np.isin(both.durations[recorded], frames)]:
            samples = both.durations[row] // 3
            for edit in edits:
                cost = both.costs[row] + edit.cost
                end = edit_paths(both.paths[row : row + 1, :samples], edit)[0, -1]
                key = both.durations[row], cell_of(end.astype(np.float32).astype(float))
                if cost <= 3.3 and key not in taken:
                    best[key] = min(best.get(key, np.inf), cost)
        edited, edited_ends = ends(both, cluster, True)
        found = {
            (both.durations[row], cell_of(end)): float(both.costs[row])
            for row, end in zip(edited, edited_ends, strict=True)
        }
        assert len(found) == len(edited)
        assert found.keys() == best.keys()
        for key, cost in found.items():
            assert abs(cost - best[key]) < 1e-4
    assert (np.diff(both.offsets) > 0).all()


def test_options_of_all_edits_repeat():
    graph = motion_graph(random_poses(np.random.default_rng(8), clips=3))
    clusters = cluster_poses(graph, 4)
    one, two = (reachable_options(graph, clusters, EDITS) for _ in range(2))
    columns = (
        "offsets",
        "durations",
        "costs",
        "paths",
        "path_clusters",
        "sources",
        "jumps",
        "edits",
    )
    for name in columns:
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
