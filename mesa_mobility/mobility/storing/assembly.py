"""From options of clusters to the fields of a map: what is missing is borrowed, the rest joined."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mesa_mobility.mobility.clusters import STANDING, Clusters
from mesa_mobility.mobility.edits import SAMPLE_EVERY
from mesa_mobility.mobility.map_data import MapData
from mesa_mobility.mobility.paths import ReachableOptions
from mesa_mobility.mobility.standing.borrowing import borrow, missing
from mesa_mobility.mobility.storing.steps import quantise_costs, quantise_paths

STAND_FRAMES = 12
"""Duration of the stand option: 1.5 s of standing would be absorbing, 0.4 s is not."""


def assemble(
    options: ReachableOptions,
    clusters: Clusters,
    metadata: Mapping[str, Any],
    lender: Callable[[], MapData],
) -> dict[str, Any]:
    """The fields of a map.

    Args:
        options: of all clusters, edited ones included.
        clusters: the clusters.
        metadata: of the map.
        lender: the map that gives standing, stopping or turning on the spot where that is missing.
    """
    if missing(options, clusters):
        options, clusters = borrow(options, clusters, lender())
    samples = options.durations.astype(np.int64) // SAMPLE_EVERY
    present = np.flatnonzero(np.arange(options.paths.shape[1]) < samples[:, None])
    # The stand comes first among the options of the standing cluster, which is the first cluster.
    stand = STAND_FRAMES // SAMPLE_EVERY
    offsets = options.offsets + 1
    offsets[STANDING] = 0
    return {
        "offsets": offsets,
        "durations": np.concatenate([[STAND_FRAMES], options.durations]).astype(np.int16),
        "costs": quantise_costs(np.concatenate([[0.0], options.costs])),
        "path_offsets": np.concatenate([[0, stand], stand + np.cumsum(samples)]).astype(np.int64),
        "paths": quantise_paths(
            np.concatenate(
                [np.zeros((stand, 3), np.float32), options.paths.reshape(-1, 3)[present]]
            )
        ),
        "path_clusters": np.concatenate(
            [np.full(stand, STANDING), options.path_clusters.reshape(-1)[present]]
        ).astype(np.uint16),
        "mean_poses": clusters.mean_joints,
        "centres": clusters.centres,
        "sizes": clusters.sizes.astype(np.int64),
        "mean_speeds": clusters.mean_speeds.astype(np.float32),
        "metadata": metadata,
    }
