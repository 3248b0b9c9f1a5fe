"""Line of sight: whether a body can go straight from one point to another."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.compiled.simd import LANES, lowest_bit
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.geometry import (
    point_segment_distance2,
    segment_segment_distance2,
    segments_cross,
)
from mesa_mobility.floorplan.walls.sight import (
    FEW_WALLS,
    NO_WALL,
    TOUCH,
    Sight,
    cells_in_row,
    per_metre_up,
    rows_crossed,
    sight_on,
)
from mesa_mobility.floorplan.walls.wall_boxes import near_line

# Somebody close to a convex wall has to come a little nearer to it.
_OWN_SHARE = 0.5

# More than the rounding error of the distance between a wall and a line (metres).
_ROUNDING = 1e-6


@internal()
def clear_line(
    sight: Sight,
    px: float,
    py: float,
    qx: float,
    qy: float,
    clearance: float,
    own: float,
    ignored: int,
) -> bool:
    """Whether the segment pq stays `clearance` metres (and more than `TOUCH`) from the walls.

    `own` is the distance of p to the nearest wall, inf if nobody stands there. If it is less than
    the clearance, half of `own` suffices for walls near p. So somebody close to a wall has a view,
    and keeps it while they walk straight there. The wall with number `ignored` does not count
    (`NO_WALL`: all count).
    """
    table = sight.table
    if len(sight.walls) <= FEW_WALLS:
        return _clear_of_boxes(sight, px, py, qx, qy, clearance, own, ignored)
    first_row, last_row = rows_crossed(table, py, qy)
    share = per_metre_up(py, qy)
    for step in range(last_row - first_row + 1):
        # From p outwards: most views are blocked by something near.
        row = first_row + step if py <= qy else last_row - step
        first, last = cells_in_row(table, row, px, py, qx, share)
        for k in range(last - first + 1):
            column = first + k if px <= qx else last - k
            at = row * table.nx + column
            for j in range(table.offsets[at], table.offsets[at + 1]):
                wall = table.indices[j]
                if wall != ignored and _bars(sight, wall, px, py, qx, qy, clearance, own):
                    return False
    return True


@internal()
def _clear_of_boxes(
    sight: Sight,
    px: float,
    py: float,
    qx: float,
    qy: float,
    clearance: float,
    own: float,
    ignored: int,
) -> bool:
    """`clear_line` by the boxes around the walls."""
    reach = max(clearance, TOUCH) + _ROUNDING
    blocks = len(sight.boxed)
    outer = len(sight.boxes) - blocks
    for row in range(max(outer, 1)):
        near = (1 << blocks) - 1
        if outer > 0:
            near = near_line(sight.boxes, row, px, py, qx, qy, reach)
        while near != 0:
            block = LANES * row + lowest_bit(near)
            near &= near - 1
            walls = near_line(sight.boxes, outer + block, px, py, qx, qy, reach)
            while walls != 0:
                wall = sight.boxed[block, lowest_bit(walls)]
                walls &= walls - 1
                if wall != ignored and _bars(sight, wall, px, py, qx, qy, clearance, own):
                    return False
    return True


@internal()
def _bars(
    sight: Sight,
    wall: int,
    px: float,
    py: float,
    qx: float,
    qy: float,
    clearance: float,
    own: float,
) -> bool:
    """Whether the segment pq comes too near to a wall; see `clear_line`."""
    walls, solid = sight.walls, sight.solid
    ax, ay, bx, by = walls[wall, 0], walls[wall, 1], walls[wall, 2], walls[wall, 3]
    limit = clearance if wall < solid and clearance > TOUCH else TOUCH
    # The distance of their bounding boxes is fast to compute, and a lower bound.
    off_x = max(min(ax, bx) - max(px, qx), min(px, qx) - max(ax, bx), 0.0)
    off_y = max(min(ay, by) - max(py, qy), min(py, qy) - max(ay, by), 0.0)
    if off_x * off_x + off_y * off_y >= limit * limit:
        return False
    # So is that of a wall on one side of the line through p and q.
    dx = qx - px
    dy = qy - py
    a_side = dx * (ay - py) - dy * (ax - px)
    b_side = dx * (by - py) - dy * (bx - px)
    if a_side * b_side > 0.0:
        far = limit + _ROUNDING
        if min(a_side * a_side, b_side * b_side) >= far * far * (dx * dx + dy * dy):
            return False
    distance2 = segment_segment_distance2(px, py, qx, qy, ax, ay, bx, by)
    if distance2 >= limit * limit:
        return False
    if own < clearance and distance2 > TOUCH * TOUCH:
        near = point_segment_distance2(px, py, ax, ay, bx, by) < 4 * clearance**2
        if near and distance2 >= (_OWN_SHARE * own) ** 2:
            return False
    return True


@internal()
def unwalled(sight: Sight, px: float, py: float, qx: float, qy: float) -> bool:
    """Whether the segment pq neither crosses nor touches a wall.

    A wall that p stands on does not count, nor do lines that are no walls (see `Sight`).
    """
    table = sight.table
    if len(sight.walls) <= FEW_WALLS:
        return _unwalled_by_boxes(sight, px, py, qx, qy)
    first_row, last_row = rows_crossed(table, py, qy)
    share = per_metre_up(py, qy)
    for row in range(first_row, last_row + 1):
        first, last = cells_in_row(table, row, px, py, qx, share)
        for column in range(first, last + 1):
            at = row * table.nx + column
            for j in range(table.offsets[at], table.offsets[at + 1]):
                if _lies_across(sight, table.indices[j], px, py, qx, qy):
                    return False
    return True


@internal()
def _unwalled_by_boxes(sight: Sight, px: float, py: float, qx: float, qy: float) -> bool:
    """`unwalled` by the boxes around the walls."""
    reach = TOUCH + _ROUNDING
    blocks = len(sight.boxed)
    outer = len(sight.boxes) - blocks
    for row in range(max(outer, 1)):
        near = (1 << blocks) - 1
        if outer > 0:
            near = near_line(sight.boxes, row, px, py, qx, qy, reach)
        while near != 0:
            block = LANES * row + lowest_bit(near)
            near &= near - 1
            walls = near_line(sight.boxes, outer + block, px, py, qx, qy, reach)
            while walls != 0:
                wall = sight.boxed[block, lowest_bit(walls)]
                walls &= walls - 1
                if _lies_across(sight, wall, px, py, qx, qy):
                    return False
    return True


@internal()
def _lies_across(sight: Sight, wall: int, px: float, py: float, qx: float, qy: float) -> bool:
    """Whether a wall lies across the segment pq, and p does not stand on it."""
    ax, ay, bx, by = sight.walls[wall]
    return bool(
        wall < sight.solid
        and segment_segment_distance2(px, py, qx, qy, ax, ay, bx, by) == 0.0
        and point_segment_distance2(px, py, ax, ay, bx, by) > TOUCH * TOUCH
    )


@internal()
def free_length(sight: Sight, px: float, py: float, qx: float, qy: float) -> float:
    """Metres from p towards q until pq crosses a wall, or another line that no view crosses.

    It is the length of pq if pq crosses none. Walls that pq only touches do not count.
    """
    walls, table = sight.walls, sight.table
    dx = qx - px
    dy = qy - py
    nearest = 1.0
    first_row, last_row = rows_crossed(table, py, qy)
    share = per_metre_up(py, qy)
    for row in range(first_row, last_row + 1):
        first, last = cells_in_row(table, row, px, py, qx, share)
        for column in range(first, last + 1):
            at = row * table.nx + column
            for j in range(table.offsets[at], table.offsets[at + 1]):
                ax, ay, bx, by = walls[table.indices[j]]
                if segments_cross(px, py, qx, qy, ax, ay, bx, by):
                    t = ((ax - px) * (by - ay) - (ay - py) * (bx - ax)) / (
                        dx * (by - ay) - dy * (bx - ax)
                    )
                    nearest = min(nearest, t)
    return nearest * np.sqrt(dx * dx + dy * dy)


def line_of_sight(
    plan_or_walls: "Floor | ArrayLike", p: ArrayLike, q: ArrayLike, clearance: float = 0.0
) -> bool:
    """Whether the straight line from p to q (x, y in metres) stays `clearance` from all walls.

    It does not if it touches a wall, even with a clearance of 0. `plan_or_walls` is a floor
    plan or an (m, 4) array of wall segments.

    Raises FloorPlanError as `lines_of_sight` does.
    """
    ends = [np.asarray(end, dtype=np.float64).reshape(1, 2) for end in (p, q)]
    return bool(lines_of_sight(plan_or_walls, ends[0], ends[1], clearance)[0])


def lines_of_sight(
    plan_or_walls: "Floor | ArrayLike", p: ArrayLike, q: ArrayLike, clearance: float = 0.0
) -> NDArray[np.bool_]:
    """(n,) `line_of_sight` for every pair of rows of two (n, 2) arrays.

    Raises FloorPlanError for points that are not finite, arrays of different
    length, or a negative clearance.
    """
    starts = np.ascontiguousarray(np.asarray(p, dtype=np.float64).reshape(-1, 2))
    ends = np.ascontiguousarray(np.asarray(q, dtype=np.float64).reshape(-1, 2))
    if len(starts) != len(ends) or not (np.isfinite(starts).all() and np.isfinite(ends).all()):
        raise FloorPlanError(
            "lines of sight need two arrays of finite points of the same length, "
            f"found {len(starts)} and {len(ends)} points"
        )
    if not (np.isfinite(clearance) and clearance >= 0):
        raise FloorPlanError(f"clearance must be at least 0 m, found {clearance}")
    return _clear_lines(sight_on(plan_or_walls, float(clearance)), starts, ends, float(clearance))


@kept()
def _clear_lines(
    sight: Sight, starts: NDArray[np.float64], ends: NDArray[np.float64], clearance: float
) -> NDArray[np.bool_]:
    clear = np.empty(len(starts), dtype=np.bool_)
    for i in range(len(starts)):
        px, py = starts[i]
        qx, qy = ends[i]
        clear[i] = clear_line(sight, px, py, qx, qy, clearance, np.inf, NO_WALL)
    return clear
