"""Anticipation: people who walk turn aside early for those whom they would come too near.

Cost terms look at the end of a movement, when it is too late to step aside gently.  Here, people
who walk compare courses before they choose a movement: straight to their target, turned by up to 45
degrees to either side, each at their own speed and somewhat slower.  The cost of a course is the
change of velocity that it takes and, for each person in view, how much nearer than ``ROOM`` the two
would come within ``HORIZON`` if both walked on.  It is sought as in sampled velocity obstacles (van
den Berg, Lin and Manocha, ICRA 2008).  That people respond to the predicted time to a collision,
and less the farther it lies ahead, is measured by Karamouzas, Skinner and Guy, Physical Review
Letters 113 (2014) 238701.

Those who go the same way, and those who are held up in a queue, do not count: they are a matter of
headway, and nobody goes round the queue that they want to join.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, FloorPlan, Tactic
from mesa_mobility.steering import (
    Crowd,
    CrowdState,
    Grid,
    Sight,
    cells_within,
    compiled,
    inner,
    nobody,
    sight_on,
    unwalled,
)

ROOM = 0.65
"""Metres between the middles of two people who pass each other freely."""

SHARE = 0.6
"""Share of the present distance that the room asked for is at most: nobody can demand room of
people who are near already."""

HORIZON = 4.0
"""Seconds within which a closest approach counts, or as long as the way to the target takes."""

REACH = 9.0
"""Metres within which people count."""

SLOWEST, RAMP = 0.9, 0.5
"""Relative speed from which on people count, and by how much more they count in full, m/s."""

HALFWAY = 4.0
"""Present distance at which somebody counts half, metres."""

WEIGHT = 3.0
"""Change of velocity that people accept so as not to walk into another person, m/s."""

LEFT = 0.1
"""What turning left costs more, m/s: of two people who might as well pass on either side, both keep
to the right."""

STEPS, WIDEST = 6, 0.8
"""Number of courses to each side, and the angle of the last, radians."""

SLOWER = 0.7
"""Share of their speed at which people might walk on instead."""

WALKS = 0.3
"""Speed of those who look ahead, m/s: somebody who stands sets off first."""

GAINS = 0.4
"""How much faster than now people expect to be soon, m/s."""

QUEUES = 0.5
"""Speed below which somebody who is on the way is held up, m/s."""

SAME_WAY = 0.5
"""Cosine of the angle between the ways of two people up to which they go the same way."""

_FIELDS = 5


def turn_aside(
    rows: NDArray[np.int64],
    grid: Grid,
    frame: int,
    crowd: Crowd,
    plan: FloorPlan,
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Targets (n, 2) in metres and preferred speeds (n,) in m/s of deciding people, on the course
    that each takes.

    Args:
        rows: (n,) the pedestrians.
        grid: everybody inside.
        frame: now.
        crowd: the crowd.
        plan: its floor plan: people behind walls do not count.
        points: (n, 2) their targets, metres.
        speeds: (n,) their preferred speeds, m/s.
    """
    points, speeds = points.copy(), speeds.copy()
    _turn_aside(
        rows,
        frame,
        grid,
        sight_on(plan, 0.0),
        crowd.records,
        crowd.agenda,
        points,
        speeds,
        np.empty((_FIELDS, len(grid.people))),
    )
    return points, speeds


@compiled()
def _turn_aside(
    rows: NDArray[np.int64],
    frame: int,
    grid: Grid,
    sight: Sight,
    state: CrowdState,
    agenda: NDArray[np.void],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    others: NDArray[np.float64],
) -> None:
    """Change ``points`` and ``speeds`` as of ``turn_aside``; ``others`` has room for everybody."""
    for k in range(len(rows)):
        i = rows[k]
        now = math.sqrt(state[i].vx * state[i].vx + state[i].vy * state[i].vy)
        dx, dy = points[k, 0] - state[i].x, points[k, 1] - state[i].y
        away = math.sqrt(dx * dx + dy * dy)
        if now < WALKS or away == 0.0 or speeds[k] == 0.0:
            continue
        ex, ey = dx / away, dy / away
        speed = min(speeds[k], now + GAINS)
        count = _in_the_way(i, ex, ey, speed, frame, grid, state, agenda, others)
        horizon = min(HORIZON, away / speed)
        if _too_near(speed * ex, speed * ey, horizon, others, count, np.inf) == 0.0:
            continue
        count = _in_view(i, sight, state, others, count)
        angle, share = _best_course(ex, ey, speed, horizon, others, count)
        c, s = math.cos(angle), math.sin(angle)
        points[k, 0] = state[i].x + away * (c * ex - s * ey)
        points[k, 1] = state[i].y + away * (s * ex + c * ey)
        speeds[k] *= share


@inner()
def _in_the_way(
    i: int,
    ex: float,
    ey: float,
    speed: float,
    frame: int,
    grid: Grid,
    state: CrowdState,
    agenda: NDArray[np.void],
    others: NDArray[np.float64],
) -> int:
    """Write place from pedestrian i on, velocity and weight of those ahead who count for somebody
    who walks towards (ex, ey) at ``speed``; returns their number."""
    px, py = state[i].x, state[i].y
    full = 1.0 / ((SLOWEST + RAMP) * (SLOWEST + RAMP) - SLOWEST * SLOWEST)
    first, last, low, high = cells_within(grid, px, py, REACH)
    count = 0
    for row in range(low, high + 1):
        for a in range(grid.offsets[row * grid.nx + first], grid.offsets[row * grid.nx + last + 1]):
            x, y = grid.x[a] - px, grid.y[a] - py
            away2 = x * x + y * y
            if x * ex + y * ey <= 0.0 or away2 > REACH * REACH:
                continue
            j = grid.people[a]
            vx, vy = state[j].vx, state[j].vy
            wx, wy = vx - speed * ex, vy - speed * ey
            excess = wx * wx + wy * wy - SLOWEST * SLOWEST
            if excess <= 0.0 or _goes_along(j, ex, ey, frame, state, agenda):
                continue
            others[0, count], others[1, count] = x, y
            others[2, count], others[3, count] = vx, vy
            weight = WEIGHT * min(excess * full, 1.0)
            others[4, count] = weight * HALFWAY / (HALFWAY + math.sqrt(away2))
            count += 1
    return count


@inner()
def _goes_along(
    j: int, ex: float, ey: float, frame: int, state: CrowdState, agenda: NDArray[np.void]
) -> bool:
    """Whether j is held up in a queue or goes the way (ex, ey); not if they stay there."""
    dx, dy = state[j].target_x - state[j].x, state[j].target_y - state[j].y
    if (dx == 0.0 and dy == 0.0) or agenda[j]["waits_until"] > frame:
        return False
    if state[j].vx * state[j].vx + state[j].vy * state[j].vy < QUEUES * QUEUES:
        return True
    return bool(dx * ex + dy * ey > SAME_WAY * math.sqrt(dx * dx + dy * dy))


@inner()
def _in_view(
    i: int, sight: Sight, state: CrowdState, others: NDArray[np.float64], count: int
) -> int:
    """Move those whom no wall hides from i to the front; returns their number."""
    px, py = state[i].x, state[i].y
    seen = 0
    for k in range(count):
        if unwalled(sight, px, py, px + others[0, k], py + others[1, k]):
            for row in range(_FIELDS):
                others[row, seen] = others[row, k]
            seen += 1
    return seen


@inner()
def _best_course(
    ex: float, ey: float, speed: float, horizon: float, others: NDArray[np.float64], count: int
) -> tuple[float, float]:
    """Angle in radians from (ex, ey), and share of the speed, of the cheapest course."""
    best, best_angle, best_share = np.inf, 0.0, 1.0
    for share in (1.0, SLOWER):
        for step in range(2 * STEPS + 1):
            # Straight on, then to the right and the left in turns, ever wider.
            number = (step + 1) // 2
            turn = WIDEST / (STEPS * STEPS) * number * number
            angle = -turn if step % 2 == 1 else turn
            c, s = math.cos(angle), math.sin(angle)
            ux, uy = share * speed * (c * ex - s * ey), share * speed * (s * ex + c * ey)
            dx, dy = ux - speed * ex, uy - speed * ey
            cost = math.sqrt(dx * dx + dy * dy) + (LEFT if angle > 0.0 else 0.0)
            if cost < best:
                cost += _too_near(ux, uy, horizon, others, count, best - cost)
            if cost < best:
                best, best_angle, best_share = cost, angle, share
    return best_angle, best_share


@inner()
def _too_near(
    ux: float, uy: float, horizon: float, others: NDArray[np.float64], count: int, enough: float
) -> float:
    """How much too near to others somebody comes who walks at (ux, uy); it may stop at ``enough``.

    Each counts 1 - (d / l)^2 times its weight, as far as their closest approach d is less than l,
    ``ROOM`` or ``SHARE`` of the present distance.
    """
    total = 0.0
    for k in range(count):
        x, y = others[0, k], others[1, k]
        wx, wy = others[2, k] - ux, others[3, k] - uy
        towards = -(x * wx + y * wy)
        if towards <= 0.0:
            continue
        time = min(towards / (wx * wx + wy * wy), horizon)
        dx, dy = x + wx * time, y + wy * time
        room2 = min(ROOM * ROOM, SHARE * SHARE * (x * x + y * y))
        near = 1.0 - (dx * dx + dy * dy) / room2
        if near > 0.0:
            total += near * others[4, k]
            if total >= enough:
                return total
    return total


class Anticipation(Tactic):
    """People who walk turn aside early for those whom they would come too near."""

    name = "anticipation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of those for whom another course is better, or slow them down."""
        if not desired.newcomers:
            desired.points, desired.speeds = turn_aside(
                deciding.pedestrians,
                deciding.inside.grid,
                deciding.frame,
                deciding.inside.crowd,
                deciding.site.plan,
                desired.points,
                desired.speeds,
            )

    def compile_ahead(self) -> None:
        """Compile the comparison of courses."""
        (inside, plan), nowhere = nobody(), np.empty((0, 2))
        turn_aside(inside.pedestrians, inside.grid, 0, inside.crowd, plan, nowhere, np.empty(0))
