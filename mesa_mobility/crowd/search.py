"""The search for the cheapest option that hits nothing, best first.

Groups of options are opened in rising order of a lower bound of what their options
cost. Terms over pairs (interference) are never negative, so the sum of the others is
a lower bound of an option's cost, and a better one with its pair costs with the few neighbours who
are likely to cost most. In the order of that an option is dropped if it hits something, and given
all its pair costs otherwise. As soon as one hits nothing, whatever certainly costs more is left
alone; in a jam it is looked first at what it costs to stay where one is. The result is that of
working everything out; most of it never is.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.clearing import ALL_LANES, free_lanes
from mesa_mobility.crowd.close import SLACK, Stance
from mesa_mobility.crowd.collision import MARGIN, Surroundings
from mesa_mobility.crowd.costs import END_ROWS, SPEED, Terms, option_costs
from mesa_mobility.crowd.groups import DURATION, OptionGroups
from mesa_mobility.crowd.laying import lay_lanes
from mesa_mobility.crowd.options import OptionTable
from mesa_mobility.crowd.pairs import (
    ENOUGH,
    LITTLE_LESS,
    fill_ends,
    pair_cost,
    pair_costs_at_least,
    pick_between,
)
from mesa_mobility.crowd.passage import option_gone_or_blocked
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.work import Setting, Work
from mesa_mobility.jit import lean, part
from mesa_mobility.lanes import (
    AT_ONCE,
    LANES,
    bits_set,
    no_more_than,
    place_of_least,
    press_lanes,
    press_numbers,
)
from mesa_mobility.machine import fetch

NONE = -1
NOT_A_NUMBER = -2

FEW = 16
"""Groups that are all opened at once, without working in bands."""

FIRST_BAND = 0.15
"""Width of the first band above the least bound; the first options mostly decide."""

WIDENING = 2.0
BANDS = 8
"""Bands after which all the rest is opened."""

CROWD = 10
"""Likely neighbours from whom on it is looked first at what it costs to stay where one is."""

DEAREST = 1e300
"""What costs more is blocked."""

_LEAST = -sys.float_info.max

_ROUNDING = 1e-12
"""Share of a cost that is more than what sums of costs are rounded by."""

_AHEAD = 4
"""Groups that are fetched before they are needed."""


@part()
def _open_groups(
    me: Stance,
    now: Setting,
    count: int,
    opened: int,
    most: float,
    extra: NDArray[np.float64],
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    work: Work,
) -> int:
    """Work out what options may cost in the first ``opened`` groups that are picked.

    Left out are those within somebody or a wall, and those that cost more than ``most``.
    Picked are numbers of groups in ``work.picked``.

    Returns the number of options looked at so far, ``count`` before; -2 if a cost is not a number.
    """
    picked, free = work.picked, work.free
    apart = me.core + MARGIN - SLACK
    # What costs too much is told sooner than what is blocked.
    dear = most < np.inf
    for q in range(min(opened, _AHEAD)):
        fetch(groups.lanes, picked[q], 416)
    n = 0
    for q in range(opened):
        if q + _AHEAD < opened:
            fetch(groups.lanes, picked[q + _AHEAD], 416)
        g, bits = picked[q], ALL_LANES
        if not dear:
            bits = free_lanes(g, bits, work.bodies, work.fences, apart, groups)
        lay_lanes(
            groups.lanes, g, work.lanes, LANES * n, me.c, me.s, me.x, me.y, groups.ends[DURATION, g]
        )
        picked[n], free[n] = g, bits
        n += int(bits != 0)
    if n == 0:
        return count
    costs = work.lane_costs[: LANES * n]
    costs[:] = 0.0
    if len(extra) > 0:
        base = table.offsets[state.cluster[me.row]]
        for q in range(n):
            row = groups.first[picked[q]]
            for lane in range(groups.first[picked[q] + 1] - row):
                costs[LANES * q + lane] = extra[row + lane - base]
    option_costs(me, 0, LANES * n, work.lanes, state, terms, costs)
    bad, kept = 0, count
    for q in range(n):
        g, bits = picked[q], free[q] & no_more_than(costs, LANES * q, most)
        if dear and bits != 0:
            bits = free_lanes(g, bits, work.bodies, work.fences, apart, groups)
        # No more than the least of numbers are those alone that are none.
        bad |= bits & no_more_than(costs, LANES * q, _LEAST)
        press_numbers(groups.first[g], bits, work.rows, kept)
        press_lanes(work.lane_costs, 0, LANES * q, bits, work.costs, 0, kept, 1)
        press_lanes(work.lanes, 0, LANES * q, bits, work.ends, 0, kept, END_ROWS)
        kept += bits_set(bits)
    if now.eager:
        for k in range(count, kept):
            work.costs[k] += pair_cost(
                me, k, work.ends, now.neighbours, work.others, np.inf, state, terms, work.sums,
                work.telling,
            )  # fmt: skip
            bad |= int(not abs(work.costs[k]) < np.inf)
    if bad != 0:
        return NOT_A_NUMBER
    fill_ends(count, kept, work.ends)
    pair_costs_at_least(
        me, count, kept, work.ends, now.foremost, now.rough, work.foremost, work.marks, work.some,
        state, terms, work.least,
    )  # fmt: skip
    for k in range(count, kept):
        work.least[k] += work.costs[k]
        work.rough[k] = now.rough
    for k in range(kept, kept + AT_ONCE):
        work.least[k] = np.inf
    return kept


@lean()
def turns_less(o: int, than: int, table: OptionTable) -> bool:
    """Whether an option turns less than another, or no more and comes before it.

    Whoever has nowhere to go faces no way rather than another, and would turn round and round.
    """
    turn, other = abs(table.heading[o]), abs(table.heading[than])
    return bool(turn < other or (turn == other and o < than))


@lean()
def standing(count: int, work: Work) -> int:
    """Number of the cheapest of ``count`` options that covers no ground; ``count`` if none does."""
    found = count
    for k in range(count):
        if work.ends[SPEED, k] == 0.0 and (found == count or work.least[k] < work.least[found]):
            found = k
    return found


@lean()
def _enough(most: float, cost: float) -> float:
    """What an option may cost more, rounding aside, lest it cost more than ``most``."""
    return most - cost + _ROUNDING * (abs(most) + abs(cost))


@part()
def cheapest_free(
    me: Stance,
    now: Setting,
    first: int,
    bounds: NDArray[np.float64],
    lowest: float,
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
        first: the first group of its cluster.
        bounds: lower bounds of what the options cost in groups from there on; inf where they
            are certainly blocked.
        lowest: the least of them.
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
        The option's row in the table, that of the least turn if several cost the same, -1 if all
        hit something, -2 if a cost is not a number; the frame of leaving by an exit, or -1.
    """
    # Typed, as functions are compiled once more for literal numbers.
    best, leaving, most = NONE, -1, np.inf
    band, count, met, k = np.int64(0), np.int64(0), np.int64(0), np.int64(0)
    up_to, dearest = -np.inf, np.inf
    stays = now.stay >= first and bounds[now.stay - first] < np.inf
    while True:
        while stays or (up_to < DEAREST and dearest > up_to and up_to < most):
            opened = 0
            if stays:
                work.picked[0] = now.stay
                bounds[now.stay - first] = np.inf
                opened = 1
            else:
                above = up_to
                if best >= 0:
                    up_to = min(most, DEAREST)
                elif band < BANDS and now.ranked:
                    up_to = lowest + FIRST_BAND * WIDENING**band
                else:
                    up_to = DEAREST
                band += 1
                opened = pick_between(bounds, above, up_to, first, work.picked)
            if opened > 0:
                count = _open_groups(
                    me, now, count, opened, most, extra, table, groups, state, terms, work
                )
            if count < 0:
                return NOT_A_NUMBER, -1
            if stays:
                stays = False
                k = standing(count, work)
                if k < count:
                    dearest = work.least[k]
                    work.rough[k] = False
                    break
            if count > 0:
                k = place_of_least(work.least, count)
                dearest = work.least[k]
        if dearest > most or dearest > DEAREST:
            return best, leaving
        o, this = work.rows[k], k
        work.least[this] = np.inf
        k = place_of_least(work.least, count)
        dearest = work.least[k]
        # This one is likely to be next.
        fetch(table.path, work.rows[k], 192)
        fetch(table.options, work.rows[k], 32)
        if work.rough[this]:
            # Whoever is likely to cost most, all of them.
            work.rough[this] = False
            more = pair_cost(
                me, this, work.ends, now.foremost, work.foremost,
                _enough(most, work.costs[this]), state, terms, work.sums, work.telling,
            )  # fmt: skip
            if more == ENOUGH:
                continue
            bound = work.costs[this] + LITTLE_LESS * more
            if min(dearest, most) < bound < np.inf:
                work.least[this] = bound
                continue
        gone, who = option_gone_or_blocked(
            me, now, o, met, walls, cores, table, state, around, work
        )
        met = np.int64(who)
        if gone < -1:
            continue
        cost = work.costs[this]
        if not now.eager:
            more = pair_cost(
                me, this, work.ends, now.neighbours, work.others, _enough(most, cost), state,
                terms, work.sums, work.telling,
            )  # fmt: skip
            if more == ENOUGH:
                continue
            cost += more
            if not abs(cost) < np.inf:
                return NOT_A_NUMBER, -1
        if cost < most or (cost == most and turns_less(o, best, table)):
            best, leaving, most = o, gone, cost
