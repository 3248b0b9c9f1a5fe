"""Best-first search for the cheapest option that hits nothing.

Groups of options are opened in rising order of a lower bound of their cost. Pair terms are never
negative, so the sum of the option terms is a lower bound of an option's cost. Adding the pair
costs of the few relevant neighbours gives a tighter one. In rising order of that bound an option
is tested: it is dropped if it hits something, and gets all its pair costs otherwise. Once an
option hits nothing, those that certainly cost more are pruned. In a jam, standing is evaluated
first. The result is exactly that of costing every option.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.intrinsics import prefetch
from mesa_mobility.compiled.simd import (
    AT_ONCE,
    LANES,
    bits_set,
    compress,
    no_more_than,
    place_of_least,
    press_numbers,
)
from mesa_mobility.crowd.collision.broad_phase import ALL_LANES, free_options
from mesa_mobility.crowd.collision.sampled import SLACK, EgoPose
from mesa_mobility.crowd.collision.simd_transforms import lanes_to_world
from mesa_mobility.crowd.costs.layout import END_ROWS, SPEED
from mesa_mobility.crowd.options.option_groups import DURATION, OptionGroups
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.planning.evaluation.lanes import fill_ends, pick_between
from mesa_mobility.crowd.planning.evaluation.neighbour_costs import (
    ENOUGH,
    LITTLE_LESS,
    pair_cost,
    pair_costs_at_least,
)
from mesa_mobility.crowd.planning.evaluation.option_costs import Terms, option_costs, wall_cost
from mesa_mobility.crowd.planning.feasibility import option_gone_or_blocked
from mesa_mobility.crowd.planning.workspace import DecisionContext, Workspace
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings

NONE = -1
NOT_A_NUMBER = -2

FEW = 16
"""Up to this many groups are opened at once, without bands."""

FIRST_BAND = 0.3
"""Width of the first band above the least bound, in which the best option mostly lies."""

WIDENING = 1.3
BANDS = 12
"""Number of bands after which all other groups are opened."""

CROWD = 10
"""From this many relevant neighbours on, evaluate standing first."""

DEAREST = 1e300
"""Cost above which an option counts as blocked."""

_LEAST = -sys.float_info.max

_ROUNDING = 1e-12
"""Relative bound of the rounding error of a sum of costs."""

_AHEAD = 4
"""Groups that are prefetched."""


@force_inlined()
def _open_groups(
    me: EgoPose,
    now: DecisionContext,
    count: int,
    opened: int,
    most: float,
    walls: NDArray[np.float64],
    extra: NDArray[np.float64],
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    work: Workspace,
) -> int:
    """Bound the costs of the options in the first ``opened`` groups of ``work.picked``.

    Options that end within somebody or a wall, or cost more than ``most``, are left out.

    Returns the number of open options, ``count`` before this call; -2 if a cost is not a number.
    """
    picked, free = work.picked, work.free
    apart = me.core + MARGIN - SLACK
    # The cost is faster to test than blockage.
    has_cost_limit = most < np.inf
    for q in range(min(opened, _AHEAD)):
        prefetch(groups.lanes, picked[q], 416)
    n = 0
    for q in range(opened):
        if q + _AHEAD < opened:
            prefetch(groups.lanes, picked[q + _AHEAD], 416)
        g, bits = picked[q], ALL_LANES
        if not has_cost_limit:
            bits = free_options(g, bits, work.bodies, work.fences, apart, groups)
        lanes_to_world(
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
        if has_cost_limit and bits != 0:
            bits = free_options(g, bits, work.bodies, work.fences, apart, groups)
        # Only values that are not numbers compare as no more than the least number.
        bad |= bits & no_more_than(costs, LANES * q, _LEAST)
        press_numbers(groups.first[g], bits, work.rows, kept)
        compress(work.lane_costs, 0, LANES * q, bits, work.costs, 0, kept, 1)
        compress(work.lanes, 0, LANES * q, bits, work.ends, 0, kept, END_ROWS)
        kept += bits_set(bits)
    if now.has_negative_pairs:
        for k in range(count, kept):
            work.costs[k] += pair_cost(
                me, k, work.ends, now.neighbours, work.others, np.inf, state, terms, work.sums,
                work.most_selective_term,
            ) + wall_cost(me, k, work.ends, walls, state, terms)  # fmt: skip
            bad |= int(not abs(work.costs[k]) < np.inf)
    if bad != 0:
        return NOT_A_NUMBER
    has_walls = len(terms.wall_address) > 0 and not now.has_negative_pairs
    fill_ends(count, kept, work.ends)
    pair_costs_at_least(
        me, count, kept, work.ends, now.foremost, now.approximate, work.foremost, work.marks,
        work.some, state, terms, work.least,
    )  # fmt: skip
    for k in range(count, kept):
        work.least[k] += work.costs[k]
        work.approximate[k] = now.approximate
        work.unwalled[k] = has_walls
    for k in range(kept, kept + AT_ONCE):
        work.least[k] = np.inf
    return kept


@internal()
def turns_less(o: int, than: int, table: OptionTable) -> bool:
    """Whether an option turns less than another, or as much and comes before it.

    Without a target no facing is better than another: people would spin on the spot.
    """
    turn, other = abs(table.heading[o]), abs(table.heading[than])
    return bool(turn < other or (turn == other and o < than))


@internal()
def standing(count: int, work: Workspace) -> int:
    """Index of the cheapest of ``count`` options that covers no ground; ``count`` if all do."""
    found = count
    for k in range(count):
        if work.ends[SPEED, k] == 0.0 and (found == count or work.least[k] < work.least[found]):
            found = k
    return found


@internal()
def _enough(most: float, cost: float) -> float:
    """The most that can be added to ``cost`` without exceeding ``most``, rounding aside."""
    return most - cost + _ROUNDING * (abs(most) + abs(cost))


@force_inlined()
def cheapest_free(
    me: EgoPose,
    now: DecisionContext,
    first: int,
    bounds: NDArray[np.float64],
    lowest: float,
    walls: NDArray[np.float64],
    extra: NDArray[np.float64],
    hard_bodies: bool,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    around: Surroundings,
    terms: Terms,
    work: Workspace,
) -> tuple[int, int]:
    """The cheapest option of a pedestrian that hits nothing.

    Args:
        me: the pedestrian.
        now: context of its decision.
        first: the first group of its cluster.
        bounds: lower bound of the costs in each group from there on; inf where all options are
            certainly blocked.
        lowest: the least of them.
        walls: walls within reach, with squared distances.
        extra: weighted costs of the NumPy terms, or empty.
        hard_bodies: whether bodies are hard.
        table: options of all capabilities.
        groups: these options in groups, with the extent of each.
        state: the crowd.
        around: walls and exits.
        terms: compiled terms.
        work: workspace, with the people around.

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
                    me, now, count, opened, most, walls, extra, table, groups, state, terms, work
                )
            if count < 0:
                return NOT_A_NUMBER, -1
            if stays:
                stays = False
                k = standing(count, work)
                if k < count:
                    dearest = work.least[k]
                    work.approximate[k] = False
                    break
            if count > 0:
                k = place_of_least(work.least, count)
                dearest = work.least[k]
        if dearest > most or dearest > DEAREST:
            return best, leaving
        o, this, least = work.rows[k], k, dearest
        work.least[this] = np.inf
        k = place_of_least(work.least, count)
        dearest = work.least[k]
        # This one is likely to be next.
        prefetch(table.path, work.rows[k], 192)
        prefetch(table.options, work.rows[k], 32)
        if work.unwalled[this]:
            work.unwalled[this] = False
            more = wall_cost(me, this, work.ends, walls, state, terms)
            if not abs(more) < np.inf:
                return NOT_A_NUMBER, -1
            work.costs[this] += more
            bound = least + LITTLE_LESS * more
            if min(dearest, most) < bound:
                work.least[this] = bound
                continue
        if work.approximate[this]:
            # All relevant neighbours.
            work.approximate[this] = False
            more = pair_cost(
                me, this, work.ends, now.foremost, work.foremost,
                _enough(most, work.costs[this]), state, terms, work.sums, work.most_selective_term,
            )  # fmt: skip
            if more == ENOUGH:
                continue
            bound = work.costs[this] + LITTLE_LESS * more
            if min(dearest, most) < bound < np.inf:
                work.least[this] = bound
                continue
        gone, who = option_gone_or_blocked(
            me, now, o, met, walls, hard_bodies, table, state, around, work
        )
        met = np.int64(who)
        if gone < -1:
            continue
        cost = work.costs[this]
        if not now.has_negative_pairs:
            more = pair_cost(
                me, this, work.ends, now.neighbours, work.others, _enough(most, cost), state,
                terms, work.sums, work.most_selective_term,
            )  # fmt: skip
            if more == ENOUGH:
                continue
            cost += more
            if not abs(cost) < np.inf:
                return NOT_A_NUMBER, -1
        if cost < most or (cost == most and turns_less(o, best, table)):
            best, leaving, most = o, gone, cost
