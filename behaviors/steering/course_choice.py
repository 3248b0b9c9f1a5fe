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
from mesa_mobility.behaviors.steering.anticipation import GAINS, turns
from mesa_mobility.behaviors.steering.people_ahead import (
    MOTION_FIELDS,
    VX,
    VY,
    Found,
    find_between,
    note_motion,
    room_to_find,
    somebody_comes,
)
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Range, Tactic
from mesa_mobility.steering import (
    CrowdState,
    CrowdView,
    Grid,
    Sight,
    by_shares,
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

_LANES = 2 * STEPS + 2
"""Number of courses; the last is the first once more, since a processor takes 8 at a time."""

_FIELDS = 4

ROUNDING = 1e-9
"""Square metres."""


def _course_table() -> NDArray[np.float64]:
    """(7, ``_LANES``) cosine and sine of the turn of each course, and the change of velocity that
    it takes, as a share of the speed. The other rows are written for each person: the direction
    (x, y) of each course, metres that they get on it, and the same behind a single person."""
    angles = np.append(turns(STEPS), 0.0)
    courses = np.zeros((7, _LANES))
    courses[0], courses[1] = np.cos(angles), np.sin(angles)
    courses[2] = np.sqrt(2.0 - 2.0 * courses[0])
    return courses


_COURSE_TABLE = _course_table()


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
    motion = np.empty((MOTION_FIELDS, n))
    note_motion(grid, frame, crowd.records, crowd.agenda, motion)
    around = _Around(grid, sight, crowd.records, motion)

    def choose(own: slice) -> None:
        ahead, found = np.empty((_FIELDS, n)), room_to_find(n)
        courses = _COURSE_TABLE.copy()
        _choose_courses(
            rows[own], around, points[own], speeds[own], settings, courses, ahead, found
        )

    by_shares(choose, len(rows))
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
    found: Found,
) -> None:
    """Change ``points`` as of ``choose_courses``.

    ``ahead`` and ``found`` have room for everybody; ``courses`` is of ``_course_table``. Each
    thread has its own.
    """
    state, sight, width = around.state, around.sight, settings.width
    cosine, change, ux, uy, on = courses[0], courses[2], courses[3], courses[4], courses[5]
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
        way = (x, y, ex, ey, away)
        count = find_between(way, REACH, around.grid, around.motion, found)
        for m in range(count):
            a = found.who[m]
            ahead[0, m], ahead[1, m] = around.grid.x[a] - x, around.grid.y[a] - y
            ahead[2, m], ahead[3, m] = around.motion[VX, a], around.motion[VY, a]
        if not _held_up(ex, ey, far, speed, width, ahead, count):
            continue
        if somebody_comes(way, COMING, around.grid, around.motion, sight, found):
            continue
        _set_courses(ex, ey, far, courses)
        most = far
        for m in range(count):
            dx, dy, near = ahead[0, m], ahead[1, m], most + CLOSE
            # Farther people hold nobody up by more than others do already.
            if dx * dx + dy * dy < near * near + width * width + ROUNDING:
                most = _hold_up(x, y, far, speed, width, ahead, m, sight, courses)
        best, at = np.inf, 0
        for n in range(_LANES):
            cost = speed * change[n]
            if cost < best:
                cost += settings.haste * speed * (1.0 - cosine[n] * on[n] / far)
            if cost < best and (n == 0 or unwalled(sight, x, y, x + far * ux[n], y + far * uy[n])):
                best, at = cost, n
        points[k, 0], points[k, 1] = x + away * ux[at], y + away * uy[at]


@inner()
def _held_up(
    ex: float,
    ey: float,
    far: float,
    speed: float,
    width: float,
    ahead: NDArray[np.float64],
    count: int,
) -> bool:
    """Whether somebody who walks ``far`` along (ex, ey) catches up with anybody."""
    held_up = 0
    for k in range(count):
        held_up += int(_gets_on(ex, ey, far, speed, width, ahead, k) < far)
    return held_up > 0


@inner()
def _gets_on(
    ux: float, uy: float, far: float, speed: float, width: float, ahead: NDArray[np.float64], k: int
) -> float:
    """Metres that somebody gets along (ux, uy) behind the k-th of those ahead, in the time in which
    they would walk ``far``.

    They follow whoever they catch up with.  Somebody half of ``width`` to the side or less counts
    in full, somebody at ``width`` not at all.
    """
    dx, dy = ahead[0, k], ahead[1, k]
    along = dx * ux + dy * uy
    counts = min(2.0 - 2.0 * abs(dx * uy - dy * ux) / width, 1.0)
    theirs = max(ahead[2, k] * ux + ahead[3, k] * uy, 0.0) * far / speed
    lost = far - max(along - CLOSE, 0.0) - theirs
    return far - counts * max(lost, 0.0) if (along > 0.0) & (counts > 0.0) else far


@inner()
def _set_courses(ex: float, ey: float, far: float, courses: NDArray[np.float64]) -> None:
    """Write the directions of courses round (ex, ey), and that nobody is in their way."""
    cosine, sine, ux, uy, on = courses[0], courses[1], courses[3], courses[4], courses[5]
    for n in range(_LANES):
        ux[n] = cosine[n] * ex - sine[n] * ey
        uy[n] = sine[n] * ex + cosine[n] * ey
        on[n] = far


@inner()
def _hold_up(
    x: float,
    y: float,
    far: float,
    speed: float,
    width: float,
    ahead: NDArray[np.float64],
    k: int,
    sight: Sight,
    courses: NDArray[np.float64],
) -> float:
    """Lower how far somebody at (x, y) gets on each course, if the k-th of those ahead is in view.

    Whether they are is looked up only for those who would lower it.

    Returns the most that they get on any course.
    """
    ux, uy, on, behind = courses[3], courses[4], courses[5], courses[6]
    lowered = 0
    for n in range(_LANES):
        behind[n] = _gets_on(ux[n], uy[n], far, speed, width, ahead, k)
        lowered += int(behind[n] < on[n])
    if lowered > 0 and unwalled(sight, x, y, x + ahead[0, k], y + ahead[1, k]):
        for n in range(_LANES):
            on[n] = min(on[n], behind[n])
    most = 0.0
    for n in range(_LANES):
        most = max(most, on[n])
    return most


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
