"""Cache of the nodes that may be in view from each square of floor, filled on demand.

Most nodes of a hall full of seat rows are hidden from most of it. A square of floor is hidden from
a node if one wall crosses the lines from the node to all four corners of the square: it then
crosses the line to every point of the square.
"""

from typing import NamedTuple

import numpy as np
from numba.cpython.unsafe.numbers import trailing_zeros
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import inlined, internal
from mesa_mobility.floorplan.floor.geometry import segments_cross
from mesa_mobility.floorplan.walls.sight import (
    NO_WALL,
    Sight,
    cells_in_row,
    per_metre_up,
    rows_crossed,
)

_CELL = 0.5
_MOST_WORDS = 1 << 22
_ROWS = 64


class Views(NamedTuple):
    """For each square of floor, one bit per node: set where the node may be in view.

    `row` (squares,) is 0 for squares that are not known yet, else one more than their row of `bits`
    (rows, words), with node i in bit i % 64 of word i // 64; `known` (1,) is the number of known
    squares, and of rows in use.
    """

    x0: float
    y0: float
    nx: int
    ny: int
    cell_size: float
    row: NDArray[np.int32]
    bits: NDArray[np.uint64]
    known: NDArray[np.int64]


def no_views(bounds: tuple[float, float, float, float], nodes: int) -> Views:
    """Views of a floor with these bounds (metres), none known yet."""
    words = max(1, -(-nodes // 64))
    xmin, ymin, xmax, ymax = bounds
    cell = _CELL
    while ((xmax - xmin) / cell + 1) * ((ymax - ymin) / cell + 1) * words > _MOST_WORDS:
        cell *= 2
    nx, ny = int((xmax - xmin) / cell) + 1, int((ymax - ymin) / cell) + 1
    row, bits = np.zeros(nx * ny, np.int32), np.zeros((_ROWS, words), np.uint64)
    return Views(xmin, ymin, nx, ny, cell, row, bits, np.zeros(1, np.int64))


def with_room(views: Views) -> Views:
    """The same views with twice the room."""
    return views._replace(bits=np.concatenate([views.bits, np.zeros_like(views.bits)]))


@internal()
def _square(views: Views, x: float, y: float) -> int:
    """Number of the square around (x, y), -1 off the floor."""
    column = int(np.floor((x - views.x0) / views.cell_size))
    row = int(np.floor((y - views.y0) / views.cell_size))
    inside = 0 <= column < views.nx and 0 <= row < views.ny
    return row * views.nx + column if inside else -1


@internal()
def is_known(views: Views, x: float, y: float) -> bool:
    """Whether the view from the square around (x, y) is known."""
    square = _square(views, x, y)
    return square >= 0 and views.row[square] > 0


@internal()
def has_room(views: Views) -> bool:
    """Whether there is room for another square."""
    return views.known[0] < len(views.bits)


@inlined()
def nodes_maybe_in_view(
    sight: Sight,
    views: Views,
    places: NDArray[np.float64],
    x: float,
    y: float,
    found: NDArray[np.int64],
) -> int:
    """Write the nodes that may be in view from (x, y) to `found`; returns their number.

    `places` is (nodes, 2) metres. If the square is not known yet, there must be room for it.
    """
    nodes = len(places)
    square = _square(views, x, y)
    if square < 0:
        for i in range(nodes):
            found[i] = i
        return nodes
    if views.row[square] == 0:
        row, column = divmod(square, views.nx)
        left = views.x0 + column * views.cell_size
        low = views.y0 + row * views.cell_size
        wall = NO_WALL
        for i in range(nodes):
            wall = _hiding(sight, left, low, views.cell_size, places[i, 0], places[i, 1], wall)
            if wall == NO_WALL:
                views.bits[views.known[0], i // 64] |= np.uint64(1) << np.uint64(i % 64)
        views.known[0] += 1
        views.row[square] = views.known[0]
    row = views.row[square] - 1
    count = 0
    for word in range(views.bits.shape[1]):
        bits = views.bits[row, word]
        while bits != np.uint64(0):
            found[count] = 64 * word + np.int64(trailing_zeros(bits))
            count += 1
            bits &= bits - np.uint64(1)
    return count


@internal()
def _hiding(
    sight: Sight, left: float, low: float, side: float, qx: float, qy: float, first: np.int64
) -> np.int64:
    """A wall that hides the whole square from q, `NO_WALL` if there is none.

    `first` is tested before the others: a wall that hides one point mostly hides the next as well.
    """
    walls, solid, table = sight.walls, sight.solid, sight.table
    px = left + side / 2
    py = low + side / 2
    if first != NO_WALL and _hides(walls, first, left, low, side, qx, qy):
        return first
    first_row, last_row = rows_crossed(table, py, qy)
    share = per_metre_up(py, qy)
    for row in range(first_row, last_row + 1):
        first_column, last_column = cells_in_row(table, row, px, py, qx, share)
        for column in range(first_column, last_column + 1):
            at = row * table.nx + column
            for j in range(table.offsets[at], table.offsets[at + 1]):
                wall = np.int64(table.indices[j])
                # An exit lies in its own curtain, which must not hide it.
                if wall < solid and _hides(walls, wall, left, low, side, qx, qy):
                    return wall
    return NO_WALL


@internal()
def _hides(
    walls: NDArray[np.float64],
    wall: int,
    left: float,
    low: float,
    side: float,
    qx: float,
    qy: float,
) -> bool:
    """Whether a wall crosses the lines to q from the middle and all corners of a square."""
    ax, ay, bx, by = walls[wall, 0], walls[wall, 1], walls[wall, 2], walls[wall, 3]
    return (
        segments_cross(left + side / 2, low + side / 2, qx, qy, ax, ay, bx, by)
        and segments_cross(left, low, qx, qy, ax, ay, bx, by)
        and segments_cross(left + side, low, qx, qy, ax, ay, bx, by)
        and segments_cross(left, low + side, qx, qy, ax, ay, bx, by)
        and segments_cross(left + side, low + side, qx, qy, ax, ay, bx, by)
    )
