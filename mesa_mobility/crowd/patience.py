"""Impatience: whoever gets nowhere for a while looks for a way round.

Two people who want the same place and each stand in the other's way could do so for ever, as
each does what is best for it.  Real people do not: Helbing, Farkas and Vicsek (Nature 407, 2000)
let the fluctuations of a person's direction grow with its nervousness, which is how far it
falls short of its speed.  So here: the direction of whoever has come no nearer for some seconds
is turned by a random angle, which is larger the longer it has waited.  Whoever stands because it
was told to, or has not set off yet, is patient.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.state import Crowd

GETTING_NEARER = 0.25
"""Metres that somebody must come nearer to count as getting on."""

ANOTHER_WAY = 2.0
"""Metres by which the way grows only if it is another one: to another gate or exit."""

PATIENCE = 5.0
"""Seconds without getting on until somebody grows impatient."""

RATE, MOST = 0.1, 1.5
"""Standard deviation of the angle: radians a second of impatience, and at most."""


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
    agenda, route = crowd.agenda, crowd.route[rows]
    nearest = agenda["nearest"][rows]
    on = (route < nearest - GETTING_NEARER) | (route > nearest + ANOTHER_WAY) | ~np.isfinite(route)
    agenda["nearest"][rows] = np.where(on, route, nearest)
    agenda["since"][rows] = np.where(on, elapsed, agenda["since"][rows])
    free = agenda["waits_until"][rows] * FRAME_SECONDS
    overdue = elapsed - np.maximum(agenda["since"][rows], free) - PATIENCE
    impatient = overdue > 0.0
    who = rows[impatient]
    if len(who) == 0:
        return
    angle = rng.normal(0.0, np.minimum(RATE * overdue[impatient], MOST))
    c, s = np.cos(angle), np.sin(angle)
    dx, dy = crowd.target_x[who] - crowd.x[who], crowd.target_y[who] - crowd.y[who]
    crowd.target_x[who] = crowd.x[who] + c * dx - s * dy
    crowd.target_y[who] = crowd.y[who] + s * dx + c * dy
