"""What is looked up of everybody once a step: all at once, while a record is at hand."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.jit import Entry, called
from mesa_mobility.threads import by_blocks


class Overview(NamedTuple):
    """What the people inside are about.

    Fields: how many ``people`` they are; the sum of their ``speeds``, m/s, each the mean of the
    movement under way; how many have a way to go (``going``), and metres that these have ``left``,
    all together; how many are ``awaited``: they wait.
    """

    people: int
    speeds: float
    going: int
    left: float
    awaited: int


NOBODY = Overview(0, 0.0, 0, 0.0, 0)


def look_over(
    rows: NDArray[np.int64], frame: int, crowd: Crowd, positions: NDArray[np.float64]
) -> Overview:
    """Look over those in ``rows`` and write to ``positions`` (n, 2) where they are, metres."""

    def block(first: int, last: int) -> Overview:
        some, places = rows[first:last], positions[first:last]
        return Overview(last - first, *_look_over(some, frame, crowd.records, crowd.agenda, places))

    found = by_blocks(block, len(rows))
    return found[0] if len(found) == 1 else Overview(*map(sum, zip(*found, strict=True)))


@Entry
@called()
def _look_over(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
) -> tuple[float, int, float, int]:
    """Write places; returns all but the number of people as ``Overview`` has it."""
    speeds, going, left, awaited = 0.0, 0, 0.0, 0
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        speeds += math.sqrt(state[i].vx * state[i].vx + state[i].vy * state[i].vy)
        if abs(state[i].route) < np.inf:
            going += 1
            left += state[i].route
        awaited += int(agenda[i]["waits_until"] > frame)
    return speeds, going, left, awaited


@Entry
@called()
def sort_out(
    rows: NDArray[np.int64],
    state: CrowdState,
    stay: NDArray[np.int64],
    places: NDArray[np.int64],
) -> int:
    """Write those in ``rows`` to ``stay`` who are in the model, and where in ``rows`` the others
    are to ``places``; returns how many others there are."""
    count = 0
    for k in range(len(rows)):
        stay[k - count], places[count] = rows[k], k
        count += int(not state[rows[k]].active)
    return count
