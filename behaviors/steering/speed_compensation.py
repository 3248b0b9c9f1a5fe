"""Speed compensation: free walkers correct their accumulated distance error.

Recordings have steps of certain lengths, hardly ever one of exactly the preferred speed.  The
option of least cost is more often a little too long than too short, since progress is worth
something.  So free walkers keep account of how far they are ahead or behind, and make up for it in
their next movements.  On average everybody walks at their own preferred speed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Tactic
from mesa_mobility.steering import (
    FRAME_SECONDS,
    LONGEST_MOVEMENT_S,
    NO_OPTION,
    Crowd,
    CrowdState,
    compiled,
)

FREELY = 0.2
"""A walker at most so much slower or faster than their preferred speed walks freely, m/s.

Somebody slower is held up.  People who sway about their course, and those whose recordings lack the
speed, are off by less.
"""

MOST = 0.25
"""Greatest distance error that is kept, metres."""

MAKES_UP = LONGEST_MOVEMENT_S
"""Seconds in which the error is corrected: the longest movement."""


def compensate_speed(
    rows: NDArray[np.int64], crowd: Crowd, speeds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Preferred speeds that correct the accumulated distance error.

    Args:
        rows: (n,) the pedestrians who decide.
        crowd: the crowd; its agenda gets their preferred speeds and distance errors.
        speeds: (n,) preferred speeds, m/s.

    Returns:
        (n,) m/s, within ``MOST / MAKES_UP`` of ``speeds``; unchanged for those who could not walk
        freely or want to stand.  Whoever makes up for an error may be faster or slower than
        preferred by as much, and still walks freely.
    """
    kept = np.empty(len(rows))
    _keep_pace(rows, speeds, crowd.records, crowd.agenda, kept)
    return kept


@compiled()
def _keep_pace(
    rows: NDArray[np.int64],
    speeds: NDArray[np.float64],
    state: CrowdState,
    agenda: NDArray[np.void],
    kept: NDArray[np.float64],
) -> None:
    for k in range(len(rows)):
        i = rows[k]
        seconds = (state[i].end - state[i].start) * FRAME_SECONDS
        x, y = state[i].to_x - state[i].from_x, state[i].to_y - state[i].from_y
        tx, ty = state[i].target_x - state[i].from_x, state[i].target_y - state[i].from_y
        walked, away = math.hypot(x, y), math.hypot(tx, ty)
        if walked < away:
            walked = (x * tx + y * ty) / away
        short = agenda[i]["desired_speed"] * seconds - walked
        behind, correction = 0.0, agenda[i]["behind"] / MAKES_UP
        least = (min(correction, 0.0) - FREELY) * seconds
        most = (max(correction, 0.0) + FREELY) * seconds
        if state[i].option > NO_OPTION and least <= -short <= most:
            behind = min(max(agenda[i]["behind"] + short, min(-MOST, short)), MOST)
        agenda[i]["behind"], agenda[i]["desired_speed"] = behind, speeds[k]
        kept[k] = max(speeds[k] + behind / MAKES_UP, 0.0) if speeds[k] > 0.0 else speeds[k]


class CompensateSpeed(Tactic):
    """Free walkers correct their accumulated distance error."""

    name = "speed_compensation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change the speeds of free walkers by little."""
        desired.speeds = compensate_speed(
            deciding.pedestrians, deciding.inside.crowd, desired.speeds
        )
