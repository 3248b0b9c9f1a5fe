"""Making room for somebody wide who is held up in an opening.

Who is wedged in between others has no movement that touches none of them, so only they can set it
free.  They step aside to where there is room.  Those right beside it mostly have none until those
behind them have made some.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan import FloorPlan, lines_of_sight

ROOM = 2.0
"""Metres of the gap to somebody held up within which others make room.  A wheelchair takes 6 % of
the floor before an opening that is as near as that."""

STEP = 0.4
"""Metres of a step aside."""

SWAY = 0.03
"""Metres by which somebody who walks sways to either side of its way."""

_TURNS = np.deg2rad([0.0, 22.5, -22.5, 45.0, -45.0, 67.5, -67.5, 90.0, -90.0])
"""Directions of a step, from the way straight apart, in the order in which they are preferred."""


def steps_aside(
    plan: FloorPlan,
    places: NDArray[np.float64],
    radii: NDArray[np.float64],
    stuck: NDArray[np.float64],
    others: NDArray[np.float64],
    their_radii: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Where each steps aside, and whether it can.

    A step leads away from somebody who is held up, comes no nearer to those who are close already,
    and keeps clear of the others and of walls.  Of several the one straightest away is taken.

    Args:
        plan: the floor plan.
        places: (n, 2) where they are, metres.
        radii: (n,) of the circles that hold their bodies, metres.
        stuck: (n, 2) where the one is that each makes room for, metres.
        others: (m, 2) where all are, themselves included, metres.
        their_radii: (m,) of the circles that hold their bodies, metres.

    Returns:
        (n, 2) ends of the steps, metres; their own places for those who cannot. (n,) who can.
    """
    far = float(radii.max() + their_radii.max()) + SWAY + STEP
    near_by = ((others > places.min(axis=0) - far) & (others < places.max(axis=0) + far)).all(
        axis=1
    )
    others, their_radii = others[near_by], their_radii[near_by]
    away = places - stuck
    angles = np.arctan2(away[:, 1], away[:, 0])[:, None] + _TURNS
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=2)
    to = others - places[:, None]
    apart = np.hypot(to[..., 0], to[..., 1])
    near = (apart < radii[:, None] + their_radii + SWAY + STEP) & (apart > 0.0)
    ahead = np.clip((to[:, None] * ways[:, :, None]).sum(axis=3), 0.0, STEP)
    left = to[:, None] - ahead[..., None] * ways[:, :, None]
    wanted = np.minimum(apart, radii[:, None] + their_radii + SWAY)[:, None]
    # What is lost to rounding does not bring anybody nearer.
    kept = np.hypot(left[..., 0], left[..., 1]) >= wanted - 1e-9
    free = (kept | ~near[:, None]).all(axis=2)
    ends = places[:, None] + STEP * ways
    for radius in np.unique(radii):
        who, way = np.nonzero(free & (radii == radius)[:, None])
        free[who, way] = lines_of_sight(plan, places[who], ends[who, way], float(radius))
    can = free.any(axis=1)
    best = free.argmax(axis=1)
    return np.where(can[:, None], ends[np.arange(len(places)), best], places), can
