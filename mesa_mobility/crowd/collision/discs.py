"""Exact collision tests of bodies of one to three discs along the facing.

The discs turn with the facing, so the tests need it all along a path.  While a body turns, its
discs are taken to move in straight lines from frame to frame, else from waypoint to waypoint.
Bodies of one disc get the tests of ``exact``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.collision.exact import hits_wall, swept_collision
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import box_of, facing_at_waypoint, position_at
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan.floor.geometry import segment_segment_distance2


class Apart(NamedTuple):
    """Where pedestrian i is from pedestrian j, metres, and the facings of the two, radians."""

    x: float
    y: float
    facing: float
    theirs: float


@internal()
def overhang_of(i: int, table: OptionTable, state: CrowdState) -> float:
    """By how much a circle that holds the body of pedestrian i exceeds its core, metres."""
    return float(table.shapes[state.type_index[i]].overhang * state.core[i])


@internal()
def body_hits_wall(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    walls: NDArray[np.float64],
    reach: float,
    table: OptionTable,
    state: CrowdState,
) -> bool:
    """Whether the body of pedestrian i touches a wall on the first pieces of a path.

    See ``hits_wall``; ``path`` (3, n) has the facing, and a piece takes ``spacing`` frames.
    """
    if overhang_of(i, table, state) == 0.0:
        return hits_wall(path, pieces, walls, state.core[i], reach)
    return _discs_hit_wall(i, path, pieces, spacing, walls, reach, table, state)


@internal()
def _discs_hit_wall(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    walls: NDArray[np.float64],
    reach: float,
    table: OptionTable,
    state: CrowdState,
) -> bool:
    shape, core = table.shapes[state.type_index[i]], state.core[i]
    far = core + overhang_of(i, table, state) + MARGIN
    first_c, first_s = math.cos(path[2, 0]), math.sin(path[2, 0])
    least_x, least_y, most_x, most_y = box_of(path, pieces)
    for w in range(len(walls)):
        if walls[w, 4] > (reach + far) * (reach + far):
            continue
        ax, ay, bx, by = walls[w, 0], walls[w, 1], walls[w, 2], walls[w, 3]
        x0, x1 = min(ax, bx) - far, max(ax, bx) + far
        y0, y1 = min(ay, by) - far, max(ay, by) + far
        if most_x < x0 or least_x > x1 or most_y < y0 or least_y > y1:
            continue
        for k in range(pieces):
            px, py, dx, dy = path[0, k], path[1, k], path[0, k + 1], path[1, k + 1]
            if (px < x0 and dx < x0) or (px > x1 and dx > x1):
                continue
            if (py < y0 and dy < y0) or (py > y1 and dy > y1):
                continue
            dx, dy, facing, turn = dx - px, dy - py, path[2, k], path[2, k + 1] - path[2, k]
            steps = spacing if turn != 0.0 else 1
            c, s = math.cos(facing), math.sin(facing)
            x, y = px, py
            for n in range(1, steps + 1):
                u = n / steps
                to_x, to_y = px + u * dx, py + u * dy
                to_c, to_s = math.cos(facing + u * turn), math.sin(facing + u * turn)
                for d in range(shape.discs):
                    off, r = core * shape.offset[d], core * shape.radius[d] + MARGIN
                    sx, sy = x + off * c, y + off * s
                    ex, ey = to_x + off * to_c, to_y + off * to_s
                    away2 = segment_segment_distance2(sx, sy, ex, ey, ax, ay, bx, by)
                    if away2 < r * r:
                        # A disc that touches a wall at the start may stay as close.
                        fx, fy = path[0, 0] + off * first_c, path[1, 0] + off * first_s
                        now2 = segment_segment_distance2(fx, fy, fx, fy, ax, ay, bx, by)
                        if away2 < now2 * (1.0 - 1e-9):
                            return True
                x, y, c, s = to_x, to_y, to_c, to_s
    return False


@internal()
def body_collides(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    frame: int,
    gone: int,
    table: OptionTable,
    state: CrowdState,
    j: int,
) -> bool:
    """Whether the body of pedestrian i on a path from ``frame`` on touches that of pedestrian j.

    See ``swept_collision``; ``path`` (3, n) has the facing.
    """
    if overhang_of(i, table, state) + overhang_of(j, table, state) == 0.0:
        return swept_collision(
            path, pieces, spacing, frame, gone, table, state, j, state.core[i] + state.core[j]
        )
    return _discs_collide(i, path, pieces, spacing, frame, gone, table, state, j)


@internal()
def _discs_collide(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    frame: int,
    gone: int,
    table: OptionTable,
    state: CrowdState,
    j: int,
) -> bool:
    my_end = frame + spacing * pieces
    their_end, start, step = state.end[j], state.start[j], state.spacing[j]
    last = state.knots[j] - 1
    stop = max(my_end, their_end)
    if gone >= 0 and (state.gone[j] >= 0 or not state.active[j]):
        stop = min(stop, max(gone, min(my_end, their_end)))
    apart = state.core[i] + overhang_of(i, table, state) + MARGIN
    apart += state.core[j] + overhang_of(j, table, state)
    x, y, facing = path[0, 0], path[1, 0], path[2, 0]
    jx, jy = position_at(state, table, j, frame)
    their_facing = _facing_at(state, table, j, frame)
    begin = Apart(x - jx, y - jy, facing, their_facing)
    t = frame
    while t < stop:
        k, p = min((t - frame) // spacing, pieces), min((t - start) // step, last)
        following = stop
        turning = False
        if k < pieces:
            following = min(following, frame + spacing * (k + 1))
            turning = path[2, k] != path[2, k + 1]
        if p < last:
            following = min(following, start + step * (p + 1))
            here = facing_at_waypoint(state, table, j, p)
            turning = turning or here != facing_at_waypoint(state, table, j, p + 1)
        if turning:
            following = min(following, t + 1)
        to_x, to_y, to_facing = _pose_on(path, pieces, spacing, following - frame)
        to_jx, to_jy = position_at(state, table, j, following)
        to_theirs = _facing_at(state, table, j, following)
        here = Apart(x - jx, y - jy, facing, their_facing)
        there = Apart(to_x - to_jx, to_y - to_jy, to_facing, to_theirs)
        if _comes_within(here.x, here.y, there.x, there.y, apart * apart) and _discs_meet(
            i, j, begin, here, there, table, state
        ):
            return True
        x, y, facing, jx, jy, their_facing = to_x, to_y, to_facing, to_jx, to_jy, to_theirs
        t = following
    return False


@internal()
def _discs_meet(
    i: int,
    j: int,
    begin: Apart,
    here: Apart,
    there: Apart,
    table: OptionTable,
    state: CrowdState,
) -> bool:
    """Whether discs of two people meet while these move from ``here`` to ``there``.

    ``begin`` is the start of the path: discs that are closer than allowed to begin with may stay,
    but not come closer.
    """
    mine, theirs = table.shapes[state.type_index[i]], table.shapes[state.type_index[j]]
    core, their_core = state.core[i], state.core[j]
    c0, s0 = math.cos(begin.facing), math.sin(begin.facing)
    e0, f0 = math.cos(begin.theirs), math.sin(begin.theirs)
    c1, s1 = math.cos(here.facing), math.sin(here.facing)
    e1, f1 = math.cos(here.theirs), math.sin(here.theirs)
    c2, s2 = math.cos(there.facing), math.sin(there.facing)
    e2, f2 = math.cos(there.theirs), math.sin(there.theirs)
    for a in range(mine.discs):
        off = core * mine.offset[a]
        for b in range(theirs.discs):
            other = their_core * theirs.offset[b]
            r = core * mine.radius[a] + their_core * theirs.radius[b] + MARGIN
            dx, dy = begin.x + off * c0 - other * e0, begin.y + off * s0 - other * f0
            limit = min(r * r, (dx * dx + dy * dy) * (1.0 - 1e-9))
            x, y = here.x + off * c1 - other * e1, here.y + off * s1 - other * f1
            to_x, to_y = there.x + off * c2 - other * e2, there.y + off * s2 - other * f2
            if _comes_within(x, y, to_x, to_y, limit):
                return True
    return False


@internal()
def _comes_within(x: float, y: float, to_x: float, to_y: float, limit: float) -> bool:
    """Whether a place that moves straight from (x, y) to another is ever nearer to (0, 0) than the
    root of ``limit``, m2."""
    dx, dy = to_x - x, to_y - y
    along, length2 = -(x * dx + y * dy), dx * dx + dy * dy
    if along > 0.0 and length2 > 0.0:
        u = min(along / length2, 1.0)
        x, y = x + u * dx, y + u * dy
    return x * x + y * y < limit


@internal()
def _pose_on(
    path: NDArray[np.float64], pieces: int, spacing: int, since: int
) -> tuple[float, float, float]:
    """Position and facing on a path some frames after its start."""
    k = since // spacing
    if k >= pieces:
        return path[0, pieces], path[1, pieces], path[2, pieces]
    u = (since - k * spacing) / spacing
    return (
        path[0, k] + u * (path[0, k + 1] - path[0, k]),
        path[1, k] + u * (path[1, k + 1] - path[1, k]),
        path[2, k] + u * (path[2, k + 1] - path[2, k]),
    )


@internal()
def _facing_at(state: CrowdState, table: OptionTable, j: int, frame: int) -> float:
    """Facing of pedestrian j in a frame, radians."""
    k = (frame - state.start[j]) // state.spacing[j]
    if k >= state.knots[j] - 1:
        return float(state.to_heading[j])
    u = (frame - state.start[j] - k * state.spacing[j]) / state.spacing[j]
    a = facing_at_waypoint(state, table, j, k)
    return float(a + u * (facing_at_waypoint(state, table, j, k + 1) - a))


@internal()
def discs_touch(i: int, j: int, table: OptionTable, state: CrowdState) -> bool:
    """Whether discs of two people are closer to one another than they may come."""
    x, y = state.x[i] - state.x[j], state.y[i] - state.y[j]
    mine, theirs = table.shapes[state.type_index[i]], table.shapes[state.type_index[j]]
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    e, f = math.cos(state.heading[j]), math.sin(state.heading[j])
    for a in range(mine.discs):
        off = state.core[i] * mine.offset[a]
        for b in range(theirs.discs):
            other = state.core[j] * theirs.offset[b]
            r = state.core[i] * mine.radius[a] + state.core[j] * theirs.radius[b] + MARGIN
            dx, dy = x + off * c - other * e, y + off * s - other * f
            if dx * dx + dy * dy < r * r:
                return True
    return False
