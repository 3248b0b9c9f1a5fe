"""Impatience: whoever gets nowhere for a while looks for a way round.

Two people who want the same place and each stand in the other's way could do so for ever, as
each does what is best for it.  Real people do not: Helbing, Farkas and Vicsek (Nature 407, 2000)
let the fluctuations of a person's direction grow with its nervousness, which is how far it
falls short of its speed.  So here: the direction of whoever has come no nearer for some seconds
is now and then turned by a random angle, which is larger the longer it has waited.  Whoever
stands because it was told to, or has not set off yet, is patient.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.jit import Entry, called

GETTING_NEARER = 0.25
"""Metres that somebody must come nearer to count as getting on."""

ANOTHER_WAY = 2.0
"""Metres by which the way grows only if it is another one: to another gate or exit."""

PATIENCE = 5.0
"""Seconds without getting on until somebody grows impatient."""

RATE, MOST = 0.1, 1.5
"""Standard deviation of the angle: radians a second of impatience, and at most."""

LOOKS = 0.15
"""Share of its decisions in which somebody impatient looks for a way round; in the others it
waits, as people in a queue mostly do."""


def look_around(
    rows: NDArray[np.int64], crowd: Crowd, elapsed: float, rng: np.random.Generator
) -> None:
    """Turn the targets of the impatient among those who decide about them.

    Args:
        rows: the pedestrians; their targets and ways left to go are set.
        crowd: the crowd.
        elapsed: seconds.
        rng: the model's generator.
    """
    who, spread = np.empty(len(rows), dtype=np.int64), np.empty(len(rows))
    count = _impatient(rows, elapsed, crowd.records, crowd.agenda, who, spread)
    if count == 0:
        return
    count = pick(rng.random(count), who, spread)
    if count:
        turn(who, spread, rng.standard_normal(count), crowd.records)


@Entry
@called()
def _impatient(
    rows: NDArray[np.int64],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    who: NDArray[np.int64],
    spread: NDArray[np.float64],
) -> int:
    """Note who in ``rows`` gets on, and write who is impatient and how far it may turn, radians.

    Returns the number of the impatient.
    """
    count = 0
    for i in rows:
        route = state[i].route
        nearest = agenda[i]["nearest"]
        if (
            route < nearest - GETTING_NEARER
            or route > nearest + ANOTHER_WAY
            or not abs(route) < np.inf
        ):
            agenda[i]["nearest"], agenda[i]["since"] = route, elapsed
        free = agenda[i]["waits_until"] * FRAME_SECONDS
        overdue = elapsed - max(agenda[i]["since"], free) - PATIENCE
        if overdue > 0.0:
            who[count], spread[count] = i, min(RATE * overdue, MOST)
            count += 1
    return count


@Entry
@called()
def pick(chances: NDArray[np.float64], who: NDArray[np.int64], spread: NDArray[np.float64]) -> int:
    """Bring those to the front who look for a way round, by a number of 0 to 1 for each of the
    impatient; returns how many do."""
    count = 0
    for k in range(len(chances)):
        who[count], spread[count] = who[k], spread[k]
        count += int(chances[k] < LOOKS)
    return count


@Entry
@called()
def turn(
    rows: NDArray[np.int64],
    spread: NDArray[np.float64],
    times: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Turn the targets of the first of those in ``rows`` about them, by so many ``times`` their
    ``spread``, radians."""
    for k in range(len(times)):
        i, angle = rows[k], spread[k] * times[k]
        c, s = math.cos(angle), math.sin(angle)
        dx, dy = state[i].target_x - state[i].x, state[i].target_y - state[i].y
        state[i].target_x = state[i].x + c * dx - s * dy
        state[i].target_y = state[i].y + s * dx + c * dy
