"""Neighbours: a uniform grid over the crowd, rebuilt for each frame that has decisions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.lanewise import places_near
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import Entry, called, lean, part
from mesa_mobility.lanes import LANES, bits_set, press_lanes
from mesa_mobility.threads import by_blocks

CELL_SIZE = 1.5

COVERED = 5
"""First of the rows of ``headways`` that tell what people cover, x, y and radius; those before are
what cost terms are given besides places."""


class Grid(NamedTuple):
    """People by cell: cell c holds ``people[offsets[c]:offsets[c + 1]]``, in order of row, and
    ``x`` and ``y`` of the same; they lie side by side, as all around somebody are looked at."""

    x0: float
    y0: float
    nx: int
    ny: int
    offsets: NDArray[np.int64]
    people: NDArray[np.int64]
    x: NDArray[np.float64]
    y: NDArray[np.float64]


@njit(cache=True)
def build_grid(active: NDArray[np.int64], x: NDArray[np.float64], y: NDArray[np.float64]) -> Grid:
    """Sort the people in rows ``active`` of ``x`` and ``y`` into cells (counting sort)."""
    x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
    for i in active:
        x0, x1 = min(x0, x[i]), max(x1, x[i])
        y0, y1 = min(y0, y[i]), max(y1, y[i])
    if len(active) == 0:
        x0, y0, x1, y1 = 0.0, 0.0, 0.0, 0.0
    nx = int((x1 - x0) / CELL_SIZE) + 1
    ny = int((y1 - y0) / CELL_SIZE) + 1
    offsets = np.zeros(nx * ny + 1, np.int64)
    cell = np.empty(len(active), np.int64)
    for a, i in enumerate(active):
        cell[a] = int((y[i] - y0) / CELL_SIZE) * nx + int((x[i] - x0) / CELL_SIZE)
        offsets[cell[a] + 1] += 1
    for c in range(nx * ny):
        offsets[c + 1] += offsets[c]
    fill = offsets[:-1].copy()
    # With room for the last ones to be read 8 at a time.
    n = len(active)
    people = np.empty(n + LANES, np.int64)[:n]
    their_x, their_y = np.empty(n + LANES)[:n], np.empty(n + LANES)[:n]
    for a, i in enumerate(active):
        at = fill[cell[a]]
        people[at], their_x[at], their_y[at] = i, x[i], y[i]
        fill[cell[a]] += 1
    return Grid(x0, y0, nx, ny, offsets, people, their_x, their_y)


@lean()
def cover_in(moving: NDArray[np.float64], at: int, i: int, state: CrowdState) -> None:
    """Write what pedestrian i, at a place in the grid, covers on its way."""
    x0, y0, x1, y1 = state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3]
    moving[COVERED, at], moving[COVERED + 1, at] = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    radius = 0.5 * math.sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))
    moving[COVERED + 2, at] = radius + state.core[i]


def headways(grid: Grid, state: CrowdState) -> NDArray[np.float64]:
    """(8, n) where the people in a grid go, in its order.

    Velocity in m/s, unit vector to the target (0, 0 at the target), metres of way left; x, y and
    radius of a circle around all that they cover on their way, their body included. Behind the last
    there is room to read 8 numbers.
    """
    rows, n = COVERED + 3, len(grid.people)
    found = np.empty(rows * n + LANES)[: rows * n].reshape(rows, n)

    def block(first: int, last: int) -> None:
        _write_headways(grid, state, first, last, found)

    by_blocks(block, n)
    return found


@Entry
@called()
def _write_headways(
    grid: Grid, state: CrowdState, first: int, last: int, found: NDArray[np.float64]
) -> None:
    """Write ``headways`` of people from a first place in the grid to before a last one."""
    for a in range(first, last):
        i = grid.people[a]
        found[0, a], found[1, a] = state.vx[i], state.vy[i]
        dx, dy = state.target_x[i] - state.x[i], state.target_y[i] - state.y[i]
        away = math.sqrt(dx * dx + dy * dy)
        found[2, a], found[3, a] = (dx / away, dy / away) if away > 0.0 else (0.0, 0.0)
        found[4, a] = state.route[i]
        cover_in(found, a, i, state)


@lean()
def _cells_within(grid: Grid, px: float, py: float, radius: float) -> tuple[int, int, int, int]:
    """First and last column, first and last row of cells within ``radius`` of (px, py).

    Beyond the last one there are none: the first number is then the greater.
    """
    return (
        max(int((px - radius - grid.x0) / CELL_SIZE), 0),
        min(int((px + radius - grid.x0) / CELL_SIZE), grid.nx - 1),
        max(int((py - radius - grid.y0) / CELL_SIZE), 0),
        min(int((py + radius - grid.y0) / CELL_SIZE), grid.ny - 1),
    )


@part()
def people_within(
    grid: Grid, px: float, py: float, but: int, radius: float, found: NDArray[np.int64]
) -> int:
    """Write the places in the grid of people within ``radius`` of (px, py), but for ``but``.

    ``found`` must have room for everybody: there is no cap on neighbours.  Returns their number.
    """
    cx0, cx1, cy0, cy1 = _cells_within(grid, px, py, radius)
    count = 0
    if cx0 > cx1:  # beyond the last column; beyond the last row there is nothing to loop over
        return count
    for cy in range(cy0, cy1 + 1):
        for a in range(grid.offsets[cy * grid.nx + cx0], grid.offsets[cy * grid.nx + cx1 + 1]):
            dx, dy = grid.x[a] - px, grid.y[a] - py
            found[count] = a
            count += int(dx * dx + dy * dy <= radius * radius and grid.people[a] != but)
    return count


@part()
def neighbours_within(
    grid: Grid,
    moving: NDArray[np.float64],
    px: float,
    py: float,
    own: int,
    radius: float,
    near: NDArray[np.int64],
    others: NDArray[np.float64],
    sweeps: NDArray[np.float64],
) -> int:
    """Copy what is kept of people within ``radius`` of (px, py), but for the one at place ``own``.

    Those that ``people_within`` finds, 8 at a time.

    Args:
        grid: where people are.
        moving: (8, people) as of ``headways``.
        px, py: place, metres.
        own: place in the grid of somebody who is left out.
        radius: metres.
        near: gets their rows.
        others: gets what cost terms are given.
        sweeps: gets the circles around what they cover.

    Returns:
        Their number; each array must have room for everybody and 8 more.
    """
    cx0, cx1, cy0, cy1 = _cells_within(grid, px, py, radius)
    count = 0
    for cy in range(cy0, cy1 + 1):
        last = grid.offsets[cy * grid.nx + cx1 + 1]
        for at in range(grid.offsets[cy * grid.nx + cx0], last, LANES):
            bits = places_near(grid.x, grid.y, at, px, py, radius)
            bits &= (1 << min(last - at, LANES)) - 1
            if at <= own < at + LANES:
                bits &= ~(1 << (own - at))
            press_lanes(grid.x, 0, at, bits, others, 0, count, 1)
            press_lanes(grid.y, 0, at, bits, others, 1, count, 1)
            press_lanes(moving, 0, at, bits, others, 2, count, COVERED)
            press_lanes(moving, COVERED, at, bits, sweeps, 0, count, 3)
            press_lanes(grid.people, 0, at, bits, near, 0, count, 1)
            count += bits_set(bits)
    return count


@lean()
def place_in(grid: Grid, x: float, y: float, who: int) -> int:
    """Place in the grid of pedestrian ``who``, who is at (x, y) in it."""
    cell = int((y - grid.y0) / CELL_SIZE) * grid.nx + int((x - grid.x0) / CELL_SIZE)
    a = grid.offsets[cell]
    while grid.people[a] != who:
        a += 1
    return int(a)
