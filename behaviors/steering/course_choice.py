"""Choice of course: people who are held up go where they get on.

The shortest way round a corner or through a door from the side touches the wall.  If everybody took
it, a crowd would queue for a single place, and most of the door or corridor would stay empty.  So
people who would catch up with slower people compare courses: straight to their target, and turned
by up to 62 degrees to either side.  On each they get as far as those ahead let them who walk the
same way, or stand.  The cost of a course is the change of velocity that it takes, and what it loses
of the way to the target.  Somebody who is alone goes straight.

Nobody leaves their course while somebody comes the other way: people who do so fill the lane of
those who come, and both stand.  Those beyond the target do not count.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
from mesa_mobility.behaviors.right_of_way import OPPOSED
from mesa_mobility.behaviors.steering.anticipation import GAINS, turns
from mesa_mobility.behaviors.steering.people_ahead import (
    LIMIT,
    MOTION_FIELDS,
    WAY_X,
    WAY_Y,
    note_motion,
)
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Range, Tactic
from mesa_mobility.steering import (
    CrowdState,
    CrowdView,
    Grid,
    Sight,
    cells_within,
    compiled,
    inner,
    nobody,
    sight_on,
    unwalled,
)

REACH = 4.0
"""Metres within which people ahead count."""

AHEAD = 4.0
"""Seconds for which courses are compared, or as long as the way to the target takes."""

CLOSE = 0.4
"""Metres between the middles of two people, one behind the other, who stand."""

COMING = 6.0
"""Metres within which those who come the other way count."""

STEPS = 7
"""Number of courses to each side: the last is turned by 62 degrees, by which somebody gets round a
person whom they stand behind."""

_COURSES = np.stack([np.cos(turns(STEPS)), np.sin(turns(STEPS))])
"""(2, courses) cosine and sine of the turn of each course."""

_FIELDS = 4


class CourseSettings(NamedTuple):
    """Numbers of the comparison, as of ``ChooseCourse``."""

    haste: float
    width: float


class _Around(NamedTuple):
    """Everybody, with their motion in the order of ``grid`` (see ``note_motion``), and walls."""

    grid: Grid
    sight: Sight
    state: CrowdState
    motion: NDArray[np.float64]


def choose_courses(
    rows: NDArray[np.int64],
    inside: CrowdView,
    frame: int,
    sight: Sight,
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    settings: CourseSettings,
) -> NDArray[np.float64]:
    """Targets (n, 2) in metres of deciding people, on the course that each takes.

    Args:
        rows: (n,) the pedestrians.
        inside: everybody inside.
        frame: now.
        sight: the walls: people behind them do not count, and no course leads into one.
        points: (n, 2) their targets, metres.
        speeds: (n,) their preferred speeds, m/s.
        settings: of the comparison.
    """
    points = points.copy()
    grid, crowd = inside.grid, inside.crowd
    n = len(grid.people)
    ahead, motion = np.empty((_FIELDS, n)), np.empty((MOTION_FIELDS, n))
    note_motion(grid, frame, crowd.records, crowd.agenda, motion)
    around = _Around(grid, sight, crowd.records, motion)
    _choose_courses(rows, around, points, speeds, settings, _COURSES, ahead)
    return points


@compiled()
def _choose_courses(
    rows: NDArray[np.int64],
    around: _Around,
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    settings: CourseSettings,
    courses: NDArray[np.float64],
    ahead: NDArray[np.float64],
) -> None:
    """Change ``points`` as of ``choose_courses``; ``ahead`` has room for everybody."""
    state, sight = around.state, around.sight
    for k in range(len(rows)):
        i = rows[k]
        x, y = state[i].x, state[i].y
        dx, dy = points[k, 0] - x, points[k, 1] - y
        away = math.sqrt(dx * dx + dy * dy)
        if away == 0.0 or speeds[k] == 0.0:
            continue
        ex, ey = dx / away, dy / away
        now = math.sqrt(state[i].vx * state[i].vx + state[i].vy * state[i].vy)
        speed = min(speeds[k], now + GAINS)
        far = min(speed * AHEAD, away)
        count = _people_ahead(x, y, ex, ey, away, around, ahead)
        if _gets_on(ex, ey, far, speed, settings.width, ahead, count) >= far:
            continue
        if _somebody_comes(x, y, ex, ey, away, around):
            continue
        count = _in_view(x, y, sight, ahead, count)
        best, bx, by = np.inf, ex, ey
        for n in range(courses.shape[1]):
            c, s = courses[0, n], courses[1, n]
            ux, uy = c * ex - s * ey, s * ex + c * ey
            cost = speed * math.sqrt(2.0 - 2.0 * c)
            if cost < best:
                on = c * _gets_on(ux, uy, far, speed, settings.width, ahead, count)
                cost += settings.haste * speed * (1.0 - on / far)
            if cost < best and (n == 0 or unwalled(sight, x, y, x + far * ux, y + far * uy)):
                best, bx, by = cost, ux, uy
        points[k, 0], points[k, 1] = x + away * bx, y + away * by


@inner()
def _people_ahead(
    x: float,
    y: float,
    ex: float,
    ey: float,
    away: float,
    around: _Around,
    ahead: NDArray[np.float64],
) -> int:
    """Write place, from (x, y) on, and velocity of those on this side of a target; returns their
    number."""
    grid = around.grid
    first, last, low, high = cells_within(grid, x, y, REACH)
    count = 0
    for row in range(low, high + 1):
        for a in range(grid.offsets[row * grid.nx + first], grid.offsets[row * grid.nx + last + 1]):
            dx, dy = grid.x[a] - x, grid.y[a] - y
            along = dx * ex + dy * ey
            if not 0.0 < along < away or dx * dx + dy * dy > REACH * REACH:
                continue
            j = grid.people[a]
            ahead[0, count], ahead[1, count] = dx, dy
            ahead[2, count], ahead[3, count] = around.state[j].vx, around.state[j].vy
            count += 1
    return count


@inner()
def _somebody_comes(x: float, y: float, ex: float, ey: float, away: float, around: _Around) -> bool:
    """Whether somebody in view, on this side of a target, wants to go the other way, at more than
    120 degrees.

    People who wait do not: they always count for others, which is what an endless limit says.
    """
    grid, motion = around.grid, around.motion
    first, last, low, high = cells_within(grid, x, y, COMING)
    for row in range(low, high + 1):
        for a in range(grid.offsets[row * grid.nx + first], grid.offsets[row * grid.nx + last + 1]):
            dx, dy = grid.x[a] - x, grid.y[a] - y
            if (
                motion[LIMIT, a] < np.inf
                and 0.0 < dx * ex + dy * ey < away
                and dx * dx + dy * dy <= COMING * COMING
                and motion[WAY_X, a] * ex + motion[WAY_Y, a] * ey
                < -OPPOSED * math.hypot(motion[WAY_X, a], motion[WAY_Y, a])
                and unwalled(around.sight, x, y, grid.x[a], grid.y[a])
            ):
                return True
    return False


@inner()
def _in_view(x: float, y: float, sight: Sight, ahead: NDArray[np.float64], count: int) -> int:
    """Move those whom no wall hides to the front; returns their number."""
    seen = 0
    for k in range(count):
        if unwalled(sight, x, y, x + ahead[0, k], y + ahead[1, k]):
            for field in range(_FIELDS):
                ahead[field, seen] = ahead[field, k]
            seen += 1
    return seen


@inner()
def _gets_on(
    ux: float,
    uy: float,
    far: float,
    speed: float,
    width: float,
    ahead: NDArray[np.float64],
    count: int,
) -> float:
    """Metres that somebody gets along (ux, uy) in the time in which they would walk ``far``.

    They follow whoever they catch up with.  Somebody half of ``width`` to the side or less counts
    in full, somebody at ``width`` not at all.
    """
    on = far
    for k in range(count):
        dx, dy = ahead[0, k], ahead[1, k]
        along = dx * ux + dy * uy
        counts = min(2.0 - 2.0 * abs(dx * uy - dy * ux) / width, 1.0)
        if along > 0.0 and counts > 0.0:
            theirs = max(ahead[2, k] * ux + ahead[3, k] * uy, 0.0) * far / speed
            lost = far - max(along - CLOSE, 0.0) - theirs
            on = min(on, far - counts * max(lost, 0.0))
    return on


class ChooseCourse(Tactic):
    """People who are held up go where they get on.

    Args:
        haste: what a metre a second that a course loses of the way to the target costs, beside a
            metre a second of its change of velocity.  At 0 everybody goes straight.
        width: metres to the side at which somebody does not hold one up.

    Raises:
        ModelError: a number out of range.
    """

    name = "course_choice"

    def __init__(
        self,
        haste: Annotated[float, Range(0.0)] = 8.0,
        width: Annotated[float, Range(0.0, unit="m", above=True)] = 0.4,
    ) -> None:
        self.haste = haste
        self.width = width

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of those who get on faster on another course."""
        if not desired.newcomers and self.haste > 0.0:
            desired.points = choose_courses(
                deciding.pedestrians,
                deciding.inside,
                deciding.frame,
                sight_on(desired.targets.floor or deciding.site.plan, 0.0),
                desired.points,
                desired.speeds,
                CourseSettings(self.haste, self.width),
            )

    def compile_ahead(self) -> None:
        """Compile the comparison of courses."""
        (inside, plan), nowhere = nobody(), np.empty((0, 2))
        settings = CourseSettings(1.0, 1.0)
        sight = sight_on(plan, 0.0)
        choose_courses(inside.pedestrians, inside, 0, sight, nowhere, np.empty(0), settings)
