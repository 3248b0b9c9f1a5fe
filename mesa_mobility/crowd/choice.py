"""The choice: options in rising order of cost until one hits nothing.

For each pedestrian whose movement has ended: the cost of every option of its
cluster (equation 1), then the cheapest that hits neither wall nor body.  Terms
over pairs (interference) are never negative, so the sum of the others is a
lower bound: an option is looked at in order of that bound, dropped if it hits
something, and given its pair costs only if it may still win.  The result is
that of working everything out; most of it never is.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.collision import (
    Surroundings,
    exits_within,
    near_walls,
    path_gone_or_blocked,
)
from mesa_mobility.crowd.costs import Terms, option_costs, pair_cost
from mesa_mobility.crowd.fallback import fall_back
from mesa_mobility.crowd.motion import commit, lay_path
from mesa_mobility.crowd.neighbours import Grid, neighbours_of
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.screen import Screen, is_marked, mark_bodies
from mesa_mobility.crowd.state import MAX_KNOTS, CrowdState


@njit(cache=True)
def _sift_down(key: NDArray[np.float64], item: NDArray[np.int64], size: int, root: int) -> None:
    """Restore the heap order (least key first; lower item first among equals) below ``root``."""
    k, v = key[root], item[root]
    while True:
        child = 2 * root + 1
        if child >= size:
            break
        right = child + 1
        if right < size and (
            key[right] < key[child] or (key[right] == key[child] and item[right] < item[child])
        ):
            child = right
        if k < key[child] or (k == key[child] and v < item[child]):
            break
        key[root], item[root] = key[child], item[child]
        root = child
    key[root], item[root] = k, v


@njit(cache=True)
def decide(
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    screen: Screen,
    state: CrowdState,
    grid: Grid,
    around: Surroundings,
    terms: Terms,
    extra: NDArray[np.float64],
    extra_offsets: NDArray[np.int64],
    rules: Rules,
) -> int:
    """Decide for the pedestrians in ``rows``, one after the other, and commit them.

    Costs see the crowd as it was when the frame began; collisions see what
    those before have committed to.

    Args:
        rows: pedestrians, in the order in which they decide.
        frame: now.
        table: options of all capabilities.
        screen: where these options are at the times of screening.
        state: the crowd; targets must be set.
        grid: neighbours' grid of this frame.
        around: walls and exits.
        terms: compiled terms.
        extra: weighted cost of the terms that are not compiled, options of each
            pedestrian in turn, or empty.
        extra_offsets: (len(rows) + 1,) where each pedestrian's part of ``extra`` starts.
        rules: what holds for everybody.

    Returns:
        -1, or the pedestrian for whom a cost was not a number; nobody after it has decided.
    """
    velocity = np.empty((len(state.x), 2))
    velocity[:, 0] = state.vx
    velocity[:, 1] = state.vy
    found = np.empty(len(grid.people), np.int64)
    path = np.empty((MAX_KNOTS, 3))
    marked = np.empty((3, screen.side * screen.side), np.bool_)
    eager = False
    for t in range(len(terms.pair_address)):
        eager = eager or terms.pair_weight[t] < 0.0
    for d in range(len(rows)):
        i = rows[d]
        first, last = table.offsets[state.cluster[i]], table.offsets[state.cluster[i] + 1]
        near = found[: neighbours_of(grid, i, state.x, state.y, rules.search_radius, found)]
        farthest = 0.0
        for o in range(first, last):
            farthest = max(farthest, table.reach[o])
        destination = state.destination[i]
        walls = near_walls(
            around, state.x[i], state.y[i], destination, farthest + state.core[i] + 0.01
        )
        exits_near = exits_within(around, state.x[i], state.y[i], destination, farthest)

        item = np.empty(last - first, np.int64)
        size = 0
        # Whoever may leave by an exit may be out before it would meet anybody: no screening then.
        screened = rules.cores and not exits_near
        if screened:
            marked[:] = False
            mark_bodies(i, frame, near, state, farthest, screen.side, marked)
        for o in range(first, last):
            if screened and is_marked(screen.cells[o], marked):
                continue
            item[size] = o
            size += 1
        item = item[:size]
        key = np.zeros(size)
        if len(extra) > 0:
            for k in range(size):
                key[k] = extra[extra_offsets[d] + item[k] - first]
        option_costs(i, item, table, state, terms, key)
        complete = np.zeros(last - first, np.bool_)
        leaving = np.empty(last - first, np.int64)
        if eager:
            for k in range(size):
                key[k] += pair_cost(i, item[k], table, state, velocity, near, terms)
        if not np.isfinite(key).all():
            return i
        for root in range(size // 2 - 1, -1, -1):
            _sift_down(key, item, size, root)
        chosen = -1
        while size > 0:
            o = item[0]
            if complete[o - first]:
                chosen = o
                break
            pieces = lay_path(i, o, table, state, path)
            gone = path_gone_or_blocked(
                i, path, pieces, SAMPLE_FRAMES, table.reach[o], frame, state, walls, around, near,
                exits_near, rules.cores,
            )  # fmt: skip
            if gone < -1:
                size -= 1
                key[0], item[0] = key[size], item[size]
            else:
                complete[o - first] = True
                leaving[o - first] = gone
                if not eager:
                    key[0] += pair_cost(i, o, table, state, velocity, near, terms)
                    if not np.isfinite(key[0]):
                        return i
            if size > 0:
                _sift_down(key, item, size, 0)

        state.decisions[i] += 1
        if chosen >= 0:
            pieces = lay_path(i, chosen, table, state, state.path[i])
            gone = leaving[chosen - first]
            commit(i, chosen, frame, pieces, SAMPLE_FRAMES, gone, table.cluster[chosen], state)
        else:
            standing = rules.standing[state.kind[i]]
            fall_back(i, frame, state, walls, around, near, exits_near, rules.cores, standing)
    return -1
