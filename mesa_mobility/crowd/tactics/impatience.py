"""Impatience: people who make no progress look for a way round.

Two people who block each other would do so for ever if each did only what is best for itself.
Helbing, Farkas and Vicsek (Nature 407, 2000) let the fluctuations of a person's direction grow
with its nervousness, the share by which it falls short of its preferred speed.  Here, the target
of a person that has made no progress for some seconds is now and then turned by a random angle.
The angle grows with the time without progress.  People who have not set off, or who wait on
purpose, stay patient, and so do slow people who get on as fast as they want.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.settling import settle
from mesa_mobility.crowd.tactics.tactic import Tactic

GETTING_NEARER = 0.25
"""Metres that somebody must come nearer for it to count as progress."""

ANOTHER_WAY = 2.0
"""Metres by which a route grows only if it becomes another one, to another gate or exit."""

PATIENCE = 5.0
"""Seconds without progress until somebody grows impatient."""

SLOW_PATIENCE = 2.0
"""For slow people, how many times as long as the progress takes at the speed that they want."""

RATE, MOST = 0.1, 0.5
"""Standard deviation of the angle: radians a second of impatience, and its maximum."""

LOOKS = 0.15
"""Share of decisions in which an impatient person looks for a way round.  In the others it waits,
as people in a queue mostly do."""


def perturb_targets(
    rows: NDArray[np.int64], crowd: Crowd, elapsed: float, rng: np.random.Generator
) -> bool:
    """Rotate the targets of some impatient people about their positions; whether there are any.

    Args:
        rows: (n,) the deciding pedestrians; their targets and route lengths are set.
        crowd: the crowd.
        elapsed: seconds.
        rng: the model's generator.
    """
    who, spread = np.empty(len(rows), dtype=np.int64), np.empty(len(rows))
    count = _impatient(rows, elapsed, crowd.records, crowd.agenda, who, spread)
    if count == 0:
        return False
    count = pick(rng.random(count), who, spread)
    if count:
        turn(who, spread, rng.standard_normal(count), crowd.records)
    return count > 0


@entry_point()
def _impatient(
    rows: NDArray[np.int64],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    who: NDArray[np.int64],
    spread: NDArray[np.float64],
) -> int:
    """Record the progress of those in ``rows``; write who is impatient, and the standard deviation
    of its angle, radians.

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
        # Those who want to stand have no speed of their own, and those who wait are free later.
        wanted = agenda[i]["desired_speed"]
        patience = (
            max(PATIENCE, SLOW_PATIENCE * GETTING_NEARER / wanted) if wanted > 0.0 else PATIENCE
        )
        overdue = elapsed - max(agenda[i]["since"], free) - patience
        if overdue > 0.0:
            who[count], spread[count] = i, min(RATE * overdue, MOST)
            count += 1
    return count


@entry_point()
def pick(chances: NDArray[np.float64], who: NDArray[np.int64], spread: NDArray[np.float64]) -> int:
    """Move those who look for a way round to the front; returns their number.

    ``chances`` has a uniform random number in [0, 1) for each impatient person."""
    count = 0
    for k in range(len(chances)):
        who[count], spread[count] = who[k], spread[k]
        count += int(chances[k] < LOOKS)
    return count


@entry_point()
def turn(
    rows: NDArray[np.int64],
    spread: NDArray[np.float64],
    times: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Rotate the targets of the first people in ``rows`` by ``times * spread`` radians."""
    for k in range(len(times)):
        i, angle = rows[k], spread[k] * times[k]
        c, s = math.cos(angle), math.sin(angle)
        dx, dy = state[i].target_x - state[i].x, state[i].target_y - state[i].y
        state[i].target_x = state[i].x + c * dx - s * dy
        state[i].target_y = state[i].y + s * dx + c * dy


class Impatience(Tactic):
    """People who make no progress look for a way round."""

    name = "impatience"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of some who make no progress."""
        rows, crowd = deciding.pedestrians, deciding.inside.crowd
        settle(rows, desired.points, desired.speeds, crowd.records)
        if perturb_targets(rows, crowd, deciding.elapsed, deciding.rng):
            desired.points = np.column_stack([crowd.target_x[rows], crowd.target_y[rows]])

    def compile_ahead(self) -> None:
        """Compile the choice of another way."""
        nobody, nothing = np.empty(0, dtype=np.int64), np.empty(0)
        pick(nothing, nobody, nothing)
        turn(nobody, nothing, nothing, Crowd(2).records)
