"""Has an evacuation stalled?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.jit import called

STALL_SECONDS = 60.0
"""An evacuation has stalled when for so long nobody left and nobody came nearer to an exit."""

STALL_PROGRESS = 1.0
"""Metres of route, summed over everybody, that count as coming nearer."""


class StallWatch:
    """Watches people inside and the way they still have to go."""

    def __init__(self) -> None:
        self._since = 0.0
        self._mark: tuple[int, int, int, float] = (-1, 0, 0, 0.0)

    def stalled(self, frame: int, rows: NDArray[np.int64], crowd: Crowd, crossed: int) -> bool:
        """Whether nothing has got better for a minute.

        Args:
            frame: now.
            rows: (n,) the people inside.
            crowd: the crowd.
            crossed: gates that people have crossed on their journeys so far.
        """
        elapsed = frame * FRAME_SECONDS
        ways = np.empty(len(rows))
        found, awaited = _ways_left(rows, frame, crowd.records, crowd.agenda, ways)
        now, left = (len(rows), found, crossed), float(np.add.reduce(ways[:found]))
        # Others may stand because of somebody who is yet to set off. More way to go is news as
        # well: a door closed, and people are on another way.
        if awaited or now != self._mark[:3] or abs(left - self._mark[3]) > STALL_PROGRESS:
            self._since, self._mark = elapsed, (*now, left)
        return len(rows) > 0 and elapsed - self._since >= STALL_SECONDS - 1e-9


@called()
def _ways_left(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    ways: NDArray[np.float64],
) -> tuple[int, bool]:
    """Write the ways left of those in ``rows`` who have one, metres.

    Returns their number, and whether somebody waits.
    """
    found, awaited = 0, False
    for i in rows:
        ways[found] = state[i].route
        found += int(abs(state[i].route) < np.inf)
        awaited = awaited or agenda[i]["waits_until"] > frame
    return found, awaited
