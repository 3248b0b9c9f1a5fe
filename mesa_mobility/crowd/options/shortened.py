"""Shortened options: a person that can take a step can also take a shorter one of the same kind.

Recorded people walk or stand, and few of them creep. In a jam everybody does. So the shortest
recorded options of each cluster are also offered in part, with a share of their ground and of their
turn, in the same time. A share of 0 stands on the spot and turns as the whole step does. What goes
on wheels always turns as the whole option does.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAME_SECONDS, Parts
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.poses import STANDING_SPEED, STANDING_TURN_RATE

CELL = (0.10, 0.10, np.deg2rad(15.0))
"""Cell of thinning: metres, metres, radians of the end point and end heading.

Headings are closer than among the options of a map: in a queue, turning is most of what people do.
"""


def with_shortened(
    mobility_map: MobilityMap, rows: NDArray[np.int64], shares: Sequence[Sequence[float]]
) -> Parts:
    """Options of a map, and shortened copies of the shorter options of each cluster.

    A copy that is no faster than standing ends in the standing cluster.  Of the copies of one
    cluster with similar ends, the one of least cost is kept, as the map's own options are thinned.

    Args:
        mobility_map: the map.
        rows: its options in use.
        shares: of the ground that a step covers, each from 0 to 1: first those of the shortest
            options of each cluster, then those of the next longer ones, and so on.
    """
    cluster = np.searchsorted(mobility_map.offsets, rows, side="right") - 1
    frames = mobility_map.durations[rows].astype(np.int64)
    more = int(frames.max(initial=0)) + 1
    # One number for cluster and duration: rows of two take ten times as long to sort.
    pairs, number = np.unique(more * cluster + frames, return_inverse=True)
    # 0 for the shortest duration of each cluster, 1 for the next, and so on.
    first = np.searchsorted(pairs // more, pairs // more)
    rank = (np.arange(len(pairs)) - first)[number.reshape(-1)]
    parts = [Parts(rows, np.ones(len(rows)), mobility_map.end_clusters[rows].astype(np.int64))]
    for wanted, of_rank in enumerate(shares):
        own = rank == wanted
        parts += [_shortened(mobility_map, rows[own], cluster[own], each) for each in of_rank]
    return Parts(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _shortened(
    mobility_map: MobilityMap, rows: NDArray[np.int64], cluster: NDArray[np.int64], share: float
) -> Parts:
    """Copies of options with one share, thinned within each cluster."""
    seconds = mobility_map.durations[rows] * FRAME_SECONDS
    x, y = mobility_map.end_points[rows].astype(np.float64).T
    turn = mobility_map.end_headings[rows].astype(np.float64)
    # Cells shrink with the steps, or those to the side and back would be lost among others.
    cells = [x / CELL[0], y / CELL[1]] if share > 0.0 else []
    cells = [np.floor(each + 0.5) for each in (*cells, turn / CELL[2])]
    order = np.lexsort((rows, mobility_map.costs[rows], *cells, cluster))
    key = np.column_stack([cluster, *cells])[order]
    kept = np.sort(order[np.append(True, (np.diff(key, axis=0) != 0).any(axis=1))[: len(rows)]])
    of_turn = 1.0 if mobility_map.on_wheels else share
    stands = (share * np.hypot(x, y) < STANDING_SPEED * seconds) & (
        (of_turn * abs(turn) < STANDING_TURN_RATE * seconds) | (share == 0.0)
    )
    ends_in = np.where(stands, mobility_map.standing, mobility_map.end_clusters[rows])
    return Parts(rows[kept], np.full(len(kept), share), ends_in[kept].astype(np.int64))
