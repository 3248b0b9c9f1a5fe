"""From recordings to a clustered mobility map, in one call."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording
from mesa_mobility.mobility import clusters as clustering
from mesa_mobility.mobility import graph as graphs
from mesa_mobility.mobility import paths
from mesa_mobility.mobility.clusters import STANDING, Clusters, cluster_poses
from mesa_mobility.mobility.graph import MotionGraph, motion_graph
from mesa_mobility.mobility.map import CORE_RADIUS, MobilityMap
from mesa_mobility.mobility.mapfile import quantise_costs, quantise_paths
from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
from mesa_mobility.mobility.poses import FRAME_RATE, pose_table
from mesa_mobility.mobility.provenance import acknowledgements, provenance

DEFAULT_CLUSTERS = 350

STAND_FRAMES = 12
"""Duration of the stand option: 1.5 s of standing would be absorbing, 0.4 s is not."""

Progress = Callable[[str, int, int], None]


def build_map(
    recordings: Sequence[Recording],
    *,
    type_name: str = "able_bodied",
    clusters: int = DEFAULT_CLUSTERS,
    metadata: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> MobilityMap:
    """Compute the clustered mobility map of recordings at 30 Hz.

    Args:
        recordings: clips, with their mirror images if these are wanted.
        type_name: name of the pedestrian type.
        clusters: number of clusters, the standing one included.
        metadata: further entries for the map's metadata, such as the command.
        progress: called as ``progress(stage, done, total)``.

    Raises:
        MapError: the recordings do not give a map.
    """

    def report(stage: str) -> Callable[[int, int], None] | None:
        return None if progress is None else lambda done, total: progress(stage, done, total)

    poses = pose_table(recordings, report("poses"))
    graph = motion_graph(poses)
    if progress is not None:
        progress("motion graph", len(poses), len(poses))
    grouped = cluster_poses(graph, clusters, report("clusters"))
    options = reachable_options(graph, grouped, report("options"))
    return _assemble(
        options,
        grouped,
        {
            "pedestrian_type": type_name,
            "body": {"core_radius_m": CORE_RADIUS},
            "frame_rate_hz": FRAME_RATE,
            "build": _build_parameters(graph, grouped),
            "provenance": provenance(recordings),
            "acknowledgements": acknowledgements(recordings),
            **(metadata or {}),
        },
    )


def _assemble(
    options: ReachableOptions, grouped: Clusters, metadata: dict[str, Any]
) -> MobilityMap:
    samples = options.durations.astype(np.int64) // paths.SAMPLE_EVERY
    present = np.arange(options.paths.shape[1]) < samples[:, None]
    # The stand comes first among the options of the standing cluster, which is the first cluster.
    stand = STAND_FRAMES // paths.SAMPLE_EVERY
    offsets = options.offsets + 1
    offsets[STANDING] = 0
    return MobilityMap(
        offsets=offsets,
        durations=np.concatenate([[STAND_FRAMES], options.durations]).astype(np.int16),
        costs=quantise_costs(np.concatenate([[0.0], options.costs])),
        path_offsets=np.concatenate([[0, stand], stand + np.cumsum(samples)]).astype(np.int64),
        paths=quantise_paths(np.concatenate([np.zeros((stand, 3)), options.paths[present]])),
        path_clusters=np.concatenate(
            [np.full(stand, STANDING), options.path_clusters[present]]
        ).astype(np.uint16),
        mean_poses=grouped.mean_joints,
        centres=grouped.centres,
        sizes=grouped.sizes.astype(np.int64),
        mean_speeds=grouped.mean_speeds.astype(np.float32),
        metadata=metadata,
    )


def _build_parameters(graph: MotionGraph, grouped: Clusters) -> dict[str, Any]:
    return {
        "poses": len(graph.poses),
        "poses_in_component": int(graph.kept.sum()),
        "share_in_component": round(graph.share_kept, 6),
        "largest_components": list(graph.component_sizes[:5]),
        "transitions": graph.transitions,
        "transition_threshold": round(graph.threshold, 6),
        "threshold_ratio": graphs.THRESHOLD_RATIO,
        "clusters_stopped_by": grouped.stopped_by,
        "acceptance_radius": clustering.ACCEPTANCE_RADIUS,
        "squash_ratio": clustering.SQUASH_RATIO,
        "durations_frames": list(paths.DURATIONS),
        "transition_penalty": paths.TRANSITION_PENALTY,
        "budget": paths.BUDGET,
        "cell": [round(float(size), 6) for size in paths.CELL],
    }
