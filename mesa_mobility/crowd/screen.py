"""A quick look before the exact test: which options certainly end up inside somebody.

In a jam nearly every option is blocked, mostly by people who stand around.
At three times (0.4, 0.8 and 1.5 s) the place of each option is known to a
cell of a grid that turns with the pedestrian; cells that lie within a body at
that time are marked, person by person, and every option that passes through a
marked cell is dropped unseen.  Only options that the exact test would drop as
well are dropped here.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.collision import position_at
from mesa_mobility.crowd.state import CrowdState

LEVELS = (4, 8, 15)
"""Samples of a path at which options are screened."""

CELL = 0.06

SLACK = CELL / math.sqrt(2.0) + 1e-6
"""Farthest that a path can be from the centre of its cell, metres."""


class Screen(NamedTuple):
    """``cells`` (m, 3): cell of each option at each level, -1 where it has ended by then; ``side``:
    cells along a side of the grid."""

    cells: NDArray[np.int32]
    side: int


def make_screen(table: OptionTable) -> Screen:
    """Work out where each option of a table is at each level."""
    half = int(np.ceil(table.reach.max() / CELL)) + 1
    side = 2 * half + 1
    cells = np.full((len(table.x), len(LEVELS)), -1, dtype=np.int32)
    for level, sample in enumerate(LEVELS):
        rows = np.flatnonzero(table.frames >= sample * SAMPLE_FRAMES)
        place = table.path[table.path_start[rows] + sample - 1, :2].astype(np.float64)
        column = np.floor(place / CELL + 0.5).astype(np.int64) + half
        cells[rows, level] = column[:, 1] * side + column[:, 0]
    return Screen(cells, side)


@njit(cache=True)
def mark_bodies(
    i: int,
    frame: int,
    near: NDArray[np.int64],
    state: CrowdState,
    reach: float,
    side: int,
    marked: NDArray[np.bool_],
) -> None:
    """Mark, at each level, the cells that lie within the core of a neighbour.

    Args:
        i: the pedestrian who decides.
        frame: now.
        near: its neighbours.
        state: the crowd.
        reach: farthest that an option of i leads, metres.
        side: cells along a side of the grid.
        marked: (3, side * side), all False.
    """
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    x, y = state.x[i], state.y[i]
    for j in near:
        core = state.core[i] + state.core[j]
        dx, dy = state.x[j] - x, state.y[j] - y
        if dx * dx + dy * dy < (core + 0.001) * (core + 0.001):
            continue  # too close already: the exact test has its own rule for that
        inner = core - SLACK
        far = reach + core
        if (
            state.box[j, 0] > x + far
            or state.box[j, 2] < x - far
            or state.box[j, 1] > y + far
            or state.box[j, 3] < y - far
            or inner <= 0.0
        ):
            continue
        for level in range(3):
            time = frame + SAMPLE_FRAMES * LEVELS[level]
            if 0 <= state.gone[j] <= time:
                continue
            jx, jy = position_at(state, j, time)
            u = (c * (jx - x) + s * (jy - y)) / CELL + side // 2
            v = (c * (jy - y) - s * (jx - x)) / CELL + side // 2
            r = inner / CELL
            for row in range(max(math.ceil(v - r), 0), min(math.floor(v + r), side - 1) + 1):
                half = math.sqrt(max(r * r - (row - v) * (row - v), 0.0))
                first = max(math.ceil(u - half), 0)
                last = min(math.floor(u + half), side - 1)
                for column in range(first, last + 1):
                    marked[level, row * side + column] = True


@njit(cache=True)
def is_marked(cells: NDArray[np.int32], marked: NDArray[np.bool_]) -> bool:
    """Whether an option with these cells, one a level, goes through a marked one."""
    for level in range(len(cells)):  # noqa: SIM110
        if cells[level] >= 0 and marked[level, cells[level]]:
            return True
    return False
