"""Where people pass a corner when there are so many that not all can pass close by it."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.floorplan.aiming import past_corner
from mesa_mobility.floorplan.routes import Ways
from mesa_mobility.floorplan.sight import NO_WALL, Sight, clear_line, free_length, wall_distance
from mesa_mobility.jit import lean

# Nobody counts as nearer to the corner, or to the place to pass at, than this (metres).
_THERE = 0.05


@njit(cache=True, nogil=True)
def pass_abreast(
    sight: Sight,
    ways: Ways,
    positions: NDArray[np.float64],
    corners: NDArray[np.int64],
    areas: NDArray[np.float64],
    points: NDArray[np.float64],
) -> None:
    """Move the targets, (n, 2) `points`, of people who pass abreast; see `Router.abreast`.

    What follows the corner is in view from all of the line that leads on from there through the
    corner, and beyond it: people pass at the place of that line nearest to them.
    """
    clearance = ways.view_clearance
    for k in range(len(corners)):
        if corners[k, 0] < 0 or areas[k] <= 0.0:
            continue
        x, y = positions[k]
        cx, cy = ways.xy[corners[k, 0]]
        nx, ny = ways.xy[corners[k, 1]]
        onward = np.hypot(cx - nx, cy - ny)
        if onward == 0.0:
            continue
        ux, uy = (cx - nx) / onward, (cy - ny) / onward
        away = max(np.hypot(x - cx, y - cy), _THERE)
        out = min((x - cx) * ux + (y - cy) * uy, areas[k] / away)
        if out <= 0.0:
            continue
        end = out + clearance
        out = min(out, free_length(sight, cx, cy, cx + end * ux, cy + end * uy) - clearance)
        if out <= 0.0 or not _is_wide(sight, ways, x, y, cx, cy, ux, uy, out, onward):
            continue
        qx, qy = cx + out * ux, cy + out * uy
        own = wall_distance(sight, x, y, clearance)
        if np.hypot(qx - x, qy - y) > _THERE and clear_line(
            sight, x, y, qx, qy, clearance, own, NO_WALL
        ):
            # Not to a row: to check the shape of what it gets takes Numba 2 s to compile.
            points[k, 0], points[k, 1] = past_corner(sight, ways, x, y, qx, qy, corners[k, 1])


@lean()
def _is_wide(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    cx: float,
    cy: float,
    ux: float,
    uy: float,
    out: float,
    onward: float,
) -> bool:
    """Whether those who pass a corner as far as `out` from it have room to go on side by side.

    Past a jamb they have not: it is for the door that people wait there. The room is as deep
    as it is wide, seen from (x, y) behind the line (ux, uy) through corner c; doors and aisles,
    up to the length of a step beyond an opening, are not wide at all.
    """
    deep = max(out, ways.beyond)
    side = 1.0 if (x - cx) * uy - (y - cy) * ux > 0.0 else -1.0
    wx, wy = -side * deep * uy, side * deep * ux
    on = min(deep, onward)
    qx, qy = cx + out * ux, cy + out * uy
    fx, fy = cx + wx - on * ux, cy + wy - on * uy
    gx, gy = qx + wx, qy + wy
    return (
        clear_line(sight, cx, cy, fx, fy, 0.0, np.inf, NO_WALL)
        and clear_line(sight, qx, qy, fx, fy, 0.0, np.inf, NO_WALL)
        and clear_line(sight, qx, qy, gx, gy, 0.0, np.inf, NO_WALL)
        and clear_line(sight, gx, gy, fx, fy, 0.0, np.inf, NO_WALL)
        and clear_line(sight, cx, cy, gx, gy, 0.0, np.inf, NO_WALL)
    )
