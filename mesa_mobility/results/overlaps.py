"""Bodies that overlap, counted over finished trajectories by SciPy's k-d tree."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.buildings.headroom import HEADROOM_M
from mesa_mobility.results.measures.sites import Site
from mesa_mobility.results.trajectories import Trajectories

# Rounding of floats may bring two bodies that just touch this much closer, metres.
TOLERANCE_M = 1e-5
# Overlaps, or wall crossings, that a report lists individually, at most.
NAMED = 10


@dataclass(frozen=True)
class Overlap:
    """Two bodies that overlap in one frame; distance between their positions in metres.

    ``at`` is where the first of them is.
    """

    frame: int
    first: int
    second: int
    distance_m: float
    at: Site | None = field(default=None, compare=False)


def count_overlaps(trajectories: Trajectories) -> tuple[int, list[Overlap], float | None]:
    """Pairs of people closer than the sum of their core radii, over all frames.

    People above each other, on different storeys or flights, are no pair.

    Returns:
        Their number, the first few of them, and the smallest distance between the positions of two
        people in any frame, metres; None when two people were never inside together.
    """
    offsets = trajectories.frame_offsets
    positions = np.column_stack((trajectories.x, trajectories.y))
    radii, z = trajectories.radii, trajectories.z
    reach = 2.0 * float(radii.max(initial=0.0))
    count, named, nearest = 0, list[Overlap](), np.inf
    for frame in range(trajectories.frames):
        rows = slice(offsets[frame], offsets[frame + 1])
        if rows.stop - rows.start < 2:
            continue
        points, people = positions[rows], trajectories.person[rows]
        tree = cKDTree(points)
        if not np.isfinite(nearest):
            nearest = _nearest(tree, points, z[rows])
        # Ignore people who are neither within reach nor nearer than the nearest pair so far.
        a, b = _pairs(tree, z[rows], max(reach, nearest) if np.isfinite(nearest) else reach)
        if not len(a):
            continue
        distance = np.hypot(*(points[a] - points[b]).T)
        nearest = min(nearest, float(distance.min()))
        gaps = distance - radii[people[a]] - radii[people[b]]
        close = np.flatnonzero(gaps < -TOLERANCE_M)
        count += len(close)
        for k in close[: NAMED - len(named)] if len(named) < NAMED else ():
            pair = sorted((int(people[a[k]]), int(people[b[k]])))
            named.append(Overlap(frame, pair[0], pair[1], float(distance[k])))
    return count, named, float(nearest) if np.isfinite(nearest) else None


def _pairs(
    tree: cKDTree, z: NDArray[np.float64], radius: float
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of points at most ``radius`` apart on one storey or flight, as two arrays (k,)."""
    a, b = tree.query_pairs(radius, output_type="ndarray").T
    beside = np.abs(z[a] - z[b]) < HEADROOM_M
    return a[beside], b[beside]


def _nearest(tree: cKDTree, points: NDArray[np.float64], z: NDArray[np.float64]) -> float:
    """Least distance in metres of two of the points (n, 2) on one storey; inf if there is none."""
    radius, extent = (
        float(tree.query(points, k=2)[0][:, 1].min()),
        float(np.hypot(*np.ptp(points, axis=0))),
    )
    while True:
        a, b = _pairs(tree, z, radius)
        if len(a):
            return float(np.hypot(*(points[a] - points[b]).T).min())
        if radius > extent:
            return np.inf
        # The nearest are above each other.
        radius = 2.0 * max(radius, HEADROOM_M / 10.0)
