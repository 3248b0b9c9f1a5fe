"""Many people at a corner: those behind pass it farther out.

The shortest way round a corner touches it, for everybody.  Were that where they all go, a crowd in
a wide hall would queue along the inner wall for a single place.  So somebody passes as far out as
those before it take up: at ``CAPACITY`` they need so much width to be through when it arrives.
Whoever is alone cuts the corner.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.crowd.target_choice import Deciding
from mesa_mobility.floorplan import Targets
from mesa_mobility.jit import Entry

CAPACITY = 1.22
"""People a second and metre of width at most (Weidmann, IVT Schriftenreihe 90, 1993)."""


def keep_abreast(deciding: Deciding, targets: Targets, crowd: Crowd) -> NDArray[np.float64]:
    """(n, 2) what those who decide aim at, with regard to who passes their corners before them.

    Args:
        deciding: the pedestrians; their ways left to go are set.
        targets: the shortest ways.
        crowd: the crowd; is told which corner each goes for.
    """
    if targets.corners is None:
        return targets.points
    areas = np.zeros(len(deciding.pedestrians))
    bent = _areas(
        deciding.pedestrians, targets.nearest_first, targets.corners, deciding.inside.pedestrians,
        crowd.records, crowd.agenda, areas,
    )  # fmt: skip
    return deciding.site.abreast(deciding.positions, targets, areas) if bent else targets.points


@Entry
@njit(cache=True, nogil=True)
def _areas(
    rows: NDArray[np.int64],
    nearest_first: NDArray[np.intp],
    corners: NDArray[np.int64],
    inside: NDArray[np.int64],
    state: CrowdState,
    agenda: NDArray[np.void],
    areas: NDArray[np.float64],
) -> bool:
    """Note which of (n, 2) corners people in ``rows`` go for, and whether there are any.

    Writes to ``areas`` (n,) what those who pass its corner before each take up, m2 a metre of its
    distance: the width that ``CAPACITY`` needs in the time that it takes to walk there.
    """
    last = -1
    for k in range(len(rows)):
        agenda[rows[k]]["corner"] = corners[k, 0]
        last = max(last, corners[k, 0])
    # Corner by corner, those who decide in the order of their ways.
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
        # The first who has this one before it; of equal ways the row tells.
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
