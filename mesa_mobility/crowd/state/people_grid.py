"""A uniform grid over the people of a crowd."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.compiled.simd import LANES

CELL_SIZE = 1.5
"""Side of a cell, metres, unless there would be too many."""

MOST_CELLS = 1 << 18
"""Most cells for a few people, who get larger cells when they are far apart: memory grows with
people, not with area."""

CELLS_A_PERSON = 8
"""Most cells a person for many people."""


class Grid(NamedTuple):
    """People by cell: cell c holds ``people[offsets[c]:offsets[c + 1]]``, in order of row.

    Their ``x`` and ``y`` are copied in the same order, to be read in sequence.  ``size`` is the
    side of a cell, metres.
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


@kept()
def build_grid(active: NDArray[np.int64], x: NDArray[np.float64], y: NDArray[np.float64]) -> Grid:
    """Sort the people in rows ``active`` of ``x`` and ``y`` into cells (counting sort)."""
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
    their_x, their_y = np.empty(n + LANES)[:n], np.empty(n + LANES)[:n]
    for a, i in enumerate(active):
        at = fill[cell[a]]
        people[at], their_x[at], their_y[at] = i, x[i], y[i]
        fill[cell[a]] += 1
    return Grid(x0, y0, nx, ny, size, offsets, people, their_x, their_y)


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
