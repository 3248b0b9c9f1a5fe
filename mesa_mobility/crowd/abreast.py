"""Many people at a corner: those behind pass it farther out.

The shortest way round a corner touches it, for everybody.  Were that where they all go, a crowd in
a wide hall would queue along the inner wall for a single place.  So somebody passes as far out as
those before it take up: at ``CAPACITY`` they need so much width to be through when it arrives.
Whoever is alone cuts the corner.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state import NO_CORNER, Crowd
from mesa_mobility.crowd.target_choice import Deciding
from mesa_mobility.floorplan import Targets

CAPACITY = 1.22
"""People a second and metre of width at most (Weidmann, IVT Schriftenreihe 90, 1993)."""


def keep_abreast(deciding: Deciding, targets: Targets, crowd: Crowd) -> NDArray[np.float64]:
    """(n, 2) what those who decide aim at, with regard to who passes their corners before them.

    Args:
        deciding: the pedestrians; their ways left to go are set.
        targets: the shortest ways.
        crowd: the crowd; is told which corner each goes for.
    """
    rows = deciding.pedestrians
    if targets.corners is None:
        return targets.points
    crowd.agenda["corner"][rows] = targets.corners[:, 0]
    bent = np.flatnonzero(targets.corners[:, 0] != NO_CORNER)
    if len(bent) == 0:
        return targets.points
    inside = deciding.inside.pedestrians
    bound = inside[crowd.agenda["corner"][inside] != NO_CORNER]
    corner = crowd.agenda["corner"][bound]
    order = np.lexsort((crowd.route[bound], corner))
    sorted_corner = corner[order]
    before = np.empty(len(bound), dtype=np.int64)
    before[order] = np.arange(len(bound)) - np.searchsorted(sorted_corner, sorted_corner)
    ahead = before[np.searchsorted(bound, rows[bent])]
    # The width is what CAPACITY needs in the time it takes to walk there.
    areas = np.zeros(len(rows))
    areas[bent] = ahead * crowd.agenda["speed"][rows[bent]] / CAPACITY
    return deciding.site.abreast(deciding.positions, targets, areas)
