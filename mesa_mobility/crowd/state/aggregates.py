"""Per-step crowd aggregates, in one pass over the records."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.compiled.threads import by_blocks
from mesa_mobility.crowd.state.records import Crowd, CrowdState


class Aggregates(NamedTuple):
    """Sums over the people inside.

    Attributes:
        people: number of people.
        speeds: sum of their speeds, m/s, each the mean of the movement under way.
        going: number of people with a route.
        awaited: number of people who wait.
    """

    people: int
    speeds: float
    going: int
    awaited: int


EMPTY = Aggregates(0, 0.0, 0, 0)


def aggregate(
    rows: NDArray[np.int64], frame: int, crowd: Crowd, positions: NDArray[np.float64]
) -> Aggregates:
    """Aggregate the people in ``rows`` and write their positions (n, 2), metres."""

    def block(first: int, last: int) -> Aggregates:
        some, places = rows[first:last], positions[first:last]
        return Aggregates(
            last - first, *_look_over(some, frame, crowd.records, crowd.agenda, places)
        )

    found = by_blocks(block, len(rows))
    return found[0] if len(found) == 1 else Aggregates(*map(sum, zip(*found, strict=True)))


@entry_point()
def _look_over(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
) -> tuple[float, int, int]:
    """Write positions; returns the fields of ``Aggregates`` after the first."""
    speeds, going, awaited = 0.0, 0, 0
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        speeds += math.sqrt(state[i].vx * state[i].vx + state[i].vy * state[i].vy)
        if abs(state[i].route) < np.inf:
            going += 1
        awaited += int(agenda[i]["waits_until"] > frame)
    return speeds, going, awaited


@entry_point()
def split_active(
    rows: NDArray[np.int64],
    state: CrowdState,
    stay: NDArray[np.int64],
    places: NDArray[np.int64],
) -> int:
    """Write the active ones of ``rows`` to ``stay``, and the indices in ``rows`` of the others to
    ``places``; returns the number of the others."""
    count = 0
    for k in range(len(rows)):
        stay[k - count], places[count] = rows[k], k
        count += int(not state[rows[k]].active)
    return count
