"""People make way for somebody who is steered by hand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state.records import Crowd

SECONDS_AHEAD = 2.0
"""Others make way as far ahead of a steered person as they get in this time."""

ROOM = 0.3
"""Metres between two bodies that pass each other."""

STEP = 0.5
"""Metres by which somebody aims beyond what is needed."""

BRISK = 0.8
"""Least speed of those who make way, m/s."""

_SLOWEST = 0.1
"""Nobody makes way for people slower than this, m/s, nor for those whom they outpace by it."""


def step_aside(
    rows: NDArray[np.int64],
    steered: NDArray[np.int64],
    velocities: NDArray[np.float64],
    crowd: Crowd,
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Who steps aside, and where to.

    People in the way of a steered person, who do not walk away as fast, step to the side on which
    they already are. Somebody right in the middle steps to the steered person's left.

    Args:
        rows: (n,) people who decide.
        steered: (k,) people who are steered.
        velocities: (k, 2) as they are steered, m/s.
        crowd: the crowd.

    Returns:
        (m,) indices among ``rows`` of those who step aside, and (m, 2) points that they go to,
        metres.
    """
    speed = np.hypot(velocities[:, 0], velocities[:, 1])
    moving = speed >= _SLOWEST
    if not moving.any():
        return np.empty(0, dtype=np.intp), np.empty((0, 2))
    steered, speed = steered[moving], speed[moving]
    along = velocities[moving] / speed[:, None]
    dx = crowd.x[rows][:, None] - crowd.x[steered]
    dy = crowd.y[rows][:, None] - crowd.y[steered]
    ahead = dx * along[:, 0] + dy * along[:, 1]
    aside = dy * along[:, 0] - dx * along[:, 1]
    away = crowd.vx[rows][:, None] * along[:, 0] + crowd.vy[rows][:, None] * along[:, 1]
    width = crowd.core[rows][:, None] + crowd.core[steered] + ROOM
    in_the_way = (
        (ahead > 0.0)
        & (ahead < width + SECONDS_AHEAD * speed)
        & (abs(aside) < width)
        & (away < speed - _SLOWEST)
    )
    who = np.flatnonzero(in_the_way.any(axis=1))
    # Of several the nearest.
    whom = np.where(in_the_way, ahead, np.inf)[who].argmin(axis=1)
    side = np.where(aside[who, whom] >= 0.0, 1.0, -1.0)
    left = np.column_stack([-along[whom, 1], along[whom, 0]])
    far = (width[who, whom] - abs(aside[who, whom]) + STEP) * side
    points = np.column_stack([crowd.x[rows[who]], crowd.y[rows[who]]]) + far[:, None] * left
    return who, points
