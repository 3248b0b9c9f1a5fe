"""The recorded poses along each option of a map that has been built before.

A map's file holds paths over the floor and no poses. Its options are computed anew from the same
recordings, this time with the poses on the way, and compared with the map's.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture import Recording
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.clusters import cluster_poses
from mesa_mobility.mobility.graph import motion_graph
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.paths import (
    MOST_JUMPS,
    SAMPLE_EVERY,
    ReachableOptions,
    reachable_options,
)
from mesa_mobility.mobility.poses import PoseTable, pose_table
from mesa_mobility.mobility.standing.borrowing import borrow, missing
from mesa_mobility.mobility.storing.families import OptionFamilies
from mesa_mobility.mobility.storing.steps import quantise_paths

Progress = Callable[[str, int, int], None]


class Retraced(NamedTuple):
    """A map's options with the poses behind them.

    Attributes:
        poses: the n poses of the recordings.
        labels: (n,) cluster of each pose, -1 for none.
        chains: (m, 4, 2) the recorded stretches that make up each option of the map, in order: the
            frame of the path at which a stretch begins, and its pose there, -1 for none.
        strides: (m,) factor by which an edit has scaled the strides, 1 for options as recorded.
    """

    poses: PoseTable
    labels: NDArray[np.int32]
    chains: NDArray[np.int32]
    strides: NDArray[np.float64]


def retrace(
    map_: MobilityMap, recordings: Sequence[Recording], progress: Progress | None = None
) -> Retraced:
    """Find the poses along each option of a map.

    Args:
        map_: the map, built with the settings of this version.
        recordings: those that it was built from, prepared in the same way and order.
        progress: called as ``progress(stage, done, total)``.

    Raises:
        MapError: the recordings do not give the map's options.
    """

    def report(stage: str) -> Callable[[int, int], None] | None:
        return None if progress is None else lambda done, total: progress(stage, done, total)

    settings = map_.metadata.get("build")
    if not isinstance(settings, dict):
        raise MapError("the map's metadata do not say how it was built, which its poses need")
    poses = pose_table(recordings, report("poses"))
    graph = motion_graph(poses)
    if progress is not None:
        progress("motion graph", len(poses), len(poses))
    asked = settings.get("clusters_asked", map_.n_clusters)
    grouped = cluster_poses(graph, asked, report("clusters"))
    options = reachable_options(graph, grouped, progress=report("options"))
    labels = grouped.labels
    families = OptionFamilies.of(poses.step, grouped, options, map_.metadata)
    options = families.options()
    strides = np.array([1.0, *(edit.stride for edit in families.editing().edits)])
    if missing(options, grouped):
        options, grouped = borrow(options, grouped, MobilityMap.load())
    _check_same(map_, options)
    # The first option of a map is the stand, which the builder adds.
    chains = chains_of(options, len(poses))
    return Retraced(
        poses,
        labels,
        np.concatenate([np.full_like(chains[:1], -1), chains]),
        np.concatenate([[1.0], strides[options.edits]]),
    )


def chains_of(options: ReachableOptions, poses: int) -> NDArray[np.int32]:
    """(m, 4, 2) recorded stretches of each option, from its transitions among so many poses."""
    jumps = np.sort(np.where(options.jumps < 0, np.iinfo(np.int64).max, options.jumps), axis=1)
    frames, vias = np.divmod(jumps, poses)
    jumped = jumps < np.iinfo(np.int64).max
    chains = np.full((len(jumps), 1 + MOST_JUMPS, 2), -1, dtype=np.int32)
    chains[:, 0, 0] = np.where(options.sources < 0, -1, 0)
    chains[:, 0, 1] = options.sources
    chains[:, 1:, 0] = np.where(jumped, frames, -1)
    chains[:, 1:, 1] = np.where(jumped, vias + 1, -1)
    return chains


def _check_same(map_: MobilityMap, options: ReachableOptions) -> None:
    same = map_.n_options == 1 + len(options.durations)
    if same:
        samples = options.durations.astype(np.int64) // SAMPLE_EVERY
        present = np.arange(options.paths.shape[1]) < samples[:, None]
        same = np.array_equal(map_.durations[1:], options.durations) and np.array_equal(
            map_.paths[map_.path_offsets[1] :], quantise_paths(options.paths[present])
        )
    if not same:
        raise MapError(
            f"the recordings give {1 + len(options.durations)} options that differ from the "
            f"map's {map_.n_options}: expected the recordings that it was built from, and a map "
            "built by this version"
        )
