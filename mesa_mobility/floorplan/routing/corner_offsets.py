"""The distance at which people in a crowd pass a corner."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.floorplan.routing.route_graph import Ways
from mesa_mobility.floorplan.routing.target_points import past_corner
from mesa_mobility.floorplan.walls.line_of_sight import clear_line, free_length
from mesa_mobility.floorplan.walls.sight import NO_WALL, Sight
from mesa_mobility.floorplan.walls.wall_distances import wall_distance

# Least distance to the corner, or to the place to pass it, that is taken into account (metres).
_THERE = 0.05
# Greatest width of a way that is measured (metres).
_WIDEST = 50.0
# How far past a corner the width of the way on is measured (metres): more than a corner of a route
# keeps from the wall.
_PAST = 0.5


@kept(nogil=True)
def pass_abreast(
    sight: Sight,
    ways: Ways,
    positions: NDArray[np.float64],
    corners: NDArray[np.int64],
    areas: NDArray[np.float64],
    points: NDArray[np.float64],
) -> None:
    """Move the targets, (n, 2) `points`, of people who pass abreast; see `Router.abreast`.

    The next node is in view from the whole line through it and the corner, extended beyond the
    corner. People pass at the point of that line nearest to them.
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
        beside = corners[k, 0] in ways.flight_corners
        room = _room(sight, (x, y), (cx, cy), (ux, uy), beside)
        out = min(out, room - clearance)
        if out <= 0.0 or not (
            beside or _is_wide(sight, ways, (x, y), (cx, cy), (ux, uy), out, onward)
        ):
            continue
        qx, qy = cx + out * ux, cy + out * uy
        own = wall_distance(sight, x, y, clearance)
        if np.hypot(qx - x, qy - y) > _THERE and clear_line(
            sight, x, y, qx, qy, clearance, own, NO_WALL
        ):
            # Not assigned as a row: the check of its shape takes Numba 2 s to compile.
            points[k, 0], points[k, 1] = past_corner(sight, ways, x, y, qx, qy, corners[k, 1])


@internal()
def _room(
    sight: Sight,
    person: tuple[float, float],
    corner: tuple[float, float],
    along: tuple[float, float],
    beside: bool,
) -> float:
    """How far from a corner people can pass it and then go on side by side, metres.

    It is the width of the way up to the corner, along the line ``along`` through it, as far as the
    way on is as wide, just past the corner. As much as the way on is narrower, they have less room:
    they queue for what comes then. Where it is half as wide, all pass at the corner. `beside` a
    flight they have its whole width: they queue on the flight as they do before it.
    """
    (x, y), (cx, cy), (ux, uy) = person, corner, along
    before = free_length(sight, cx, cy, cx + _WIDEST * ux, cy + _WIDEST * uy)
    side = 1.0 if (x - cx) * uy - (y - cy) * ux > 0.0 else -1.0
    px, py = cx - _PAST * ux, cy - _PAST * uy
    on = free_length(sight, px, py, px - side * _WIDEST * uy, py + side * _WIDEST * ux)
    return min(before, on) if beside else min(before, 2.0 * on - before)


@internal()
def _is_wide(
    sight: Sight,
    ways: Ways,
    person: tuple[float, float],
    corner: tuple[float, float],
    along: tuple[float, float],
    out: float,
    onward: float,
) -> bool:
    """Whether people who pass a corner up to `out` metres from it have room to go on side by side.

    Past a jamb they have not: people wait there for the door. The room must be as deep as it is
    wide, seen by a person behind the line `along` through the corner. Doors and aisles, up to the
    length of a step beyond an opening, do not count as wide.
    """
    (x, y), (cx, cy), (ux, uy) = person, corner, along
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
