"""Standing and turning on the spot for recordings that do not show it: those of another map.

Without standing, people cannot wait or set off from rest; without turns on the spot, they stay in
a corner for ever. Turns and steps count only as far as they are gentle: a crowd's default rules
leave out options that start abruptly, as those of people who run mostly do.

Where nobody stands, the other map gives its standing cluster with all options from there. Each
cluster gets the options that end in it, from the pose most alike that has such options; so it does
where people stand but options do not lead back to that. Where they do not turn on the spot, the
other map gives its turns, and where they do not step aside either way and back, its steps. Strides
are shortened to the borrower's speed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.clusters import STANDING, Clusters, nearest_centre
from mesa_mobility.mobility.edits import Edit, edit_paths
from mesa_mobility.mobility.map_data import MapData
from mesa_mobility.mobility.paths import DURATIONS, MOST_JUMPS, SAMPLE_EVERY, ReachableOptions
from mesa_mobility.mobility.standing.accelerations import is_gentle
from mesa_mobility.mobility.standing.ways_back import ON_THE_SPOT, TURN, leads_back

STANDING_STILL, STOPPING, TURNING = "standing", "stopping", "turning on the spot"
STEPPING = "steps aside and back"
"""What can be missing, and is then borrowed."""

STEP = 0.28
"""Metres of a step aside or back, as wide as a body's core: without it people who stand close
together, or at a wall beside a door, never get loose."""


def missing(options: ReachableOptions, clusters: Clusters) -> tuple[str, ...]:
    """What options lack: standing, a way to stop from each cluster, turns and steps of standers."""
    if not clusters.sizes[STANDING]:
        return (STANDING_STILL,)
    last = options.durations // SAMPLE_EVERY - 1
    rows = np.arange(len(last))
    back = leads_back(options.offsets, options.path_clusters[rows, last], STANDING)
    lacks = [] if back.all() else [STOPPING]
    rows = rows[: options.offsets[STANDING + 1]]
    longest, width = options.paths.shape[1:]
    flat = options.paths.reshape(-1, width)
    rows = rows[is_gentle(options.durations[rows], rows * longest, flat)]
    ends = options.paths[rows, last[rows]]
    turned = ends[_turns(ends), 2]
    if turned.max(initial=0.0) < TURN or turned.min(initial=0.0) > -TURN:
        lacks.append(TURNING)
    ahead, aside, _ = ends[_steps(ends)].T
    if max(-aside.max(initial=0.0), aside.min(initial=0.0), ahead.min(initial=0.0)) > -STEP:
        lacks.append(STEPPING)
    return tuple(lacks)


def _turns(ends: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Which of (m, 3) ends of options are turns on the spot."""
    return np.hypot(ends[:, 0], ends[:, 1]) <= ON_THE_SPOT


def _steps(ends: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Which of (m, 3) ends of options are steps aside or back."""
    return (ends[:, 0] <= np.abs(ends[:, 1])) & (np.abs(ends[:, 2]) <= TURN)


def borrow(
    options: ReachableOptions, clusters: Clusters, lender: MapData
) -> tuple[ReachableOptions, Clusters]:
    """Add what the standing cluster lacks from another map.

    Args:
        options: those of all clusters; the standing one may have none.
        clusters: the clusters.
        lender: the map that gives its own.

    Returns:
        Options and clusters with a standing cluster whose people turn on the spot.
    """
    lacks = missing(options, clusters)
    stands = STANDING_STILL not in lacks
    stride = _stride(clusters, lender)
    stops = np.logical_or.reduceat(lender.end_clusters == lender.standing, lender.offsets[:-1])
    stops[lender.standing] = False
    who_stop = np.flatnonzero(stops)
    theirs = who_stop[nearest_centre(clusters.centres[1:], lender.centres[who_stop])]
    ours = np.concatenate(
        [[STANDING], 1 + nearest_centre(np.asarray(lender.centres[1:]), clusters.centres[1:])]
    ).astype(np.int32)
    parts, sizes = [], []
    for cluster, like in enumerate([lender.standing, *theirs.tolist()]):
        rows = np.asarray(lender.options_of(like))
        if cluster != STANDING:
            stopping = lender.end_clusters[rows] == lender.standing
            rows = rows[stopping & (STOPPING in lacks or not stands)]
        elif stands:
            ends = np.column_stack([lender.end_points[rows], lender.end_headings[rows]])
            turns = _turns(ends) & (np.abs(ends[:, 2]) >= TURN)
            steps = _steps(ends) & ends[:, :2].any(axis=1)
            rows = rows[(turns & (TURNING in lacks)) | (steps & (STEPPING in lacks))]
        own = np.arange(options.offsets[cluster], options.offsets[cluster + 1])
        parts += [_taken(options, own), _borrowed(lender, rows, ours, stride)]
        sizes.append(len(own) + len(rows))
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    joined = ReachableOptions(np.concatenate([[0], np.cumsum(sizes)]), *columns)
    return joined, clusters if stands else _standing_as(clusters, lender)


def _stride(clusters: Clusters, lender: MapData) -> float:
    """Speed of the moving poses of the one over that of the other, at most 1."""
    own, other = (
        float(np.average(each.mean_speeds[1:], weights=each.sizes[1:]))
        for each in (clusters, lender)
    )
    return min(1.0, own / other)


def _borrowed(
    lender: MapData, rows: NDArray[np.integer], ours: NDArray[np.int32], stride: float
) -> tuple[NDArray, ...]:
    samples = lender.durations[rows].astype(np.int64) // SAMPLE_EVERY
    longest = DURATIONS[-1] // SAMPLE_EVERY
    present = np.arange(longest) < samples[:, None]
    at = np.minimum(lender.path_offsets[rows][:, None] + np.arange(longest), len(lender.paths) - 1)
    paths = edit_paths(lender.paths[at], Edit(0.0, stride)) * present[..., None]
    clusters = np.where(present, ours[lender.path_clusters[at]], 0)
    return (
        lender.durations[rows],
        lender.costs[rows],
        paths.astype(np.float32),
        clusters.astype(np.int32),
        np.full(len(rows), -1, dtype=np.int32),
        np.full((len(rows), MOST_JUMPS), -1, dtype=np.int64),
        np.zeros(len(rows), dtype=np.int16),
    )


def _taken(options: ReachableOptions, rows: NDArray[np.integer]) -> tuple[NDArray, ...]:
    columns = (options.durations, options.costs, options.paths, options.path_clusters)
    marks = (options.sources, options.jumps, options.edits)
    return tuple(column[rows] for column in (*columns, *marks))


def _standing_as(clusters: Clusters, lender: MapData) -> Clusters:
    centres, joints = clusters.centres.copy(), clusters.mean_joints.copy()
    sizes, speeds = clusters.sizes.copy(), clusters.mean_speeds.copy()
    centres[STANDING] = lender.centres[lender.standing]
    joints[STANDING] = lender.mean_poses[lender.standing]
    sizes[STANDING] = lender.sizes[lender.standing]
    speeds[STANDING] = lender.mean_speeds[lender.standing]
    return replace(clusters, centres=centres, mean_joints=joints, sizes=sizes, mean_speeds=speeds)
