"""People ahead of somebody who walks, and whom of them they would come too near.

All numbers of the people in a grid are kept in the grid's order, so that those near each other are
read in sequence, several at once.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from mesa_mobility.behaviors.right_of_way import OPPOSED
from numpy.typing import NDArray

from mesa_mobility.steering import (
    CrowdState,
    Grid,
    Sight,
    cells_within,
    compiled,
    inner,
    unwalled,
)

ROOM, SLIM = 0.65, 0.28
"""Metres between the middles of two people who pass each other freely, if their core radii add up
to ``SLIM`` metres. Between wider bodies is as much room."""

SHARE = 0.6
"""Share of the present distance that the room asked for is at most: nobody can demand room of
people who are near already."""

REACH = 9.0
"""Metres within which people count."""

SLOWEST, RAMP = 0.9, 0.5
"""Relative speed from which on people count, and by how much more they count in full, m/s."""

HALFWAY = 4.0
"""Present distance at which somebody counts half, metres."""

WEIGHT = 3.0
"""Change of velocity that people accept so as not to walk into another person, m/s."""

QUEUES = 0.5
"""Speed below which somebody who is on the way is held up, m/s."""

SAME_WAY = 0.5
"""Cosine of the angle between the ways of two people up to which they go the same way."""

VX, VY, WAY_X, WAY_Y, LIMIT, CORE = range(6)
MOTION_FIELDS = 6
"""Rows of the table of motion: velocity, m/s; the way to the target, metres; how far that may lead
along the way of another for whom somebody still counts, metres; core radius, metres."""

AHEAD_FIELDS = 7
"""Rows of the table of people ahead: place from the walker, metres; velocity, m/s; how much they
count, m/s; the square of the room that is asked of them, square metres; and workspace."""


class Found(NamedTuple):
    """People whom a search has found; of one thread.

    Attributes:
        who: (n + 1,) their places in the grid of n people; the one more is workspace.
        marks: (n,) 1 for those in the grid who are found, 0 for others.
    """

    who: NDArray[np.int64]
    marks: NDArray[np.float64]


def room_to_find(people: int) -> Found:
    """Room for so many people to be found."""
    return Found(np.empty(people + 1, dtype=np.int64), np.empty(people))


@compiled()
def note_motion(
    grid: Grid,
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    motion: NDArray[np.float64],
) -> None:
    """Write the (``MOTION_FIELDS``, n) motion of the n people in a grid, in its order.

    Those who stay where they are always count, and those who are held up in a queue never do.
    """
    for a in range(len(grid.people)):
        j = grid.people[a]
        vx, vy = state[j].vx, state[j].vy
        dx, dy = state[j].target_x - state[j].x, state[j].target_y - state[j].y
        limit = SAME_WAY * math.sqrt(dx * dx + dy * dy)
        if (dx == 0.0 and dy == 0.0) or agenda[j]["waits_until"] > frame:
            limit = np.inf
        elif vx * vx + vy * vy < QUEUES * QUEUES:
            limit = -np.inf
        motion[VX, a], motion[VY, a] = vx, vy
        motion[WAY_X, a], motion[WAY_Y, a], motion[LIMIT, a] = dx, dy, limit
        motion[CORE, a] = state[j].core


@inner()
def find_ahead(
    place: tuple[float, float],
    way: tuple[float, float],
    speed: float,
    core: float,
    grid: Grid,
    motion: NDArray[np.float64],
    found: Found,
    ahead: NDArray[np.float64],
) -> int:
    """Write those who count for somebody at ``place`` who walks along ``way``, a unit vector.

    Those who go the same way and those held up in a queue do not count; see ``note_motion``.

    Args:
        place: metres.
        way: the unit vector.
        speed: of the walker, m/s.
        core: radius of the walker, metres.
        grid: everybody inside.
        motion: of the people in the grid.
        found: workspace.
        ahead: (``AHEAD_FIELDS``, room for everybody), is written.

    Returns:
        Their number.
    """
    (px, py), (ex, ey) = place, way
    ux, uy = speed * ex, speed * ey
    first, last, low, high = cells_within(grid, px, py, REACH)
    count = 0
    for row in range(low, high + 1):
        start = grid.offsets[row * grid.nx + first]
        end = grid.offsets[row * grid.nx + last + 1]
        count = _ahead_in_run(start, end, (px, py, ex, ey, ux, uy), grid, motion, found, count)
    full = 1.0 / ((SLOWEST + RAMP) * (SLOWEST + RAMP) - SLOWEST * SLOWEST)
    for k in range(count):
        a = found.who[k]
        x, y = grid.x[a] - px, grid.y[a] - py
        vx, vy = motion[VX, a], motion[VY, a]
        wx, wy = vx - ux, vy - uy
        excess = wx * wx + wy * wy - SLOWEST * SLOWEST
        weight = WEIGHT * min(excess * full, 1.0)
        ahead[0, k], ahead[1, k], ahead[2, k], ahead[3, k] = x, y, vx, vy
        ahead[4, k] = weight * HALFWAY / (HALFWAY + math.sqrt(x * x + y * y))
        room = ROOM + (core + motion[CORE, a] - SLIM)
        ahead[5, k] = min(room * room, SHARE * SHARE * (x * x + y * y))
    return count


@inner()
def _ahead_in_run(
    start: int,
    end: int,
    walker: tuple[float, float, float, float, float, float],
    grid: Grid,
    motion: NDArray[np.float64],
    found: Found,
    count: int,
) -> int:
    """Add those of the people ``start`` to ``end`` of the grid who count to ``found``.

    Returns how many there are by then.
    """
    px, py, ex, ey, ux, uy = walker
    x, y = grid.x[start:end], grid.y[start:end]
    vx, vy = motion[VX, start:end], motion[VY, start:end]
    way_x, way_y = motion[WAY_X, start:end], motion[WAY_Y, start:end]
    limit = motion[LIMIT, start:end]
    marks = found.marks[start:end]
    for k in range(end - start):
        dx, dy = x[k] - px, y[k] - py
        wx, wy = vx[k] - ux, vy[k] - uy
        counts = dx * ex + dy * ey > 0.0
        counts &= dx * dx + dy * dy <= REACH * REACH
        counts &= wx * wx + wy * wy > SLOWEST * SLOWEST
        counts &= way_x[k] * ex + way_y[k] * ey <= limit[k]
        marks[k] = 1.0 if counts else 0.0
    return _marked(start, end, found, count)


@inner()
def _marked(start: int, end: int, found: Found, count: int) -> int:
    """Add those of the people ``start`` to ``end`` of the grid who are marked to ``found``.

    Returns how many there are by then.
    """
    who, marks = found.who, found.marks[start:end]
    for k in range(end - start):
        who[count] = start + k
        count += int(marks[k])
    return count


@inner()
def find_between(
    way: tuple[float, float, float, float, float],
    reach: float,
    grid: Grid,
    motion: NDArray[np.float64],
    found: Found,
) -> int:
    """Write those on this side of somebody's target to ``found``, by their places in the grid.

    Args:
        way: place of the walker, unit vector to their target, and how far that is away; metres.
        reach: metres within which people count.
        grid: everybody inside.
        motion: of the people in the grid.
        found: is written.

    Returns:
        Their number.
    """
    px, py, ex, ey, away = way
    first, last, low, high = cells_within(grid, px, py, reach)
    count = 0
    for row in range(low, high + 1):
        start = grid.offsets[row * grid.nx + first]
        end = grid.offsets[row * grid.nx + last + 1]
        x, y, marks = grid.x[start:end], grid.y[start:end], found.marks[start:end]
        for k in range(end - start):
            dx, dy = x[k] - px, y[k] - py
            along = dx * ex + dy * ey
            counts = (along > 0.0) & (along < away) & (dx * dx + dy * dy <= reach * reach)
            marks[k] = 1.0 if counts else 0.0
        count = _marked(start, end, found, count)
    return count


@inner()
def somebody_comes(
    way: tuple[float, float, float, float, float],
    reach: float,
    grid: Grid,
    motion: NDArray[np.float64],
    sight: Sight,
    found: Found,
) -> bool:
    """Whether somebody in view, on this side of a target, wants to go the other way, at more than
    120 degrees.

    People who wait do not: they always count for others, which is what an endless limit says.

    Args:
        way: as of ``find_between``.
        reach: metres within which people count.
        grid: everybody inside.
        motion: of the people in the grid.
        sight: the walls.
        found: workspace.
    """
    px, py, ex, ey, _ = way
    count = find_between(way, reach, grid, motion, found)
    for k in range(count):
        a = found.who[k]
        way_x, way_y = motion[WAY_X, a], motion[WAY_Y, a]
        theirs = way_x * ex + way_y * ey
        if (
            theirs < 0.0
            and theirs * theirs > OPPOSED * OPPOSED * (way_x * way_x + way_y * way_y)
            and motion[LIMIT, a] < np.inf
            and unwalled(sight, px, py, grid.x[a], grid.y[a])
        ):
            return True
    return False


@inner()
def any_too_near(
    ux: float, uy: float, horizon: float, ahead: NDArray[np.float64], count: int
) -> bool:
    """Whether somebody who walks at (ux, uy) comes too near to any of those ahead; see
    ``anticipation``."""
    x, y, vx, vy, room2, near = ahead[0], ahead[1], ahead[2], ahead[3], ahead[5], ahead[6]
    for k in range(count):
        wx, wy = vx[k] - ux, vy[k] - uy
        towards = -(x[k] * wx + y[k] * wy)
        time = min(towards / (wx * wx + wy * wy), horizon)
        dx, dy = x[k] + wx * time, y[k] + wy * time
        near[k] = 1.0 if (towards > 0.0) & (dx * dx + dy * dy < room2[k]) else 0.0
    number = 0.0
    for k in range(count):
        number += near[k]
    return number > 0.0


@inner()
def seen(place: tuple[float, float], sight: Sight, ahead: NDArray[np.float64], k: int) -> bool:
    """Whether no wall hides the k-th of those ahead from ``place``."""
    px, py = place
    return bool(unwalled(sight, px, py, px + ahead[0, k], py + ahead[1, k]))
