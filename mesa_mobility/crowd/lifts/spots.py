"""Spots in the car of a lift, at which bodies of different sizes fit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan import Shaft

APART = 0.1
"""Metres between two bodies, and between a body and the walls: bodies sway by 3 to 12 cm."""

THERE = 0.15
"""Metres from their spot at which people stop."""

_STEP = 0.1
"""Metres from one place that is tried to the next."""


def free_spot(
    shaft: Shaft, stop: int, core: float, taken: NDArray[np.float64], cores: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """The place farthest from the door at which a body fits; None if it fits nowhere.

    Args:
        shaft: the lift.
        stop: where its car is.
        core: core radius of the body, metres.
        taken: (n, 2) places of others in the car, metres.
        cores: (n,) their core radii, metres.

    Returns:
        (2,) metres.
    """
    room = core + APART
    half = max(shaft.width / 2.0 - room, 0.0) if shaft.width >= 2.0 * core else -1.0
    if half < 0.0 or shaft.depth < 2.0 * core:
        return None
    into = shaft.into()
    across = np.array([into[1], -into[0]])
    last = max(shaft.depth - room, core)
    deep = last - _STEP * np.arange(int((last - min(room, last)) / _STEP + 1e-9) + 1)
    beside = _STEP * np.arange(int(half / _STEP + 1e-9) + 1)
    # From the sides to the middle, the back row first.
    aside = np.unique(np.concatenate([-beside, beside, [-half, half]]))
    tried = np.array(
        [(d, a) for d in deep for a in aside[np.argsort(-np.abs(aside), kind="stable")]]
    )
    origin = shaft.door(stop) + shaft.before * into
    places = origin + tried[:, :1] * into + tried[:, 1:] * across
    away = np.hypot(*np.moveaxis(places[:, None] - taken, -1, 0))
    free = np.flatnonzero((away >= cores + core + APART).all(axis=1))
    return places[free[0]] if len(free) else None


def swapped_spots(
    shaft: Shaft,
    stop: int,
    points: NDArray[np.float64],
    cores: NDArray[np.float64],
    spots: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The spots of those who get in, with the farthest for those who come first.

    People do not come in the order in which they were let in. Where somebody would have to pass
    another who stands before their spot already, all spots are given anew.

    Args:
        shaft: the lift.
        stop: where its car is.
        points: (n, 2) where they are, metres.
        cores: (n,) their core radii, metres.
        spots: (n, 2) their spots so far, metres.

    Returns:
        (n, 2) metres; ``spots`` if nobody is in the way, or if they would not all fit.
    """
    came, deep = points @ shaft.into(), spots @ shaft.into()
    ahead, behind = np.greater.outer(came, came), np.less.outer(deep + cores, deep)
    there = np.hypot(*(points - spots).T) < THERE
    if not (ahead & behind)[there].any():
        return spots
    order, found = np.argsort(-came, kind="stable"), spots.copy()
    for k, person in enumerate(order):
        taken = order[:k]
        spot = free_spot(shaft, stop, cores[person], found[taken], cores[taken])
        if spot is None:
            return spots
        found[person] = spot
    return found
