"""The search for the cheapest option that hits nothing, best first.

Groups of options are opened in rising order of a lower bound of what their options
cost. Terms over pairs (interference) are never negative, so the sum of the others is
a lower bound of an option's cost, and a better one with its pair costs with the few neighbours who
are likely to cost most. In the order of that an option is dropped if it hits something, and given
all its pair costs otherwise. As soon as one hits nothing, whatever certainly costs more is left
alone. The result is that of working everything out; most of it never is.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.clearing import free_lanes
from mesa_mobility.crowd.close import Stance, meets
from mesa_mobility.crowd.collision import Surroundings
from mesa_mobility.crowd.costs import SPEED, Terms, option_costs
from mesa_mobility.crowd.groups import DURATION, OptionGroups
from mesa_mobility.crowd.lanewise import lay_lanes
from mesa_mobility.crowd.motion import lay_path
from mesa_mobility.crowd.options import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.pairs import LITTLE_LESS, fill_ends, least, pair_cost, pair_costs_at_least
from mesa_mobility.crowd.passage import hits_anybody, path_gone_or_walled
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.work import Setting, Work
from mesa_mobility.jit import lean, part
from mesa_mobility.lanes import AT_ONCE, LANES, lowest_bit, place_of_least
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

DEAREST = 1e300
"""What costs more is blocked."""

_AHEAD = 4
"""Groups that are fetched before they are needed."""


@part()
def _open_groups(
    me: Stance,
    now: Setting,
    count: int,
    above: float,
    up_to: float,
    most: float,
    first: int,
    bounds: NDArray[np.float64],
    extra: NDArray[np.float64],
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    work: Work,
) -> int:
    """Work out what options may cost in groups with bounds from ``above`` to ``up_to``.

    Left out are those within somebody, and those that cost more than ``most``.

    Returns the number of options looked at so far, ``count`` before; -2 if a cost is not a number.
    """
    picked, free = work.picked, work.free
    opened = 0
    for a in range(len(bounds)):
        picked[opened] = first + a
        opened += int((above < bounds[a]) & (bounds[a] <= up_to))
    for q in range(min(opened, _AHEAD)):
        fetch(groups.lanes, picked[q], 416)
    n = 0
    for q in range(opened):
        if q + _AHEAD < opened:
            fetch(groups.lanes, picked[q + _AHEAD], 416)
        g = picked[q]
        bits = free_lanes(g, work.bodies, groups)
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
        row, bits = groups.first[picked[q]], free[q]
        while bits != 0:
            lane = lowest_bit(bits)
            bits &= bits - 1
            k = LANES * q + lane
            cost = costs[k]
            bad |= int(not abs(cost) < np.inf)
            work.rows[kept], work.costs[kept] = row + lane, cost
            for field in range(SPEED + 1):
                work.ends[field, kept] = work.lanes[field, k]
            kept += int(cost <= most)
    if now.eager:
        for k in range(count, kept):
            work.costs[k] += pair_cost(me, k, work.ends, now.neighbours, work.others, state, terms)
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


@part()
def cheapest_free(
    me: Stance,
    now: Setting,
    first: int,
    bounds: NDArray[np.float64],
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
    lowest = least(bounds)
    # Typed, as functions are compiled once more for literal numbers.
    best, leaving, most = NONE, -1, np.inf
    band, count, met, k = np.int64(0), np.int64(0), np.int64(0), np.int64(0)
    up_to, dearest = -np.inf, np.inf
    while True:
        while up_to < DEAREST and dearest > up_to and up_to < most:
            above = up_to
            if best >= 0:
                up_to = min(most, DEAREST)
            elif band < BANDS and now.ranked:
                up_to = lowest + FIRST_BAND * WIDENING**band
            else:
                up_to = DEAREST
            band += 1
            count = _open_groups(
                me, now, count, above, up_to, most, first, bounds, extra, table, groups, state,
                terms, work,
            )  # fmt: skip
            if count < 0:
                return NOT_A_NUMBER, -1
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
            bound = work.costs[this] + LITTLE_LESS * pair_cost(
                me, this, work.ends, now.foremost, work.foremost, state, terms
            )
            if min(dearest, most) < bound < np.inf:
                work.least[this] = bound
                continue
        reach = np.float64(table.options[o].reach)
        exits_near = reach >= now.exits_from
        pieces = lay_path(me.row, o, me.c, me.s, table, state, work.path)
        gone = path_gone_or_walled(
            me.row, work.path, pieces, np.int64(SAMPLE_FRAMES), reach, now.frame, state, walls,
            around, exits_near,
        )  # fmt: skip
        if gone < -1:
            continue
        if cores:
            # Whoever may be out before may not meet anybody of those ahead.
            if exits_near:
                doubtful = now.found
                for a in range(now.found):
                    work.unsure[a] = work.close.people[a].who
            else:
                who, doubtful = meets(
                    me, now.frame, table.path[o], table.options[o].stride, now.found, met, table,
                    state, work.close, work.unsure,
                )  # fmt: skip
                if who >= 0:
                    met = np.int64(who)
                    continue
            for a in range(now.touching, len(work.close.people)):
                work.unsure[doubtful] = work.close.people[a].who
                doubtful += 1
            if hits_anybody(
                me.row, work.path, pieces, np.int64(SAMPLE_FRAMES), now.frame, gone, table, state,
                work.unsure[:doubtful],
            ):  # fmt: skip
                continue
        cost = work.costs[this]
        if not now.eager:
            cost += pair_cost(me, this, work.ends, now.neighbours, work.others, state, terms)
            if not abs(cost) < np.inf:
                return NOT_A_NUMBER, -1
        if cost < most or (cost == most and turns_less(o, best, table)):
            best, leaving, most = o, gone, cost
