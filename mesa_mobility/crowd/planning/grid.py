"""Neighbours: a uniform grid over the crowd, rebuilt for each frame that has decisions."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, force_inlined, inlined, internal
from mesa_mobility.compiled.simd import LANES, bits_set, compress
from mesa_mobility.compiled.threads import by_blocks
from mesa_mobility.crowd.collision.simd_tests import places_near
from mesa_mobility.crowd.state.people_grid import Grid, cells_within
from mesa_mobility.crowd.state.records import CrowdState

COVERED = 5
"""First of the rows of ``headways`` with the circle that people cover: x, y, radius.  Cost terms
get the rows before, in addition to positions."""


@internal()
def cover_in(moving: NDArray[np.float64], at: int, i: int, state: CrowdState) -> None:
    """Write the circle that the path of pedestrian i, at index ``at`` of the grid, covers."""
    x0, y0, x1, y1 = state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3]
    moving[COVERED, at], moving[COVERED + 1, at] = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    radius = 0.5 * math.sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0))
    moving[COVERED + 2, at] = radius + state.core[i]


def headways(grid: Grid, state: CrowdState) -> NDArray[np.float64]:
    """(8, n) motion of the people in a grid, in its order.

    Velocity in m/s, unit vector to the target (0, 0 at the target), route length in metres; x, y
    and radius of a circle around their path, the body included. Beyond the last there is room to
    read 8 values.
    """
    rows, n = COVERED + 3, len(grid.people)
    found = np.empty(rows * n + LANES)[: rows * n].reshape(rows, n)

    def block(first: int, last: int) -> None:
        _write_headways(grid, state, first, last, found)

    by_blocks(block, n)
    return found


@entry_point()
def _write_headways(
    grid: Grid,
    state: CrowdState,
    first: int,
    last: int,
    found: NDArray[np.float64],
) -> None:
    """Write ``headways`` of the people at indices ``first`` to ``last`` of the grid."""
    for a in range(first, last):
        i = grid.people[a]
        found[0, a], found[1, a] = state.vx[i], state.vy[i]
        dx, dy = state.target_x[i] - state.x[i], state.target_y[i] - state.y[i]
        away = math.sqrt(dx * dx + dy * dy)
        found[2, a], found[3, a] = (dx / away, dy / away) if away > 0.0 else (0.0, 0.0)
        found[4, a] = state.route[i]
        cover_in(found, a, i, state)


@force_inlined()
def people_within(
    grid: Grid, px: float, py: float, but: int, radius: float, found: NDArray[np.int64]
) -> int:
    """Write the grid indices of people within ``radius`` of (px, py), except for ``but``.

    ``found`` must have room for everybody: there is no cap on neighbours.  Returns their number.
    """
    cx0, cx1, cy0, cy1 = cells_within(grid, px, py, radius)
    count = 0
    if cx0 > cx1:  # beyond the last column; beyond the last row the loop is empty
        return count
    for cy in range(cy0, cy1 + 1):
        for a in range(grid.offsets[cy * grid.nx + cx0], grid.offsets[cy * grid.nx + cx1 + 1]):
            dx, dy = grid.x[a] - px, grid.y[a] - py
            found[count] = a
            count += int(dx * dx + dy * dy <= radius * radius and grid.people[a] != but)
    return count


class Nearby(NamedTuple):
    """The people around somebody who decides.

    Attributes:
        near: (n,) rows of those who may get in the way.
        sweeps: (3, n) circles around their paths.
        interacting: (m,) rows of those who count in cost terms.
        others: (8 + fields, m) what cost terms read of them.
    """

    near: NDArray[np.int64]
    sweeps: NDArray[np.float64]
    interacting: NDArray[np.int64]
    others: NDArray[np.float64]


@force_inlined()
def neighbours_within(
    grid: Grid,
    moving: NDArray[np.float64],
    px: float,
    py: float,
    own: int,
    radius: float,
    interaction_range: float,
    to: Nearby,
) -> tuple[int, int]:
    """Copy the data of people around (px, py), except for the one at index ``own``.

    They are those that ``people_within`` finds, read 8 at a time.

    Args:
        grid: the people.
        moving: (8, people) as of ``headways``.
        px, py: metres.
        own: grid index of the person left out.
        radius: metres within which people may get in the way.
        interaction_range: metres within which they count in cost terms, at most ``radius``.
        to: is written.

    Returns:
        The number of those near and of those interacting; each array must have room for everybody
        and 8 more.
    """
    near, sweeps, interacting, others = to.near, to.sweeps, to.interacting, to.others
    cx0, cx1, cy0, cy1 = cells_within(grid, px, py, radius)
    found, count = 0, 0
    for cy in range(cy0, cy1 + 1):
        last = grid.offsets[cy * grid.nx + cx1 + 1]
        for at in range(grid.offsets[cy * grid.nx + cx0], last, LANES):
            bits = places_near(grid.x, grid.y, at, px, py, radius)
            bits &= (1 << min(last - at, LANES)) - 1
            if at <= own < at + LANES:
                bits &= ~(1 << (own - at))
            compress(moving, COVERED, at, bits, sweeps, 0, found, 3)
            compress(grid.people, 0, at, bits, near, 0, found, 1)
            found += bits_set(bits)
            bits &= places_near(grid.x, grid.y, at, px, py, interaction_range)
            compress(grid.x, 0, at, bits, others, 0, count, 1)
            compress(grid.y, 0, at, bits, others, 1, count, 1)
            compress(moving, 0, at, bits, others, 2, count, COVERED)
            compress(grid.people, 0, at, bits, interacting, 0, count, 1)
            count += bits_set(bits)
    return found, count


@inlined()
def farthest_range(i: int, ranges: NDArray[np.float64], state: CrowdState) -> float:
    """Metres within which somebody of any type may count in the cost terms of i."""
    farthest = 0.0
    for kind in range(len(ranges)):
        farthest = max(farthest, ranges[state.type_index[i], kind])
    return farthest


@inlined()
def interact(i: int, j: int, ranges: NDArray[np.float64], state: CrowdState) -> bool:
    """Whether j counts in the cost terms of i; ``ranges`` are those of ``Rules``."""
    dx, dy = state.x[j] - state.x[i], state.y[j] - state.y[i]
    range_ = ranges[state.type_index[i], state.type_index[j]]
    return bool(dx * dx + dy * dy <= range_ * range_)


@internal()
def keep_interacting(
    i: int,
    count: int,
    ranges: NDArray[np.float64],
    state: CrowdState,
    interacting: NDArray[np.int64],
    others: NDArray[np.float64],
) -> int:
    """Keep those of the first ``count`` neighbours who count for i, by their types.

    ``interacting`` and ``others`` are those that ``neighbours_within`` writes.  Returns their
    number.
    """
    kept = 0
    for a in range(count):
        j = interacting[a]
        interacting[kept] = j
        for row in range(2 + COVERED):
            others[row, kept] = others[row, a]
        kept += int(interact(i, j, ranges, state))
    return kept


@internal()
def place_in(grid: Grid, x: float, y: float, who: int) -> int:
    """Grid index of pedestrian ``who``, who is at (x, y)."""
    cell = int((y - grid.y0) / grid.size) * grid.nx + int((x - grid.x0) / grid.size)
    a = grid.offsets[cell]
    while grid.people[a] != who:
        a += 1
    return int(a)
