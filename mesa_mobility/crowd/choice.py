"""The choice: options in rising order of cost until one hits nothing.

For each pedestrian whose movement has ended: the cost of every option of its
cluster (equation 1), then the cheapest that hits neither wall nor body.  Terms
over pairs (interference) are never negative, so the sum of the others is a
lower bound: an option is looked at in order of that bound, dropped if it hits
something, and given its pair costs only if it may still win.  The result is
that of working everything out; most of it never is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.collision import (
    Surroundings,
    exits_within,
    near_walls,
    path_gone_or_blocked,
    within_reach,
)
from mesa_mobility.crowd.costs import (
    Ends,
    Others,
    Terms,
    lay_ends,
    option_costs,
    pair_cost,
    preferred_now,
)
from mesa_mobility.crowd.fallback import fall_back
from mesa_mobility.crowd.motion import commit, lay_path
from mesa_mobility.crowd.neighbours import Grid, neighbours_of
from mesa_mobility.crowd.ranking import (
    BANDS,
    FIRST_BAND,
    WIDENING,
    all_finite,
    join,
    least,
    sift_down,
)
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.screen import LEVELS, Screen, is_marked, mark_bodies
from mesa_mobility.crowd.state import MAX_KNOTS, CrowdState

SCREEN_AFTER = 4
"""Options that hit something before the rest is screened: with room around, none is."""

_UNTRIED = -9
_NONE = -1
_NOT_A_NUMBER = -2


class Work(NamedTuple):
    """Space to work in, the same for one pedestrian after the other.

    Fields: ``near`` rows of the neighbours, ``close`` of those whose movement comes within reach;
    ``others`` the neighbours as the terms see them; by option: ``ends``, ``costs``, heap of
    ``key`` and ``item``, and ``leaving``, the frame of leaving by an exit or -1 once it is known
    that nothing is hit; ``path`` one path; ``marked`` see ``mark_bodies``.
    """

    near: NDArray[np.int64]
    close: NDArray[np.int64]
    others: Others
    ends: Ends
    costs: NDArray[np.float64]
    key: NDArray[np.float64]
    item: NDArray[np.int64]
    leaving: NDArray[np.int64]
    path: NDArray[np.float64]
    marked: NDArray[np.bool_]


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
    most = 0
    for d in range(len(rows)):
        c = state.cluster[rows[d]]
        most = max(most, table.offsets[c + 1] - table.offsets[c])
    people = len(grid.people)
    work = Work(
        near=np.empty(people, np.int64),
        close=np.empty(people, np.int64),
        others=Others(np.empty(people), np.empty(people), np.empty(people), np.empty(people)),
        ends=Ends(
            np.empty(most), np.empty(most), np.empty(most), np.empty(most), np.empty(most),
            np.empty(most),
        ),
        costs=np.empty(most),
        key=np.empty(most),
        item=np.empty(most, np.int64),
        leaving=np.empty(most, np.int64),
        path=np.empty((MAX_KNOTS, 3)),
        marked=np.empty((len(LEVELS), screen.side * screen.side), np.bool_),
    )  # fmt: skip
    # Terms see velocities as they were, also of those who have just decided.
    vx, vy = state.vx.copy(), state.vy.copy()
    eager = False
    for t in range(len(terms.pair_address)):
        eager = eager or terms.pair_weight[t] < 0.0
    for d in range(len(rows)):
        i = rows[d]
        first, last = table.offsets[state.cluster[i]], table.offsets[state.cluster[i] + 1]
        count = neighbours_of(grid, i, state.x, state.y, rules.search_radius, work.near)
        near = work.near[:count]
        for a in range(count):
            work.others.x[a], work.others.y[a] = state.x[near[a]], state.y[near[a]]
            work.others.vx[a], work.others.vy[a] = vx[near[a]], vy[near[a]]
        lay_ends(i, first, last, table, state, work.ends)
        costs = work.costs[: last - first]
        costs[:] = 0.0
        if len(extra) > 0:
            costs[:] = extra[extra_offsets[d] : extra_offsets[d + 1]]
        option_costs(
            last - first, work.ends, state.target_x[i], state.target_y[i],
            preferred_now(i, state), terms, costs,
        )  # fmt: skip
        if eager:
            for k in range(last - first):
                costs[k] += pair_cost(k, work.ends, count, work.others, terms)
        if not all_finite(costs):
            return i

        farthest = table.farthest[state.cluster[i]]
        destination = state.destination[i]
        walls = near_walls(
            around, state.x[i], state.y[i], destination, farthest + state.core[i] + 0.01
        )
        exits_near = exits_within(around, state.x[i], state.y[i], destination, farthest)
        close = work.close[: within_reach(i, near, farthest, state, work.close)]
        chosen = _cheapest_free(
            i, frame, first, costs, close, count, walls, exits_near, farthest, eager, table,
            screen, state, around, terms, rules, work,
        )  # fmt: skip
        if chosen == _NOT_A_NUMBER:
            return i
        state.decisions[i] += 1
        if chosen >= 0:
            pieces = lay_path(i, first + chosen, table, state, state.path[i])
            commit(
                i, first + chosen, frame, pieces, SAMPLE_FRAMES, work.leaving[chosen],
                table.cluster[first + chosen], state,
            )  # fmt: skip
        else:
            standing = rules.standing[state.kind[i]]
            fall_back(i, frame, state, walls, around, near, exits_near, rules.cores, standing)
    return -1


@njit(cache=True)
def _cheapest_free(
    i: int,
    frame: int,
    first: int,
    costs: NDArray[np.float64],
    close: NDArray[np.int64],
    neighbours: int,
    walls: NDArray[np.float64],
    exits_near: bool,
    farthest: float,
    eager: bool,
    table: OptionTable,
    screen: Screen,
    state: CrowdState,
    around: Surroundings,
    terms: Terms,
    rules: Rules,
    work: Work,
) -> int:
    """The cheapest option of pedestrian i that hits nothing, counted from ``first``.

    ``costs`` are complete if ``eager``, else without the pair terms.  -1 if all hit
    something, -2 if a pair cost is not a number.
    """
    key, item, leaving = work.key, work.item, work.leaving
    leaving[: len(costs)] = _UNTRIED
    # Whoever may leave by an exit may be out before it would meet anybody: no screening then.
    screening = rules.cores and not exits_near
    screened = False
    hits = 0
    lowest = least(costs)
    above, up_to, band = -np.inf, lowest + FIRST_BAND, 1
    size = join(costs, above, up_to, key, item, 0)
    while True:
        if size == 0 or key[0] > up_to:
            # What is to come may cost less than what is left, once that has its pair costs.
            if up_to < np.inf:
                above = up_to
                up_to = lowest + FIRST_BAND * WIDENING**band if band < BANDS else np.inf
                band += 1
                size = join(costs, above, up_to, key, item, size)
                continue
            if size == 0:
                return _NONE
        k = item[0]
        if leaving[k] != _UNTRIED:
            return k
        if screening and not screened and hits >= SCREEN_AFTER:
            screened = True
            work.marked[:] = False
            mark_bodies(i, frame, close, state, farthest, screen.side, work.marked)
        free = not (screened and is_marked(screen.cells[first + k], work.marked))
        if free:
            o = first + k
            pieces = lay_path(i, o, table, state, work.path)
            gone = path_gone_or_blocked(
                i, work.path, pieces, SAMPLE_FRAMES, table.reach[o], frame, state, walls, around,
                close, exits_near, rules.cores,
            )  # fmt: skip
            free = gone >= -1
        if free:
            leaving[k] = gone
            if not eager:
                key[0] += pair_cost(k, work.ends, neighbours, work.others, terms)
                if not abs(key[0]) < np.inf:
                    return _NOT_A_NUMBER
        else:
            hits += 1
            size -= 1
            key[0], item[0] = key[size], item[size]
        if size > 0:
            sift_down(key, item, size, 0)
