"""Anticipation: people who walk turn aside early for those whom they would come too near.

Cost terms look at the end of a movement, when it is too late to step aside gently.  Here, people
who walk compare courses before they choose a movement: straight to their target, turned by up to 45
degrees to either side, each at their own speed and somewhat slower.  The cost of a course is the
change of velocity that it takes and, for each person in view, how much nearer the two would come
than ``ROOM`` (more for wide bodies) within ``HORIZON`` if both walked on.  It is sought as in
sampled velocity obstacles (van den Berg, Lin and Manocha, ICRA 2008).  That people respond to the
predicted time to a collision, and less the farther it lies ahead, is measured by Karamouzas,
Skinner and Guy, Physical Review Letters 113 (2014) 238701.

Those who go the same way, and those who are held up in a queue, do not count: they are a matter of
headway, and nobody goes round the queue that they want to join.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from mesa_mobility.behaviors.steering.people_ahead import (
    AHEAD_FIELDS,
    MOTION_FIELDS,
    Found,
    any_too_near,
    find_ahead,
    note_motion,
    room_to_find,
    seen,
)
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, FloorPlan, Range, Tactic
from mesa_mobility.steering import (
    Crowd,
    CrowdState,
    Grid,
    Sight,
    by_shares,
    compiled,
    inner,
    nobody,
    sight_on,
)

HORIZON = 4.0
"""Seconds within which a closest approach counts, or as long as the way to the target takes."""

LEFT = 0.1
"""A course to the left costs so much more, m/s, where nobody comes."""

LEFT_OF_COMING = 0.5
"""The same where somebody comes: they look for a side, too, and both keep to the right."""

STEPS = 6
"""Number of courses to each side."""

NARROWEST = 0.8 / 36
"""Angle of the first course to a side, radians; the n-th is turned by n^2 as much."""

SLOWER = 0.7
"""Share of their speed at which people might walk on instead."""

WALKS = 0.3
"""Speed of those who look ahead, m/s: somebody who stands sets off first."""

GAINS = 0.4
"""How much faster than now people expect to be soon, m/s."""

_COURSES = 2 * (2 * STEPS + 1)

_COURSE_FIELDS = 7


def turns(steps: int) -> NDArray[np.float64]:
    """(2 steps + 1,) angles by which courses turn, radians: straight on, then to the right and the
    left in turns, ever wider."""
    numbers = np.arange(1, steps + 1)
    right = -NARROWEST * numbers * numbers
    return np.concatenate([[0.0], np.column_stack([right, -right]).ravel()])


def _course_table() -> NDArray[np.float64]:
    """(``_COURSE_FIELDS``, courses) share of the speed, cosine and sine of the turn, and whether it
    is to the left, of each course; the other rows are workspace."""
    angles = np.tile(turns(STEPS), 2)
    courses = np.zeros((_COURSE_FIELDS, _COURSES))
    courses[0] = np.repeat([1.0, SLOWER], 2 * STEPS + 1)
    courses[1], courses[2] = np.cos(angles), np.sin(angles)
    courses[3] = angles > 0.0
    return courses


_COURSE_TABLE = _course_table()


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
    n = len(grid.people)
    motion = np.empty((MOTION_FIELDS, n))
    note_motion(grid, frame, crowd.records, crowd.agenda, motion)
    sight = sight_on(plan, 0.0)

    def turn(own: slice) -> None:
        _turn_aside(
            rows[own],
            grid,
            sight,
            crowd.records,
            motion,
            points[own],
            speeds[own],
            room_to_find(n),
            (np.empty((AHEAD_FIELDS, n)), _COURSE_TABLE.copy()),
        )

    by_shares(turn, len(rows))
    return points, speeds


@compiled()
def _turn_aside(
    rows: NDArray[np.int64],
    grid: Grid,
    sight: Sight,
    state: CrowdState,
    motion: NDArray[np.float64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    found: Found,
    work: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> None:
    """Change ``points`` and ``speeds`` as of ``turn_aside``.

    ``found`` and the first array of ``work`` have room for everybody; the second is of
    ``_course_table``. Each thread has its own.
    """
    ahead, courses = work
    for k in range(len(rows)):
        i = rows[k]
        now = math.sqrt(state[i].vx * state[i].vx + state[i].vy * state[i].vy)
        place = (state[i].x, state[i].y)
        dx, dy = points[k, 0] - place[0], points[k, 1] - place[1]
        away = math.sqrt(dx * dx + dy * dy)
        if now < WALKS or away == 0.0 or speeds[k] == 0.0:
            continue
        ex, ey = dx / away, dy / away
        speed = min(speeds[k], now + GAINS)
        count = find_ahead(place, (ex, ey), speed, state[i].core, grid, motion, found, ahead)
        horizon = min(HORIZON, away / speed)
        if not any_too_near(speed * ex, speed * ey, horizon, ahead, count):
            continue
        _set_courses(ex, ey, speed, courses)
        left = LEFT
        for other in range(count):
            if _matters(ahead, other, courses) and seen(place, sight, ahead, other):
                _add_cost(ahead, other, horizon, courses)
                if ahead[2, other] * ex + ahead[3, other] * ey < 0.0:
                    left = LEFT_OF_COMING
        best = _cheapest(speed * ex, speed * ey, left, courses)
        share, c, s = courses[0, best], courses[1, best], courses[2, best]
        points[k, 0] = place[0] + away * (c * ex - s * ey)
        points[k, 1] = place[1] + away * (s * ex + c * ey)
        speeds[k] *= share


@inner()
def _set_courses(ex: float, ey: float, speed: float, courses: NDArray[np.float64]) -> None:
    """Write the velocities of courses round (ex, ey) at ``speed``, and that no people cost any."""
    share, cosine, sine = courses[0], courses[1], courses[2]
    ux, uy, people = courses[4], courses[5], courses[6]
    for n in range(_COURSES):
        ux[n] = share[n] * speed * (cosine[n] * ex - sine[n] * ey)
        uy[n] = share[n] * speed * (sine[n] * ex + cosine[n] * ey)
        people[n] = 0.0


@inner()
def _matters(ahead: NDArray[np.float64], k: int, courses: NDArray[np.float64]) -> bool:
    """Whether the k-th of those ahead might come too near on any course.

    The closest approach d of two lines has d^2 = |x|^2 - (x w)^2 / w^2, which needs no division to
    be compared. Rounding errors are far less than a billionth.
    """
    x, y, vx, vy = ahead[0, k], ahead[1, k], ahead[2, k], ahead[3, k]
    ux, uy = courses[4], courses[5]
    away2 = x * x + y * y
    beyond = away2 - ahead[5, k]
    near = 0
    for n in range(_COURSES):
        wx, wy = vx - ux[n], vy - uy[n]
        towards = -(x * wx + y * wy)
        closes_in = beyond * (wx * wx + wy * wy) < (1.0 + 1e-9) * towards * towards
        near += int((towards > 0.0) & closes_in)
    return near > 0


@inner()
def _add_cost(
    ahead: NDArray[np.float64], k: int, horizon: float, courses: NDArray[np.float64]
) -> None:
    """Add what the k-th of those ahead costs on each course.

    It is 1 - (d / l)^2 times how much they count, as far as their closest approach d is less than
    l, the room that is asked of them.
    """
    x, y, vx, vy = ahead[0, k], ahead[1, k], ahead[2, k], ahead[3, k]
    counts, room2 = ahead[4, k], ahead[5, k]
    ux, uy, people = courses[4], courses[5], courses[6]
    for n in range(_COURSES):
        wx, wy = vx - ux[n], vy - uy[n]
        towards = -(x * wx + y * wy)
        time = min(towards / (wx * wx + wy * wy), horizon)
        dx, dy = x + wx * time, y + wy * time
        near = 1.0 - (dx * dx + dy * dy) / room2
        people[n] += near * counts if (towards > 0.0) & (near > 0.0) else 0.0


@inner()
def _cheapest(wanted_x: float, wanted_y: float, left: float, courses: NDArray[np.float64]) -> int:
    """Index of the cheapest course of somebody who wants this velocity; the first of equal ones.

    Those to the left cost ``left`` more.
    """
    side, ux, uy, people = courses[3], courses[4], courses[5], courses[6]
    least, best = np.inf, 0
    for n in range(_COURSES):
        dx, dy = ux[n] - wanted_x, uy[n] - wanted_y
        cost = math.sqrt(dx * dx + dy * dy) + left * side[n] + people[n]
        if cost < least:
            least, best = cost, n
    return best


class Anticipation(Tactic):
    """People who walk turn aside early for those whom they would come too near.

    Those who walk and turn aside for nobody do not keep their course exactly: each movement ends
    off it by a normally distributed angle, and the next one makes up for that. So people sway about
    a line.

    Args:
        wander: standard deviation of that angle, radians.

    Raises:
        ModelError: a number out of range.
    """

    name = "anticipation"

    def __init__(self, wander: Annotated[float, Range(0.0, 1.5, "rad")] = 0.0) -> None:
        self.wander = wander

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of those for whom another course is better, or slow them down; let others
        wander."""
        if desired.newcomers:
            return
        rows, crowd, aims = deciding.pedestrians, deciding.inside.crowd, desired.points
        points, speeds = turn_aside(
            rows,
            deciding.inside.grid,
            deciding.frame,
            crowd,
            deciding.site.plan,
            aims,
            desired.speeds,
        )
        if self.wander > 0.0:
            ends = self.wander * deciding.rng.standard_normal(len(rows))
            stands = np.hypot(crowd.vx[rows], crowd.vy[rows]) < WALKS
            strays = ~stands & (points == aims).all(axis=1) & (speeds == desired.speeds)
            ends[~strays] = 0.0
            off = np.where(strays, ends - crowd.agenda["strayed"][rows], 0.0)
            crowd.agenda["strayed"][rows] = ends
            dx, dy = (points - deciding.positions).T
            c, s = np.cos(off), np.sin(off)
            points = deciding.positions + np.column_stack([c * dx - s * dy, s * dx + c * dy])
        desired.points, desired.speeds = points, speeds

    def compile_ahead(self) -> None:
        """Compile the comparison of courses."""
        (inside, plan), nowhere = nobody(), np.empty((0, 2))
        turn_aside(inside.pedestrians, inside.grid, 0, inside.crowd, plan, nowhere, np.empty(0))
