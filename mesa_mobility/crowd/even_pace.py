"""Keeping an even pace: who has come a little farther than it likes takes a shorter step next.

A recording has steps of certain lengths, and hardly ever one of just the speed that somebody
prefers. The nearest by cost is a little too long more often than too short, since progress is
worth something. So whoever walks freely carries on what it is ahead or behind, and makes up for
it with its next movements: on average everybody walks at its own speed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.state import NO_OPTION, Crowd, CrowdState
from mesa_mobility.jit import Entry, called

FREELY = 0.1
"""Whoever is within so much of the speed that it prefers walks freely, m/s."""

MOST = 0.15
"""Most that anybody is ahead or behind, metres."""

MAKES_UP = 1.5
"""Seconds in which it makes up for that: the longest movement."""


def keep_pace(
    rows: NDArray[np.int64], crowd: Crowd, speeds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Speeds that make up for the ground won or lost in the movement that has just ended.

    Args:
        rows: (n,) the pedestrians who decide.
        crowd: the crowd; its agenda gets what they prefer and what they are behind.
        speeds: (n,) how fast they would like to go, m/s.

    Returns:
        (n,) m/s, within ``MOST / MAKES_UP`` of ``speeds``; the same where somebody could not walk
        freely or would rather stand.
    """
    kept = np.empty(len(rows))
    _keep_pace(rows, speeds, crowd.records, crowd.agenda, kept)
    return kept


@Entry
@called()
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
        walked = math.hypot(state[i].to_x - state[i].from_x, state[i].to_y - state[i].from_y)
        short = agenda[i]["wished"] * seconds - walked
        behind = 0.0
        if state[i].option > NO_OPTION and abs(short) <= FREELY * seconds:
            behind = min(max(agenda[i]["behind"] + short, -MOST), MOST)
        agenda[i]["behind"], agenda[i]["wished"] = behind, speeds[k]
        kept[k] = max(speeds[k] + behind / MAKES_UP, 0.0) if speeds[k] > 0.0 else speeds[k]
