"""The search for the cheapest option that hits nothing, best first.

Groups of options are opened in rising order of a lower bound of what their options
cost. Terms over pairs (interference) are never negative, so the sum of the others is
a lower bound of an option's cost, and a better one with its pair costs with the few neighbours who
are likely to cost most. In the order of that an option is dropped if it hits something, and given
all its pair costs if it may still win.  The result is that of
working everything out; most of it never is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.clearing import free_options
from mesa_mobility.crowd.close import Stance, meets
from mesa_mobility.crowd.collision import Surroundings, path_gone_or_blocked
from mesa_mobility.crowd.costs import (
    Terms,
    lay_ends,
    option_costs,
)
from mesa_mobility.crowd.groups import OptionGroups
from mesa_mobility.crowd.motion import lay_path
from mesa_mobility.crowd.options import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.pairs import fill_ends, pair_cost, pair_costs_at_least
from mesa_mobility.crowd.ranking import (
    BANDS,
    DEAREST,
    FIRST_BAND,
    WIDENING,
    all_finite,
    join,
    least,
    sift_down,
)
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.work import Setting, Work
from mesa_mobility.jit import lean
from mesa_mobility.machine import fetch

NONE = -1
NOT_A_NUMBER = -2
_UNTRIED = -9

FEW = 16
"""Groups that are all opened at once, without working in bands."""


@lean()
def _open_groups(
    me: Stance,
    now: Setting,
    count: int,
    above: float,
    up_to: float,
    bounds: NDArray[np.float64],
    alive: NDArray[np.int64],
    extra: NDArray[np.float64],
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    work: Work,
) -> int:
    """Work out the costs of options in groups with bounds from ``above`` to ``up_to``.

    Returns the number of options looked at so far, ``count`` before; -2 if a cost is not a number.
    """
    i = me.row
    base = table.offsets[state.cluster[i]]
    n = count
    for a in range(len(bounds)):
        if above < bounds[a] <= up_to:
            for o in range(groups.first[alive[a]], groups.first[alive[a] + 1]):
                work.rows[n] = o
                fetch(table.options, o, 64)
                n += 1
    n = count + free_options(work.bodies, work.rows[count:n], table, work.circles)
    lay_ends(me, work.rows[count:n], table, work.ends, count)
    for k in range(count, n):
        work.slot[work.rows[k] - base] = k
        work.costs[k] = 0.0 if len(extra) == 0 else extra[work.rows[k] - base]
        work.leaving[k] = _UNTRIED
    option_costs(me, count, n, work.ends, state, terms, work.costs)
    if now.eager:
        for k in range(count, n):
            work.costs[k] += pair_cost(me, k, work.ends, now.neighbours, work.others, state, terms)
    if not all_finite(work.costs[count:n]):
        return NOT_A_NUMBER
    fill_ends(count, n, work.ends)
    pair_costs_at_least(
        me, count, n, work.ends, now.foremost, work.foremost, state, terms, work.least
    )
    for k in range(count, n):
        work.least[k] += work.costs[k]
    return n


@lean()
def cheapest_free(
    me: Stance,
    now: Setting,
    bounds: NDArray[np.float64],
    alive: NDArray[np.int64],
    walls: NDArray[np.float64],
    extra: NDArray[np.float64],
    cores: bool,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    around: Surroundings,
    terms: Terms,
    work: Work,
) -> tuple[int, int]:
    """The cheapest option of a pedestrian that hits nothing.

    Args:
        me: the pedestrian.
        now: what is to know of its decision.
        bounds: lower bounds of what the options cost in groups that are not certainly
            blocked; -inf where nothing is known.
        alive: these groups.
        walls: walls within reach, with squared distances.
        extra: costs of the options that are known already, or empty.
        cores: whether bodies are hard.
        table: options of all capabilities.
        groups: what their groups span.
        state: the crowd.
        around: walls and exits.
        terms: compiled terms.
        work: space to work in, with the people around.

    Returns:
        The option's row in the table, -1 if all hit something, -2 if a cost is not a
        number; the frame of leaving by an exit, or -1.
    """
    base = table.offsets[state.cluster[me.row]]
    key, item = work.key, work.item
    lowest = least(bounds)
    # Typed, as functions are compiled once more for literal numbers.
    band, size, count, met = np.int64(0), np.int64(0), np.int64(0), np.int64(0)
    up_to = -np.inf
    few = len(bounds) <= FEW
    while True:
        while up_to < DEAREST and (size == 0 or key[0] > up_to):
            above = up_to
            up_to = lowest + FIRST_BAND * WIDENING**band if band < BANDS and not few else DEAREST
            band += 1
            if lowest == -np.inf:
                # Nothing is known: everything is worked out at once.
                up_to = DEAREST
                bounds[:] = 0.0
            count = _open_groups(
                me, now, count, above, up_to, bounds, alive, extra, table, groups, state, terms,
                work,
            )  # fmt: skip
            if count < 0:
                return NOT_A_NUMBER, -1
            size = join(work.least[:count], work.rows, above, up_to, key, item, size)
        if size == 0:
            return NONE, -1
        o = item[0]
        # One of these two is likely to be next.
        if size > 2:
            fetch(table.path, item[1], 192)
            fetch(table.path, item[2], 192)
        k = work.slot[o - base]
        if work.leaving[k] > _UNTRIED:
            return o, work.leaving[k]
        who, doubtful = -1, 0
        # Whoever may be out before may not meet anybody of those ahead.
        reach = np.float64(table.options[o].reach)
        exits_near = reach >= now.exits_from
        if cores and not exits_near:
            who, doubtful = meets(
                me, now.frame, table.path[o], table.options[o].stride, now.found, met, table, state,
                work.close, work.unsure,
            )  # fmt: skip
        gone = NOT_A_NUMBER
        if who >= 0:
            met = np.int64(who)
        else:
            if exits_near:
                for a in range(now.found):
                    work.unsure[a] = work.close.people[a].who
                doubtful = now.found
            for a in range(now.touching, len(work.close.people)):
                work.unsure[doubtful] = work.close.people[a].who
                doubtful += 1
            pieces = lay_path(me.row, o, table, state, work.path)
            gone = path_gone_or_blocked(
                me.row, work.path, pieces, np.int64(SAMPLE_FRAMES), reach, now.frame,
                table, state, walls, around, work.unsure[:doubtful], exits_near, cores,
            )  # fmt: skip
        if gone >= -1:
            work.leaving[k] = gone
            if not now.eager:
                key[0] = work.costs[k] + pair_cost(
                    me, k, work.ends, now.neighbours, work.others, state, terms
                )
                if not abs(key[0]) < np.inf:
                    return NOT_A_NUMBER, -1
        else:
            size -= 1
            key[0], item[0] = key[size], item[size]
        if size > 0:
            sift_down(key, item, size, np.int64(0))
