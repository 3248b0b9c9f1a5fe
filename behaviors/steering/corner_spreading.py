"""Corner spreading: in a crowd, those behind pass a corner farther out.

The shortest route round a corner touches it.  If everybody took that route, a crowd in a wide hall
would queue along the inner wall for a single place.  So each pedestrian passes the corner at a
distance that leaves room for the people ahead: the width that these need, at ``CAPACITY``, to be
through when the pedestrian arrives.  A person who is alone cuts the corner.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Tactic, Targets
from mesa_mobility.steering import Crowd, CrowdState, kept

CAPACITY = 1.22
"""Capacity of a level way, people a second and metre of width
(Weidmann, IVT Schriftenreihe 90, 1993)."""


def spread_at_corners(deciding: Deciding, targets: Targets, crowd: Crowd) -> NDArray[np.float64]:
    """(n, 2) targets in metres that leave room for those who pass the same corner earlier.

    Args:
        deciding: the pedestrians; the lengths of their routes are set.
        targets: those of the shortest routes.
        crowd: the crowd; its agenda gets the next corner of each.
    """
    if targets.corners is None:
        return targets.points
    areas = np.zeros(len(deciding.pedestrians))
    bent = _areas(
        deciding.pedestrians,
        targets.nearest_first,
        deciding.site.corners.shared(targets.corners),
        deciding.inside.pedestrians,
        crowd.records,
        crowd.agenda,
        areas,
    )
    return deciding.site.abreast(deciding.positions, targets, areas) if bent else targets.points


@kept(nogil=True)
def _areas(
    rows: NDArray[np.int64],
    nearest_first: NDArray[np.intp],
    corners: NDArray[np.int64],
    inside: NDArray[np.int64],
    state: CrowdState,
    agenda: NDArray[np.void],
    areas: NDArray[np.float64],
) -> bool:
    """Write the next corner of those in ``rows`` to the agenda; returns whether there is any.

    Writes to ``areas`` (n,) in m2 the width that people ahead need at ``CAPACITY``, times the
    distance to the corner.
    """
    last = -1
    for k in range(len(rows)):
        agenda[rows[k]]["corner"] = corners[k, 0]
        last = max(last, corners[k, 0])
    # Corner by corner, deciding pedestrians in order of route length.
    first = np.zeros(last + 2, np.int64)
    for k in range(len(rows)):
        first[corners[k, 0] + 1] += 1
    first[0] = 0
    for corner in range(last + 1):
        first[corner + 1] += first[corner]
    queue = np.empty(first[last + 1], np.int64)
    fill = first.copy()
    for k in nearest_first:
        corner = corners[k, 0]
        if corner >= 0:
            queue[fill[corner]] = k
            fill[corner] += 1
    behind = np.zeros(len(queue), np.int64)
    for i in inside:
        corner = agenda[i]["corner"]
        if corner < 0 or corner > last:
            continue
        # The first who is behind this one; the row decides between equal lengths.
        low, high = first[corner], first[corner + 1]
        while low < high:
            middle = (low + high) // 2
            j = rows[queue[middle]]
            if state[j].route > state[i].route or (state[j].route == state[i].route and j > i):
                high = middle
            else:
                low = middle + 1
        if low < first[corner + 1]:
            behind[low] += 1
    for corner in range(last + 1):
        ahead = 0
        for at in range(first[corner], first[corner + 1]):
            ahead += behind[at]
            k = queue[at]
            areas[k] = ahead * agenda[rows[k]]["speed"] / CAPACITY
    return last >= 0


class SpreadAtCorners(Tactic):
    """In a crowd, those behind pass a corner farther out."""

    name = "corner_spreading"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change the points of those who pass a corner after others."""
        points = spread_at_corners(deciding, desired.targets, deciding.inside.crowd)
        spread = (points != desired.targets.points).any(axis=1)
        if spread.any():
            desired.points = np.where(spread[:, None], points, desired.points)
