"""Speed adaptation: people walk as fast as those ahead of them let them.

Cost terms compare speeds with what somebody prefers when alone, and so people in a crowd speed up
into each gap and brake at its end.  Here, the preferred speed itself follows from the room ahead,
as in models of single-file motion: somebody with a gap g to a person ahead who walks at u wants

    u + (g - l - T u) / tau,

at most their own speed and at least a share of it, where l is the distance kept when standing and T
the time gap when walking.
At the same speed g = l + T u, the linear relation between distance and speed that Seyfried,
Steffen, Klingsch and Boltes measured (J. Stat. Mech. (2005) P10002).  Taking over the speed of
those ahead, and closing a gap within ``tau``, keeps small changes from growing on their way back
through a queue, as in the stability of car following (Treiber and Kesting, Traffic Flow Dynamics,
chapter 15).

People count within a strip as wide as two bodies, in full straight ahead and not at all at its
edge.  Those who come towards somebody are a matter of anticipation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Tactic
from mesa_mobility.steering import Crowd, CrowdState, Grid, cells_within, compiled, inner, nobody

STANDING_GAP = 0.28
"""l: distance between the middles of two people who stand one behind the other, metres."""

TIME_GAP = 0.7
"""T: seconds."""

CLOSES = 3.0
"""tau: seconds within which somebody closes a gap that is too large."""

HALF_WIDTH = 0.25
"""Metres to the side from which on people no longer count."""

REACH = 4.0
"""Metres within which people count."""

ONCOMING = 0.3
"""Speed of people towards somebody from which on they do not count, m/s."""

LEAST = 0.75
"""Share of their own speed that people want at least: in dense crowds, where people are slower,
the cost terms decide alone.  With less, waves of standing people last there."""


def adapt_speeds(
    rows: NDArray[np.int64],
    grid: Grid,
    crowd: Crowd,
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Preferred speeds (n,) in m/s of deciding people, given those ahead of them.

    Args:
        rows: (n,) the pedestrians.
        grid: everybody inside.
        crowd: the crowd.
        points: (n, 2) where they want to go, metres.
        speeds: (n,) how fast, with nobody ahead, m/s.
    """
    speeds = speeds.copy()
    _adapt_speeds(rows, grid, crowd.records, points, speeds)
    return speeds


@compiled()
def _adapt_speeds(
    rows: NDArray[np.int64],
    grid: Grid,
    state: CrowdState,
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> None:
    """Change ``speeds`` as of ``adapt_speeds``."""
    for k in range(len(rows)):
        i = rows[k]
        dx, dy = points[k, 0] - state[i].x, points[k, 1] - state[i].y
        away = math.sqrt(dx * dx + dy * dy)
        if away > 0.0 and speeds[k] > 0.0:
            speeds[k] = _allowed(i, dx / away, dy / away, speeds[k], grid, state)


@inner()
def _allowed(i: int, ex: float, ey: float, own: float, grid: Grid, state: CrowdState) -> float:
    """Speed of pedestrian i, who would walk at ``own`` along (ex, ey), m/s."""
    px, py = state[i].x, state[i].y
    first, last, low, high = cells_within(grid, px, py, REACH)
    least = own
    for row in range(low, high + 1):
        for a in range(grid.offsets[row * grid.nx + first], grid.offsets[row * grid.nx + last + 1]):
            x, y = grid.x[a] - px, grid.y[a] - py
            ahead = x * ex + y * ey
            aside = abs(x * ey - y * ex)
            if ahead <= 0.0 or ahead > REACH or aside >= HALF_WIDTH:
                continue
            j = grid.people[a]
            along = state[j].vx * ex + state[j].vy * ey
            if along <= -ONCOMING:
                continue
            along = max(along, 0.0)
            allowed = along + (ahead - STANDING_GAP - TIME_GAP * along) * (1.0 / CLOSES)
            allowed = max(allowed, LEAST * own)
            if allowed < own:
                share = aside * (1.0 / HALF_WIDTH)
                least = min(least, allowed + (own - allowed) * share)
    return least


class AdaptSpeed(Tactic):
    """People walk as fast as those ahead of them let them."""

    name = "speed_adaptation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Slow down those who have people ahead."""
        if not desired.newcomers:
            desired.speeds = adapt_speeds(
                deciding.pedestrians,
                deciding.inside.grid,
                deciding.inside.crowd,
                desired.points,
                desired.speeds,
            )

    def compile_ahead(self) -> None:
        """Compile the look at those ahead."""
        inside, _ = nobody()
        adapt_speeds(inside.pedestrians, inside.grid, inside.crowd, np.empty((0, 2)), np.empty(0))
