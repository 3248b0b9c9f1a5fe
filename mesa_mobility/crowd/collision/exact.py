"""Exact collision tests of a path: walls, exits, and the committed paths of others.

Everything moves in straight lines between samples, so the closest approach between two samples
has a closed form, and what is tested is exactly what happens.  A person whose movement ends first
is taken to stand there until the other's ends, and this is tested both ways round.  Standing still
is then always safe.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import box_of, position_at, waypoint
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.floorplan.floor.geometry import segment_segment_distance2


@internal()
def wall_reach(farthest: float, core: float) -> float:
    """Distance in metres within which walls matter to somebody whose options lead ``farthest``."""
    return farthest + core + 0.01


@internal()
def near_walls(
    around: Surroundings,
    x: float,
    y: float,
    destination: int,
    reach: float,
    found: NDArray[np.float64],
) -> int:
    """Write walls within ``reach`` of (x, y): rows x1, y1, x2, y2, squared distance.

    Returns their number; ``found`` must have room for all of ``around.most_walls``.
    An exit that does not lead out for this person counts as a wall, and so do the edges of stairs
    for people who do not climb them.
    """
    cx = min(max(int((x - around.x0) / around.size), 0), around.nx - 1)
    cy = min(max(int((y - around.y0) / around.size), 0), around.ny - 1)
    cell = cy * around.nx + cx
    first, last = around.offsets[cell], around.offsets[cell + 1]
    count, walls, exits = 0, last - first, len(around.exits)
    steps = 0 if around.climbs[destination] else len(around.steps)
    for k in range(walls + exits + steps):
        if k < walls:
            wall = around.segments[around.indices[first + k]]
        elif k < walls + exits:
            if around.leads_out[destination, k - walls]:
                continue
            wall = around.exits[k - walls]
        else:
            wall = around.steps[k - walls - exits]
        d2 = segment_segment_distance2(x, y, x, y, wall[0], wall[1], wall[2], wall[3])
        if d2 <= reach * reach:
            for column in range(4):
                found[count, column] = wall[column]
            found[count, 4] = d2
            count += 1
    return count


@internal()
def hits_wall(
    path: NDArray[np.float64],
    segments: int,
    walls: NDArray[np.float64],
    radius: float,
    reach: float,
) -> bool:
    """Whether a disc moved along the first ``segments`` pieces of a path touches a wall.

    A disc that touches a wall at the start (a door closed beside it, say) may stay as close but not
    come closer.
    """
    r = radius + MARGIN
    least_x, least_y, most_x, most_y = box_of(path, segments)
    for w in range(len(walls)):
        d2 = walls[w, 4]
        if d2 > (reach + r) * (reach + r):
            continue
        limit = min(r * r, d2 * (1.0 - 1e-9))
        ax, ay, bx, by = walls[w, 0], walls[w, 1], walls[w, 2], walls[w, 3]
        x0, x1 = min(ax, bx) - r, max(ax, bx) + r
        y0, y1 = min(ay, by) - r, max(ay, by) + r
        if most_x < x0 or least_x > x1 or most_y < y0 or least_y > y1:
            continue
        for k in range(segments):
            px, py, qx, qy = path[0, k], path[1, k], path[0, k + 1], path[1, k + 1]
            if (px < x0 and qx < x0) or (px > x1 and qx > x1):
                continue
            if (py < y0 and qy < y0) or (py > y1 and qy > y1):
                continue
            if segment_segment_distance2(px, py, qx, qy, ax, ay, bx, by) < limit:
                return True
    return False


@internal()
def crosses_exit(
    path: NDArray[np.float64], segments: int, around: Surroundings, destination: int
) -> tuple[int, float]:
    """First piece of a path that crosses an exit of the person's destination, and the share of the
    piece up to there.

    Returns (-1, 0) if none does.
    """
    for k in range(segments):
        best = 2.0
        for e in range(len(around.exits)):
            if not around.leads_out[destination, e]:
                continue
            ax, ay, bx, by = around.exits[e]
            ux, uy = path[0, k + 1] - path[0, k], path[1, k + 1] - path[1, k]
            vx, vy = bx - ax, by - ay
            det = ux * vy - uy * vx
            if det == 0.0:
                continue
            wx, wy = ax - path[0, k], ay - path[1, k]
            u = (wx * vy - wy * vx) / det
            v = (wx * uy - wy * ux) / det
            if 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0 and u < best:
                best = u
        if best <= 1.0:
            return k, best
    return -1, 0.0


@internal()
def swept_collision(
    path: NDArray[np.float64],
    segments: int,
    spacing: int,
    frame: int,
    gone: int,
    table: OptionTable,
    state: CrowdState,
    j: int,
    clearance: float,
) -> bool:
    """Whether a path from ``frame`` on comes closer than ``clearance`` to the path of pedestrian j.

    The path has ``segments`` pieces of ``spacing`` frames. ``gone`` is the frame at which the path
    has crossed an exit, or -1. People beyond an exit still count. Of two who both leave, neither
    has to be able to stand until the other's movement ends.
    """
    my_end = frame + spacing * segments
    their_end, start, step = state.end[j], state.start[j], state.spacing[j]
    last = state.knots[j] - 1
    stop = max(my_end, their_end)
    if gone >= 0 and (state.gone[j] >= 0 or not state.active[j]):
        stop = min(stop, max(gone, min(my_end, their_end)))
    c = clearance + MARGIN
    limit = c * c
    jx, jy = position_at(state, table, j, frame)
    rx, ry = path[0, 0] - jx, path[1, 0] - jy
    now = rx * rx + ry * ry
    if now < limit:  # closer than allowed to begin with: may stay, not come closer
        limit = now * (1.0 - 1e-9)
    t = frame
    k = 0  # my piece at time t, and theirs
    p = min((frame - start) // step, last)
    share, their_share = 1.0 / spacing, 1.0 / step
    while t < stop:
        following = stop
        if k < segments:
            following = min(following, frame + spacing * (k + 1))
        if p < last:
            following = min(following, start + step * (p + 1))
        if following >= my_end:
            k = segments
            mx, my = path[0, k], path[1, k]
        else:
            if following == frame + spacing * (k + 1):
                k += 1
            u = (following - frame - spacing * k) * share
            mx = path[0, k] + u * (path[0, k + 1] - path[0, k])
            my = path[1, k] + u * (path[1, k + 1] - path[1, k])
        if following >= their_end:
            p = last
            jx, jy = state.to_x[j], state.to_y[j]
        else:
            if following == start + step * (p + 1):
                p += 1
            u = (following - start - step * p) * their_share
            ax, ay = waypoint(state, table, j, p)
            bx, by = waypoint(state, table, j, p + 1)
            jx, jy = ax + u * (bx - ax), ay + u * (by - ay)
        qx, qy = mx - jx, my - jy
        dx, dy = qx - rx, qy - ry
        length2 = dx * dx + dy * dy
        along = -(rx * dx + ry * dy)
        if along > 0.0 and length2 > 0.0:
            u = min(along / length2, 1.0)
            nx, ny = rx + u * dx, ry + u * dy
            if nx * nx + ny * ny < limit:
                return True
        elif rx * rx + ry * ry < limit:
            return True
        rx, ry = qx, qy
        t = following
    return False


@internal()
def gone_frame(frame: int, spacing: int, piece: int, where: float) -> int:
    """First whole frame after a path has crossed an exit on a piece."""
    return frame + max(1, math.ceil(spacing * (piece + where)))


@internal()
def exit_distance(around: Surroundings, x: float, y: float, destination: int) -> float:
    """Metres from (x, y) to the nearest open exit of this destination; inf if there is none."""
    nearest = np.inf
    for e in range(len(around.exits)):
        if around.leads_out[destination, e]:
            ax, ay, bx, by = around.exits[e]
            nearest = min(nearest, segment_segment_distance2(x, y, x, y, ax, ay, bx, by))
    return math.sqrt(nearest)
