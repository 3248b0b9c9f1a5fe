"""Who is hindered: people who come no nearer to where they go."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.people_grid import Grid, cells_within
from mesa_mobility.crowd.state.records import CrowdState

GETTING_NEARER = 0.25
"""Metres that somebody must come nearer for it to count as progress."""

ANOTHER_WAY = 2.0
"""Metres by which a route grows only if it becomes another one, to another gate or exit."""

PATIENCE = 2.0
"""Seconds without progress from which on somebody is hindered."""

SLOW_PATIENCE = 2.0
"""For slow people, how many times as long as the progress takes at the speed that they want."""

MOVES_ON = 2.0
"""Metres ahead within which somebody who gets on, and goes the same way, makes others wait."""


@entry_point()
def find_hindered(
    rows: NDArray[np.int64],
    speeds: NDArray[np.float64],
    elapsed: float,
    state: CrowdState,
    agenda: NDArray[np.void],
    hindered: NDArray[np.bool_],
) -> None:
    """Note the progress of those in ``rows``, and write who has made none for some seconds.

    People who wait, or have not set off, are not hindered, nor are slow people who get on as fast
    as they want to where they are, ``speeds`` (n,) in m/s.
    """
    for k in range(len(rows)):
        i = rows[k]
        route, nearest = state[i].route, agenda[i]["nearest"]
        if (
            route < nearest - GETTING_NEARER
            or route > nearest + ANOTHER_WAY
            or not abs(route) < np.inf
        ):
            agenda[i]["nearest"], agenda[i]["since"] = route, elapsed
        free, own = agenda[i]["waits_until"] * FRAME_SECONDS, speeds[k]
        patience = max(PATIENCE, SLOW_PATIENCE * GETTING_NEARER / own) if own > 0.0 else np.inf
        hindered[k] = elapsed - max(agenda[i]["since"], free) > patience


@entry_point()
def wait_behind(
    rows: NDArray[np.int64],
    elapsed: float,
    people: Grid,
    state: CrowdState,
    agenda: NDArray[np.void],
    hindered: NDArray[np.bool_],
) -> None:
    """Take back that those in ``rows`` are hindered who stand in a jam that moves on.

    In a jam people are in each other's way all the time, and rings of them end by themselves as
    long as somebody just ahead, who goes the same way, gets on.
    """
    for k in range(len(rows)):
        if hindered[k]:
            hindered[k] = not _moves_on(rows[k], elapsed, people, state, agenda)


@internal()
def _moves_on(
    i: int, elapsed: float, people: Grid, state: CrowdState, agenda: NDArray[np.void]
) -> bool:
    """Whether somebody within ``MOVES_ON`` ahead of person i gets on, and goes the same way."""
    x, y = state[i].x, state[i].y
    dx, dy = state[i].target_x - x, state[i].target_y - y
    cx0, cx1, cy0, cy1 = cells_within(people, x, y, MOVES_ON)
    if cx0 > cx1:
        return False
    for cy in range(cy0, cy1 + 1):
        row = cy * people.nx
        for a in range(people.offsets[row + cx0], people.offsets[row + cx1 + 1]):
            j = people.people[a]
            wx, wy = state[j].x - x, state[j].y - y
            jx, jy = state[j].target_x - state[j].x, state[j].target_y - state[j].y
            if (
                wx * dx + wy * dy > 0.0
                and wx * wx + wy * wy <= MOVES_ON * MOVES_ON
                and elapsed - agenda[j]["since"] <= PATIENCE
                and jx * dx + jy * dy > 0.0
            ):
                return True
    return False
