"""Walls prepared for views: their boxes, and a grid of cells that a line is followed through."""

from typing import NamedTuple, cast
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.wall_index import CellTable, as_segments, cell_table
from mesa_mobility.floorplan.walls.wall_boxes import boxes_around

TOUCH = 1e-9
"""A line nearer to a wall than this touches it (metres)."""

NO_WALL = np.int64(-1)
"""Stands for no wall; typed, as functions are compiled again for literal numbers."""

# Least side of a grid cell (metres).
_CELL = 1.0

FEW_WALLS = 512
"""Up to this many walls, boxes are the fastest test of which are near a line; beyond, the grid."""


class Sight(NamedTuple):
    """Wall segments and their grid, as the compiled functions take them.

    The first `solid` rows of `walls` are walls; the others are lines that no view
    crosses but that need no clearance. `boxes` and `boxed` are their boxes and numbers from
    `boxes_around`, empty if there are many walls.
    """

    walls: NDArray[np.float64]
    solid: int
    table: CellTable
    boxes: NDArray[np.float64]
    boxed: NDArray[np.int64]


def sight_of(walls: ArrayLike, curtains: ArrayLike, reach: float) -> Sight:
    """Prepare walls (m, 4), and lines not to be crossed (k, 4), for views of clearance `reach`."""
    solid = as_segments(walls)
    rows = np.concatenate([solid, as_segments(curtains)])
    extent = float(np.ptp(rows.reshape(-1, 2), axis=0).max()) if len(rows) else 1.0
    # The extra millimetre keeps walls that rounding would put just out of reach of a cell.
    table = cell_table(rows, max(_CELL, extent / 400), reach + 1e-3)
    boxes, boxed = boxes_around(rows if len(rows) <= FEW_WALLS else rows[:0])
    return Sight(rows, len(solid), table, boxes, boxed)


_CACHE: "WeakKeyDictionary[Floor, tuple[int, float, Sight]]" = WeakKeyDictionary()


def sight_on(plan_or_walls: "Floor | ArrayLike", clearance: float) -> Sight:
    """The walls of a plan, or (m, 4) walls, for views of this clearance; that of a plan is kept."""
    if not hasattr(plan_or_walls, "walls"):
        return sight_of(plan_or_walls, (), clearance)
    plan = cast(Floor, plan_or_walls)
    found = _CACHE.get(plan)
    if found is None or found[0] != plan.version or found[1] < clearance:
        found = (plan.version, clearance, sight_of(plan.walls, (), clearance))
        _CACHE[plan] = found
    return found[2]


@internal()
def rows_crossed(table: CellTable, py: float, qy: float) -> tuple[int, int]:
    """First and last row of the grid that a segment from y = py to y = qy meets."""
    first = int(np.floor((min(py, qy) - table.y0) / table.cell_size))
    last = int(np.floor((max(py, qy) - table.y0) / table.cell_size))
    return max(0, first), min(table.ny - 1, last)


@internal()
def per_metre_up(py: float, qy: float) -> float:
    """Share of a segment from y = py to y = qy that lies within a metre of y; 0 if it is level."""
    return 1.0 / (qy - py) if py != qy else 0.0


@internal()
def cells_in_row(
    table: CellTable, row: int, px: float, py: float, qx: float, share: float
) -> tuple[int, int]:
    """First and last column of the cells of one row that a segment pq meets.

    `share` is `per_metre_up` of its ends. Rounding errors are within the extra millimetre.
    """
    cell = table.cell_size
    t0 = 0.0
    t1 = 1.0
    if share != 0.0:
        ta = (table.y0 + row * cell - py) * share
        tb = (table.y0 + (row + 1) * cell - py) * share
        t0 = min(1.0, max(0.0, min(ta, tb)))
        t1 = max(0.0, min(1.0, max(ta, tb)))
    xa = px + t0 * (qx - px)
    xb = px + t1 * (qx - px)
    per_cell = 1.0 / cell
    first = int(np.floor((min(xa, xb) - table.x0) * per_cell))
    last = int(np.floor((max(xa, xb) - table.x0) * per_cell))
    return max(0, first), min(table.nx - 1, last)
