"""What happens to movements under way when walls come, go, open or close."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.crowd.collision import (
    Surroundings,
    crosses_exit,
    hits_neighbour,
    hits_wall,
    near_walls,
)
from mesa_mobility.crowd.neighbours import Grid, build_grid, people_within
from mesa_mobility.crowd.options import SAMPLES, OptionTable
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.state import NO_OPTION, CrowdState
from mesa_mobility.crowd.under_way import knot


@njit(cache=True)
def stop_where_blocked(
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    state: CrowdState,
    around: Surroundings,
    rules: Rules,
) -> int:
    """Stop those whose way is no longer free, and those who would then run into them.

    They stand where they are and decide again in this frame.  Returns their number.
    """
    reach = table.farthest.max()
    stopped = np.zeros(len(rows), np.bool_)
    newly = np.empty(len(rows), np.int64)
    count = 0
    path = np.empty((2, SAMPLES))
    found = np.empty((len(around.segments) + len(around.exits), 5))
    for a in range(len(rows)):
        i = rows[a]
        if state.end[i] <= frame:
            continue
        pieces = _remaining(i, frame, table, state, path)
        walked = pieces
        if state.gone[i] >= 0:
            piece, _ = crosses_exit(path, pieces, around, state.destination[i])
            walked = pieces if piece < 0 else piece + 1
        walls = near_walls(
            around, state.x[i], state.y[i], state.destination[i], reach + state.core[i] + 0.01,
            found,
        )  # fmt: skip
        if hits_wall(path, walked, found[:walls], state.core[i], reach):
            stopped[a] = True
            newly[count] = i
            count += 1
    total = count
    while count > 0 and rules.cores:
        for b in range(count):
            _stop(newly[b], frame, state, rules)
        # Standing where they are, they may be in the way of others: these stop as well.
        standing = newly[:count].copy()
        count = 0
        still = np.empty((2, 2))
        for a in range(len(rows)):
            j = rows[a]
            if stopped[a] or state.end[j] <= frame:
                continue
            for i in standing:
                still[0], still[1] = state.x[i], state.y[i]
                if hits_neighbour(
                    still,
                    np.int64(1),
                    np.int64(1),
                    frame,
                    np.int64(-1),
                    table,
                    state,
                    j,
                    state.core[i] + state.core[j],
                ):
                    stopped[a] = True
                    newly[count] = j
                    count += 1
                    break
        total += count
    for b in range(count):
        _stop(newly[b], frame, state, rules)
    return total


@njit(cache=True)
def _remaining(
    i: int, frame: int, table: OptionTable, state: CrowdState, path: NDArray[np.float64]
) -> int:
    """Write where pedestrian i is and will be at the knots to come; return the pieces."""
    path[0, 0], path[1, 0] = state.x[i], state.y[i]
    first = (frame - state.start[i]) // state.spacing[i] + 1
    pieces = state.knots[i] - first
    for k in range(pieces):
        path[0, k + 1], path[1, k + 1] = knot(state, table, i, first + k)
    return pieces


@njit(cache=True)
def _stop(i: int, frame: int, state: CrowdState, rules: Rules) -> None:
    state.option[i], state.gone[i] = NO_OPTION, -1
    state.start[i] = state.end[i] = frame
    state.spacing[i] = state.knots[i] = 1
    state.cluster[i] = rules.standing[state.kind[i]]
    state.vx[i] = state.vy[i] = 0.0
    state.stride[i] = 0.0
    state.from_x[i] = state.to_x[i] = state.x[i]
    state.from_y[i] = state.to_y[i] = state.y[i]
    state.from_heading[i] = state.to_heading[i] = state.heading[i]
    state.box[i, 0] = state.box[i, 2] = state.x[i]
    state.box[i, 1] = state.box[i, 3] = state.y[i]


def too_close(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """First of some places where nobody can appear, and who is or will come too near to it.

    The latter is a row of the crowd, or -1 for one of the places before it; (-1, -1) if all
    of them are free.  Nobody farther than ``search_radius`` is on the way to a place.
    """
    beside = _first_beside(points, 2.0 * core)
    before = points if beside < 0 else points[:beside]
    # Mostly there is nobody yet: then nothing of this needs to be compiled.
    if len(rows) > 0:
        where, who = _first(True, before, core, frame, rows, table, state, search_radius)
        if where >= 0:
            return where, who
    return beside, -1


def _first_beside(points: NDArray[np.float64], distance: float) -> int:
    """First of some places that is nearer than ``distance`` to one before it, or -1."""
    # A little farther, since the tree rounds in a way of its own.
    pairs = cKDTree(points).query_pairs(1.001 * distance, output_type="ndarray")
    dx, dy = (points[pairs[:, 0]] - points[pairs[:, 1]]).T
    near = dx * dx + dy * dy < distance * distance
    return int(pairs[near].max(axis=1).min()) if near.any() else -1


def first_free(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> int:
    """First of some places that nobody is or will come too near to, or -1; as ``too_close``."""
    return _first(False, points, core, frame, rows, table, state, search_radius)[0]


@njit(cache=True)
def _first(
    taken: bool,
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """First of some places that is taken, or that is not, and who is or will come too near to it.

    -1 for nobody, and where there is no such place.
    """
    people = build_grid(rows, state.x, state.y)
    found = np.empty(len(rows), np.int64)
    for k in range(len(points)):
        x, y = points[k]
        j = _comes_near(x, y, core, frame, people, table, state, search_radius, found)
        if (j >= 0) == taken:
            return k, j
    return -1, -1


@njit(cache=True)
def _comes_near(
    x: float,
    y: float,
    core: float,
    frame: int,
    people: Grid,
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
    found: NDArray[np.int64],
) -> int:
    """The lowest row of somebody who is or will be too near to a body at (x, y), or -1."""
    still = np.empty((2, 2))
    still[0], still[1] = x, y
    count = people_within(people, x, y, np.int64(-1), search_radius, found)
    lowest = np.int64(-1)
    for at in found[:count]:
        j = people.people[at]
        if 0 <= lowest < j:
            continue
        c = core + state.core[j]
        dx, dy = x - state.x[j], y - state.y[j]
        if dx * dx + dy * dy < c * c or (
            state.end[j] > frame
            and hits_neighbour(
                still, np.int64(1), np.int64(1), frame, np.int64(-1), table, state, j, c
            )
        ):
            lowest = j
    return int(lowest)
