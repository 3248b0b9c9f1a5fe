"""Bounds of the costs of the options in groups that the search opens."""

from __future__ import annotations

import sys

import numpy as np

from mesa_mobility.compiled.decorators import force_inlined
from mesa_mobility.compiled.intrinsics import prefetch
from mesa_mobility.compiled.simd import (
    AT_ONCE,
    LANES,
    bits_set,
    compress,
    no_more_than,
    press_numbers,
)
from mesa_mobility.crowd.collision.broad_phase import ALL_LANES, free_options
from mesa_mobility.crowd.collision.sampled import SLACK
from mesa_mobility.crowd.collision.simd_transforms import lanes_to_world
from mesa_mobility.crowd.costs.layout import END_ROWS
from mesa_mobility.crowd.options.option_groups import DURATION
from mesa_mobility.crowd.planning.evaluation.lanes import fill_ends
from mesa_mobility.crowd.planning.evaluation.neighbour_costs import pair_cost, pair_costs_at_least
from mesa_mobility.crowd.planning.evaluation.option_costs import option_costs, wall_cost
from mesa_mobility.crowd.planning.workspace import DecisionContext, FrameContext, Workspace
from mesa_mobility.crowd.state.clearances import MARGIN

NOT_A_NUMBER = -2

_LEAST = -sys.float_info.max

_AHEAD = 4
"""Groups that are prefetched."""


@force_inlined()
def open_groups(
    now: DecisionContext,
    approximate: bool,
    scene: FrameContext,
    count: int,
    opened: int,
    most: float,
    work: Workspace,
) -> int:
    """Bound the costs of the options in the first ``opened`` groups of ``Opened.picked``.

    Options that end within somebody or a wall, or cost more than ``most``, are left out.

    Returns the number of open options, ``count`` before this call; -2 if a cost is not a number.
    """
    me, groups, terms = now.me, scene.groups, scene.terms
    to, close = work.opened, work.neighbours.close
    picked, free = to.picked, to.free
    apart, pose = me.core + MARGIN - SLACK, (me.x, me.y, me.c, me.s)
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
            bits = free_options(g, bits, close, work.blocks, apart, groups)
        seconds = groups.ends[DURATION, g]
        lanes_to_world(groups.lanes, g, to.lanes, LANES * n, pose, seconds)
        picked[n], free[n] = g, bits
        n += int(bits != 0)
    if n == 0:
        return count
    costs = to.lane_costs[: LANES * n]
    costs[:] = 0.0
    if len(now.extra) > 0:
        base = scene.table.offsets[scene.state.cluster[me.row]]
        for q in range(n):
            row = groups.first[picked[q]]
            for lane in range(groups.first[picked[q] + 1] - row):
                costs[LANES * q + lane] = now.extra[row + lane - base]
    option_costs(me, to.lanes, terms.option, costs)
    bad, kept = 0, count
    for q in range(n):
        g, bits = picked[q], free[q] & no_more_than(costs, LANES * q, most)
        if has_cost_limit and bits != 0:
            bits = free_options(g, bits, close, work.blocks, apart, groups)
        # Only values that are not numbers compare as no more than the least number.
        bad |= bits & no_more_than(costs, LANES * q, _LEAST)
        press_numbers(groups.first[g], bits, to.rows, kept)
        compress(to.lane_costs, 0, LANES * q, bits, to.costs, 0, kept, 1)
        compress(to.lanes, 0, LANES * q, bits, to.ends, 0, kept, END_ROWS)
        kept += bits_set(bits)
    to.known[count:kept] = 0.0
    if now.has_negative_pairs:
        around, everybody = work.neighbours, now.neighbours
        for k in range(count, kept):
            known = to.known[k]
            pairs = pair_cost(me, k, to.ends, everybody, 0, around, known, np.inf, terms.pair)
            to.costs[k] += pairs + wall_cost(me, k, to.ends, now.walls, terms.wall)
            bad |= int(not abs(to.costs[k]) < np.inf)
    if bad != 0:
        return NOT_A_NUMBER
    has_walls = len(terms.wall.address) > 0 and not now.has_negative_pairs
    fill_ends(count, kept, to.ends)
    pair_costs_at_least(now, approximate, count, kept, terms, work)
    for k in range(count, kept):
        to.least[k] += to.costs[k]
        to.approximate[k] = approximate
        to.unwalled[k] = has_walls
    for k in range(kept, kept + AT_ONCE):
        to.least[k] = np.inf
    return kept
