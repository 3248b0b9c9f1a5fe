"""How well a map covers people who are not in its recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture import Recording
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.clusters import nearest_centre
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.poses import PoseTable, pose_table

HORIZON = 45
"""Frames: the paper's time step."""

NEAR = (0.15, np.deg2rad(20.0))
"""Metres and radians within which an option covers what a person did."""


class Movements(NamedTuple):
    """What recorded people did next, from each pose followed by at least 45 frames.

    Attributes:
        rows: (n,) the poses.
        paths: (n, 15, 3) x, y in metres and heading in radians every 3 frames, relative
            to the pose.
    """

    rows: NDArray[np.int64]
    paths: NDArray[np.float64]


class Ends(NamedTuple):
    """Where the options of each cluster end.

    Attributes:
        offsets: (k + 1,) options of cluster c are ``offsets[c]:offsets[c + 1]``.
        durations: (m,) frames.
        places: (m, 3) x, y in metres and heading in radians.
    """

    offsets: NDArray[np.int64]
    durations: NDArray[np.int16]
    places: NDArray[np.float32]


def movements(poses: PoseTable) -> Movements:
    """What people did in the 45 frames after each pose.

    Raises:
        MapError: no pose has 45 frames to come.
    """
    rows = np.concatenate(
        [np.arange(a, b - HORIZON) for a, b in zip(poses.first[:-1], poses.first[1:], strict=True)]
    ).astype(np.int64)
    if len(rows) == 0:
        raise MapError("no clip is longer than 45 frames: nothing to compare the map with")
    after = rows[:, None] + np.arange(3, HORIZON + 1, 3)
    x, y = (poses.position[after] - poses.position[rows][:, None]).transpose(2, 0, 1)
    facing = poses.facing[rows][:, None]
    c, s = np.cos(facing), np.sin(facing)
    turned = poses.facing[after] - facing
    return Movements(rows, np.stack([c * x + s * y, c * y - s * x, turned], axis=-1))


def clusters_of(
    poses: PoseTable, rows: NDArray[np.int64], centres: NDArray[np.float32]
) -> NDArray[np.int32]:
    """(n,) cluster of each pose: the standing one if it stands, else that of the nearest centre."""
    cluster = 1 + nearest_centre(poses.features[rows], centres[1:])
    cluster[poses.is_standing()[rows]] = 0
    return cluster


def compare(
    ends: Ends,
    cluster: NDArray[np.int32],
    targets: NDArray[np.float64],
    frames: int,
    near: tuple[float, float],
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Compare where people were with where the options of their cluster end.

    Args:
        ends: the options.
        cluster: (n,) cluster of each person's pose.
        targets: (n, 3) where each person was ``frames`` frames later.
        frames: duration of the options to compare with.
        near: metres and radians.

    Returns:
        (n,) distance from the nearest end, infinite without options; (n,) whether an option ends
        within both limits.
    """
    error = np.full(len(cluster), np.inf)
    within = np.zeros(len(cluster), dtype=bool)
    for k in np.unique(cluster):
        rows = np.flatnonzero(cluster == k)
        options = np.arange(ends.offsets[k], ends.offsets[k + 1])
        x, y, heading = ends.places[options[ends.durations[options] == frames]].T
        if len(x) == 0:
            continue
        for block in np.array_split(rows, max(1, len(rows) * len(x) // 2_000_000)):
            distance = np.hypot(targets[block, 0, None] - x, targets[block, 1, None] - y)
            turn = targets[block, 2, None] - heading
            turn = np.abs((turn + np.pi) % (2 * np.pi) - np.pi)
            error[block] = distance.min(axis=1)
            within[block] = ((distance <= near[0]) & (turn <= near[1])).any(axis=1)
    return error, within


def figures(error: NDArray[np.float64], within: NDArray[np.bool_]) -> dict[str, Any]:
    """``poses``, ``endpoint_error_m`` and ``share_within_15cm_20deg``, as ``coverage`` gives."""
    median, p90, p95 = np.percentile(error, [50, 90, 95])
    return {
        "poses": len(error),
        "endpoint_error_m": {"median": float(median), "p90": float(p90), "p95": float(p95)},
        "share_within_15cm_20deg": float(within.mean()),
    }


def coverage(map_: MobilityMap, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Compare each pose's 45-frame options with the person's recorded place 45 frames later.

    Each pose followed by at least 45 frames gets the cluster that the
    map would assign: the standing cluster if it stands, else the one with the nearest centre.

    Args:
        map_: the map under test.
        recordings: clips at 30 Hz that should not be among those the map was built from.

    Returns:
        ``poses``; ``endpoint_error_m`` with ``median``, ``p90``, ``p95`` of the distance from the
        nearest option's end point; ``share_within_15cm_20deg``, the share of poses with an
        option that ends within both.

    Raises:
        MapError: no pose has 45 frames to come, or the map has no options of 45 frames.
    """
    poses = pose_table(recordings)
    done = movements(poses)
    places = np.column_stack([map_.end_points, map_.end_headings])
    cluster = clusters_of(poses, done.rows, map_.centres)
    ends = Ends(map_.offsets, map_.durations, places)
    error, within = compare(ends, cluster, done.paths[:, -1], HORIZON, NEAR)
    if not np.isfinite(error).any():
        raise MapError("the map has no options of 45 frames: nothing to compare")
    return figures(error, within)
