"""How well a map covers people who are not in its recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.clusters import nearest_centre
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.poses import pose_table

HORIZON = 45
"""Frames: the paper's time step."""


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
    frames = np.concatenate(
        [np.arange(a, b - HORIZON) for a, b in zip(poses.first[:-1], poses.first[1:], strict=True)]
    ).astype(np.int64)
    if len(frames) == 0:
        raise MapError("no clip is longer than 45 frames: nothing to compare the map with")
    moved = poses.position[frames + HORIZON] - poses.position[frames]
    facing = poses.facing[frames]
    c, s = np.cos(facing), np.sin(facing)
    target = np.column_stack([c * moved[:, 0] + s * moved[:, 1], c * moved[:, 1] - s * moved[:, 0]])
    turned = poses.facing[frames + HORIZON] - facing

    cluster = 1 + nearest_centre(poses.features[frames], map_.centres[1:])
    cluster[poses.is_standing()[frames]] = map_.standing
    error = np.full(len(frames), np.inf)
    within = np.zeros(len(frames), dtype=bool)
    is_long = map_.durations == HORIZON
    ends, headings = map_.end_points, map_.end_headings
    for k in np.unique(cluster):
        rows = np.flatnonzero(cluster == k)
        options = np.asarray(map_.options_of(int(k)))
        options = options[is_long[options]]
        if len(options) == 0:
            continue
        for block in np.array_split(rows, max(1, len(rows) * len(options) // 2_000_000)):
            distance = np.hypot(
                target[block, 0, None] - ends[options, 0], target[block, 1, None] - ends[options, 1]
            )
            turn = turned[block, None] - headings[options]
            turn = np.abs((turn + np.pi) % (2 * np.pi) - np.pi)
            error[block] = distance.min(axis=1)
            within[block] = ((distance <= 0.15) & (turn <= np.deg2rad(20.0))).any(axis=1)
    if not np.isfinite(error).any():
        raise MapError("the map has no options of 45 frames: nothing to compare")
    median, p90, p95 = np.percentile(error, [50, 90, 95])
    return {
        "poses": len(frames),
        "endpoint_error_m": {"median": float(median), "p90": float(p90), "p95": float(p95)},
        "share_within_15cm_20deg": float(within.mean()),
    }
