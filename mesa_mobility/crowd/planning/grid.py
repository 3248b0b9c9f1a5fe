"""Who is near in the grid, and who of them counts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, inlined, internal
from mesa_mobility.crowd.state.people_grid import Grid, cells_within
from mesa_mobility.crowd.state.records import CrowdState


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
def place_in(grid: Grid, x: float, y: float, who: int) -> int:
    """Grid index of pedestrian ``who``, who is at (x, y)."""
    cell = int((y - grid.y0) / grid.size) * grid.nx + int((x - grid.x0) / grid.size)
    a = grid.offsets[cell]
    while grid.people[a] != who:
        a += 1
    return int(a)
