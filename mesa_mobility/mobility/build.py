"""From recordings to a clustered mobility map, in one call."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording
from mesa_mobility.capture.transforms import MIRRORED
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import clusters as clustering
from mesa_mobility.mobility import graph as graphs
from mesa_mobility.mobility import paths, thinning
from mesa_mobility.mobility.clusters import Clusters, cluster_poses
from mesa_mobility.mobility.edits import HORIZON, ON_FLOORS, Editing
from mesa_mobility.mobility.graph import MotionGraph, motion_graph
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.map_data import CORE_RADIUS
from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
from mesa_mobility.mobility.poses import FRAME_RATE, PoseTable, pose_table
from mesa_mobility.mobility.provenance import acknowledgements, provenance
from mesa_mobility.mobility.standing.borrowing import missing
from mesa_mobility.mobility.standing.ways_back import check_ways_back
from mesa_mobility.mobility.storing.families import OptionFamilies

LEAST_SECONDS = 5.0
"""Least time of all recordings together: a few steps of a walk, a start and a stop."""

LEAST_WAY = 0.4
"""Metres that a walker covers within 1.5 s at some time."""

Progress = Callable[[str, int, int], None]


def build_map(
    recordings: Sequence[Recording],
    *,
    type_name: str = "able_bodied",
    clusters: int | None = None,
    metadata: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> MobilityMap:
    """Compute the clustered mobility map of recordings at 30 Hz.

    Args:
        recordings: clips, with their mirror images if these are wanted.
        type_name: name of the pedestrian type.
        clusters: number of clusters, the standing one included; by default in proportion to
            the poses.
        metadata: further entries for the map's metadata, such as the command.
        progress: called as ``progress(stage, done, total)``.

    If nobody stands or turns on the spot in the recordings, these movements are borrowed from the
    able-bodied map that comes with the package. The metadata says so.

    Raises:
        MapError: the recordings do not give a map, or one that traps people.
    """
    families = build_families(
        recordings, type_name=type_name, clusters=clusters, metadata=metadata, progress=progress
    )
    return map_of_families(families)


def map_of_families(families: OptionFamilies) -> MobilityMap:
    """The map of recorded options and the families around them.

    Raises:
        MapError: people of the map would be trapped.
    """
    built = MobilityMap(**families.fields(MobilityMap.load))
    check_ways_back(built)
    return built


def build_families(
    recordings: Sequence[Recording],
    *,
    type_name: str = "able_bodied",
    clusters: int | None = None,
    editing: Editing = ON_FLOORS,
    metadata: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> OptionFamilies:
    """Compute the recorded options of a map, each of which stands for a family of edited ones.

    Args:
        recordings: as for ``build_map``.
        type_name: as for ``build_map``.
        clusters: as for ``build_map``.
        editing: which options are edited, and how.
        metadata: as for ``build_map``.
        progress: as for ``build_map``.

    Raises:
        MapError: as for ``build_map``.
    """
    graph, grouped, options = options_of_recordings(recordings, clusters, progress, editing)
    parameters = {
        "clusters_asked": clusters,
        **_build_parameters(graph, grouped, options, editing),
    }
    lacks = missing(options, grouped)
    lender = MobilityMap.load().pedestrian_type if lacks else ""
    standing = f"{' and '.join(lacks)} borrowed from the map {lender!r}" if lacks else "recorded"
    return OptionFamilies.of(
        graph.poses.step,
        grouped,
        options,
        {
            "pedestrian_type": type_name,
            "body": {"core_radius_m": CORE_RADIUS},
            "frame_rate_hz": FRAME_RATE,
            "standing": standing,
            "walking_speed_m_s": _walking_speeds(graph.poses),
            "build": parameters,
            "provenance": provenance(recordings),
            "acknowledgements": acknowledgements(recordings),
            **(metadata or {}),
        },
    )


def options_of_recordings(
    recordings: Sequence[Recording],
    clusters: int | None = None,
    progress: Progress | None = None,
    editing: Editing = ON_FLOORS,
) -> tuple[MotionGraph, Clusters, ReachableOptions]:
    """The motion graph of recordings, its clusters and their options, edited ones included.

    Args:
        recordings: as for ``build_map``.
        clusters: as for ``build_map``.
        progress: as for ``build_map``.
        editing: which options are edited, and how.

    Raises:
        MapError: too little is recorded, or nobody walks.
    """

    def report(stage: str) -> Callable[[int, int], None] | None:
        return None if progress is None else lambda done, total: progress(stage, done, total)

    _check_length(recordings)
    poses = pose_table(recordings, report("poses"))
    _check_walking(poses)
    graph = motion_graph(poses)
    if progress is not None:
        progress("motion graph", len(poses), len(poses))
    grouped = cluster_poses(graph, clusters, report("clusters"))
    options = reachable_options(
        graph,
        grouped,
        editing.edits,
        progress=report("options"),
        edited_frames=editing.frames,
    )
    return graph, grouped, options


def _check_length(recordings: Sequence[Recording]) -> None:
    frames = [r.frames for r in recordings if not r.name.endswith(MIRRORED)]
    seconds = sum(frames) / FRAME_RATE
    if frames and seconds < LEAST_SECONDS:
        raise MapError(
            f"{seconds:.1f} s of recordings: expected at least {LEAST_SECONDS:g} s of "
            "people who walk, a minute for a map that serves a crowd"
        )


def _check_walking(poses: PoseTable) -> None:
    rows = np.flatnonzero(poses.clip[:-HORIZON] == poses.clip[HORIZON:])
    way = np.hypot(*(poses.position[rows + HORIZON] - poses.position[rows]).T)
    if way.max(initial=0.0) < LEAST_WAY:
        raise MapError(
            f"nobody walks: they get {way.max(initial=0.0):.2f} m far within 1.5 s at most, "
            "expected recordings of people who walk"
        )


def _walking_speeds(poses: PoseTable) -> dict[str, float]:
    """Quantiles of the speed of those who move, m/s."""
    shares = (5, 25, 50, 75, 95)
    speeds = np.percentile(poses.speed[~poses.is_standing()], shares)
    return {f"p{share}": round(float(v), 3) for share, v in zip(shares, speeds, strict=True)}


def _build_parameters(
    graph: MotionGraph, grouped: Clusters, options: ReachableOptions, editing: Editing
) -> dict[str, Any]:
    return {
        "poses": len(graph.poses),
        "poses_in_component": int(graph.kept.sum()),
        "share_in_component": round(graph.share_kept, 6),
        "largest_components": list(graph.component_sizes[:5]),
        "transitions": graph.transitions,
        "transition_threshold": graphs.THRESHOLD,
        "match_every_frames": graphs.STRETCH,
        "clusters_stopped_by": grouped.stopped_by,
        "acceptance_radius": clustering.ACCEPTANCE_RADIUS,
        "squash_ratio": clustering.SQUASH_RATIO,
        "durations_frames": list(paths.DURATIONS),
        "transition_penalty": paths.TRANSITION_PENALTY,
        "budget": paths.BUDGET,
        "cell": [round(float(size), 6) for size in paths.CELL],
        "edits": {
            "turns_deg_in_45_frames": list(editing.turns_deg),
            "strides": list(editing.strides),
            **({} if editing.frames == ON_FLOORS.frames else {"frames": list(editing.frames)}),
            "cell": [round(float(size), 6) for size in thinning.EDIT_CELL],
            "options": int((options.edits > 0).sum()),
        },
    }
