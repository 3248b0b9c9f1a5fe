"""Who decides in a frame, and in which order.

People decide when their movement has ended, one after the other. In a queue those nearest to their
destination decide first, which frees space for those behind.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.state.advance import LONG_AFTER, next_event
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan import Targets


def due(rows: NDArray[np.int64], frame: int, state: CrowdState) -> tuple[NDArray[np.int64], int]:
    """The people in ``rows`` whose movement has ended by ``frame``.

    Returns their rows, in the order of ``rows``, and the next frame in which a movement of the
    others ends or one of them leaves.
    """
    found = np.empty_like(rows)
    count, soonest = select_due(rows, frame, state, found)
    return found[:count], soonest


def decision_order(deciding: NDArray[np.int64], targets: Targets) -> NDArray[np.int64]:
    """The people in ``deciding`` in rising order of the length of their route.

    Of equal lengths the first in ``deciding`` comes first.

    Args:
        deciding: (n,) rows of the people who decide.
        targets: their targets.
    """
    return deciding[targets.nearest_first]


@entry_point()
def select_due(
    active: NDArray[np.int64], frame: int, state: CrowdState, found: NDArray[np.int64]
) -> tuple[int, int]:
    """Write the rows of those in ``active`` whose movement has ended by ``frame``.

    Returns their number, and the next frame in which a movement of the others ends or one of them
    leaves.
    """
    count, soonest = 0, LONG_AFTER
    for i in active:
        found[count] = i
        if state.end[i] <= frame:
            count += 1
        else:
            soonest = min(soonest, next_event(i, frame, state))
    return count, soonest
