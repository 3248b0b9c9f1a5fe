"""Data of a mobility map for the map view."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import MobilityMap
from mesa_mobility.dashboard.session.decision import BONES
from mesa_mobility.dashboard.session.serialization import packed
from mesa_mobility.mobility.map_data import SAMPLE_SECONDS

SPEED_STEP, FASTEST = 0.1, 2.2
"""Cells of the coverage: metres a second, and where they end."""

TURN_STEP, MOST_TURN = 15.0, 180.0
"""Cells of the coverage: degrees, and where they end on either side."""


def speeds_and_turns(
    mobility_map: MobilityMap, rows: slice
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of options: displacement over duration, m/s, and change of facing, degrees to the left."""
    ends = mobility_map.end_points[rows].astype(np.float64)
    seconds = mobility_map.durations[rows] * (SAMPLE_SECONDS / 3.0)
    turns = np.degrees(mobility_map.end_headings[rows].astype(np.float64))
    return np.hypot(ends[:, 0], ends[:, 1]) / seconds, turns


def coverage(mobility_map: MobilityMap, rows: slice = slice(None)) -> list[list[float]]:
    """[speed, turn, options] for each cell that has any: least speed and turn of the cell.

    Options beyond the last cells are counted in these.
    """
    speed, turn = speeds_and_turns(mobility_map, rows)
    speed_edges = np.arange(0.0, FASTEST + SPEED_STEP / 2, SPEED_STEP)
    turn_edges = np.arange(-MOST_TURN, MOST_TURN + TURN_STEP / 2, TURN_STEP)
    counts, _, _ = np.histogram2d(
        np.clip(speed, 0.0, FASTEST - 1e-9),
        np.clip(turn, -MOST_TURN, MOST_TURN - 1e-9),
        bins=(speed_edges, turn_edges),
    )
    return [
        [round(float(speed_edges[i]), 3), float(turn_edges[j]), int(counts[i, j])]
        for i, j in np.argwhere(counts > 0).tolist()
    ]


def clusters(mobility_map: MobilityMap) -> dict[str, list[float]]:
    """Columns with an entry for each cluster: mean speed (m/s), options, poses."""
    return {
        "mean_speed": np.round(mobility_map.mean_speeds.astype(np.float64), 4).tolist(),
        "options": np.diff(mobility_map.offsets).tolist(),
        "poses": mobility_map.sizes.tolist(),
    }


def cluster(mobility_map: MobilityMap, number: int) -> dict[str, Any]:
    """One cluster's options as its view draws them.

    Base64 float32: ``paths`` x, y of all samples, start included, ``offsets`` (n + 1,) rows of
    ``paths`` of each option, ``seconds`` (n,), ``costs`` (n,) in the motion graph.
    """
    rows = mobility_map.options_of(number)
    options = np.arange(rows.start, rows.stop)
    counts = np.diff(mobility_map.path_offsets)[options] + 1
    offsets = np.concatenate([[0], np.cumsum(counts)])
    first = mobility_map.path_offsets[options[0]]
    last = mobility_map.path_offsets[options[-1] + 1]
    paths = np.insert(
        mobility_map.paths[first:last, :2], mobility_map.path_offsets[options] - first, 0.0, axis=0
    )
    return {
        "number": number,
        "standing": number == mobility_map.standing,
        "poses": int(mobility_map.sizes[number]),
        "mean_speed": float(mobility_map.mean_speeds[number]),
        "options": len(options),
        "paths": packed(paths),
        "offsets": packed(offsets),
        "seconds": packed(mobility_map.durations[options] * (SAMPLE_SECONDS / 3.0)),
        "costs": packed(mobility_map.costs[options]),
        "pose": mobility_map.mean_poses[number].tolist(),
        "bones": BONES,
    }
