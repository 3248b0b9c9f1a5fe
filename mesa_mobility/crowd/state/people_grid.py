"""A uniform grid over the people of a crowd."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal, kept
from mesa_mobility.compiled.simd import LANES
from mesa_mobility.compiled.threads import by_blocks
from mesa_mobility.crowd.state.records import CrowdState

CELL_SIZE = 1.5
"""Side of a cell, metres, unless there would be too many."""

MOST_CELLS = 1 << 18
"""Most cells for a few people, who get larger cells when they are far apart: memory grows with
people, not with area."""

CELLS_A_PERSON = 8
"""Most cells a person for many people."""

PLACED = 2
"""Rows of a grid's table with positions alone."""

COVERED = 7
"""First of the rows with the circle that people cover: x, y, radius.  Cost terms get the rows
before."""


class Grid(NamedTuple):
    """People by the square cells in which they are.

    Attributes:
        x0: least x of the grid, metres.
        y0: least y of the grid, metres.
        nx: number of cells along x.
        ny: number of cells along y.
        size: side of a cell, metres.
        offsets: (nx * ny + 1,) cell c holds ``people[offsets[c]:offsets[c + 1]]``.
        people: (n,) rows in the crowd, in each cell in rising order.
        x: (n,) first row of ``table``, metres.
        y: (n,) second row of ``table``, metres.
        table: (2, n) x and y of the people, a column for each in the order of ``people``, to be
            read in sequence. In the grid of a frame (10, n), with velocity in m/s, unit vector to
            the target (0, 0 at the target), route length in metres, and x, y and radius of a circle
            around their path, the body included. Beyond the last column there is room to read 8
            values.
    """

    x0: float
    y0: float
    nx: int
    ny: int
    size: float
    offsets: NDArray[np.int64]
    people: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]
    table: NDArray[np.float64]


@kept()
def build_grid(active: NDArray[np.int64], x: NDArray[np.float64], y: NDArray[np.float64]) -> Grid:
    """A grid of the people in rows ``active`` of ``x`` and ``y``, with positions alone."""
    return _sorted(active, x, y, PLACED)


def grid_of_frame(active: NDArray[np.int64], records: CrowdState) -> Grid:
    """A grid of the people in rows ``active`` of the crowd, with all that decisions read of them.

    Velocities, directions and route lengths stay those at the beginning of the frame, also of those
    who decide.  The circles are kept up to date (see ``cover_in``).
    """
    grid: Grid = _sorted(active, records["x"], records["y"], COVERED + 3)

    def block(first: int, last: int) -> None:
        _fill(grid, records, first, last)

    by_blocks(block, len(active))
    return grid


@kept()
def _sorted(
    active: NDArray[np.int64], x: NDArray[np.float64], y: NDArray[np.float64], rows: int
) -> Grid:
    """Sort people into cells (counting sort); of the ``rows`` of the table two are written."""
    x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
    for i in active:
        x0, x1 = min(x0, x[i]), max(x1, x[i])
        y0, y1 = min(y0, y[i]), max(y1, y[i])
    if len(active) == 0:
        x0, y0, x1, y1 = 0.0, 0.0, 0.0, 0.0
    size = CELL_SIZE
    most = float(max(MOST_CELLS, CELLS_A_PERSON * len(active)))
    while ((x1 - x0) / size + 1.0) * ((y1 - y0) / size + 1.0) > most:
        size *= 2.0
    nx = int((x1 - x0) / size) + 1
    ny = int((y1 - y0) / size) + 1
    offsets = np.zeros(nx * ny + 1, np.int64)
    cell = np.empty(len(active), np.int64)
    for a, i in enumerate(active):
        cell[a] = int((y[i] - y0) / size) * nx + int((x[i] - x0) / size)
        offsets[cell[a] + 1] += 1
    for c in range(nx * ny):
        offsets[c + 1] += offsets[c]
    fill = offsets[:-1].copy()
    # Padded, so that the last ones can be read 8 at a time.
    n = len(active)
    people = np.empty(n + LANES, np.int64)[:n]
    table = np.empty(rows * n + LANES)[: rows * n].reshape(rows, n)
    their_x, their_y = table[0], table[1]
    for a, i in enumerate(active):
        at = fill[cell[a]]
        people[at], their_x[at], their_y[at] = i, x[i], y[i]
        fill[cell[a]] += 1
    return Grid(x0, y0, nx, ny, size, offsets, people, their_x, their_y, table)


@entry_point()
def _fill(grid: Grid, state: CrowdState, first: int, last: int) -> None:
    """Write the other rows of the table for the people at indices ``first`` to ``last``."""
    table = grid.table
    for a in range(first, last):
        i = grid.people[a]
        table[2, a], table[3, a] = state.vx[i], state.vy[i]
        dx, dy = state.target_x[i] - state.x[i], state.target_y[i] - state.y[i]
        away = math.sqrt(dx * dx + dy * dy)
        table[4, a], table[5, a] = (dx / away, dy / away) if away > 0.0 else (0.0, 0.0)
        table[6, a] = state.route[i]
        cover_in(grid, a, i, state)


@internal()
def cover_in(grid: Grid, at: int, i: int, state: CrowdState) -> None:
    """Write the circle that the path of pedestrian i, at index ``at`` of the grid, covers."""
    x0, y0, x1, y1 = state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3]
    radius = 0.5 * math.sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))
    grid.table[COVERED, at], grid.table[COVERED + 1, at] = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    grid.table[COVERED + 2, at] = radius + state.core[i]


@internal()
def cells_within(grid: Grid, px: float, py: float, radius: float) -> tuple[int, int, int, int]:
    """First and last column, first and last row of cells within ``radius`` of (px, py).

    If there are none, the first number is greater than the last.
    """
    return (
        max(int((px - radius - grid.x0) / grid.size), 0),
        min(int((px + radius - grid.x0) / grid.size), grid.nx - 1),
        max(int((py - radius - grid.y0) / grid.size), 0),
        min(int((py + radius - grid.y0) / grid.size), grid.ny - 1),
    )
