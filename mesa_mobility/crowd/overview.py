"""What is looked up of everybody once a step: all at once, while a record is at hand."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.jit import called
from mesa_mobility.threads import BRIEF, shares, together


class Overview(NamedTuple):
    """What the people inside are about.

    Fields: ``speeds`` (n,) mean speed of the movement under way of each, m/s; ``ways`` (m,) metres
    left to go of those who have a way; ``awaited``, whether any of them waits.
    """

    speeds: NDArray[np.float64]
    ways: NDArray[np.float64]
    awaited: bool


NOBODY = Overview(np.empty(0), np.empty(0), awaited=False)


def look_over(
    rows: NDArray[np.int64], frame: int, crowd: Crowd, positions: NDArray[np.float64]
) -> Overview:
    """Look over those in ``rows`` and write to ``positions`` (n, 2) where they are, metres."""
    n = len(rows)
    speeds, ways = np.empty(n), np.empty(n)

    def part(own: slice) -> tuple[int, bool]:
        return _look_over(
            rows[own], frame, crowd.records, crowd.agenda, positions[own], speeds[own], ways[own]
        )

    parts = shares(n, BRIEF)
    found = together(part, parts)
    if len(parts) == 1:
        ways = ways[: found[0][0]]
    else:
        own = [ways[each][:count] for each, (count, _) in zip(parts, found, strict=True)]
        ways = np.concatenate(own)
    return Overview(speeds, ways, any(awaited for _, awaited in found))


@called()
def _look_over(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
    speeds: NDArray[np.float64],
    ways: NDArray[np.float64],
) -> tuple[int, bool]:
    """Write places, speeds, and the ways left of those who have one; returns how many they are.

    And whether somebody waits.
    """
    found, awaited = 0, False
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        speeds[k] = math.hypot(state[i].vx, state[i].vy)
        ways[found] = state[i].route
        found += int(abs(state[i].route) < np.inf)
        awaited = awaited or agenda[i]["waits_until"] > frame
    return found, awaited
