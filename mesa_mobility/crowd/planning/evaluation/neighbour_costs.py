"""Pair costs of an option over all neighbours, and a lower bound over the relevant ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, any_of
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.costs.kernel_calls import call_pair_loop, call_pairs_loop
from mesa_mobility.crowd.costs.layout import COST, KernelTable, Terms
from mesa_mobility.crowd.planning.evaluation.lanes import in_lanes
from mesa_mobility.crowd.planning.workspace import DecisionContext, Neighbours, Workspace

LITTLE_LESS = 1.0 - 1e-9
"""Factor by which a sum over some neighbours is reduced, so that rounding cannot lift it above the
sum over all."""

ENOUGH = -1.0
"""Stands for a cost above the limit."""


@internal()
def pair_cost(
    me: Decider,
    k: int,
    ends: NDArray[np.float64],
    count: int,
    moved: int,
    around: Neighbours,
    known: NDArray[np.float64],
    enough: float,
    table: KernelTable,
) -> float:
    """Weighted sum of the pair terms of option k over the first ``count`` neighbours.

    Args:
        me: the pedestrian.
        k: the option.
        ends: (6, n) ends of options.
        count: number of neighbours, from the first column on.
        moved: number of them who were moved to the front, if they are to be summed in the order of
            the grid: the last bit of a sum depends on it.
        around: these, in full lanes (see ``fill_lane``).
        known: (terms,) lower bounds of the sums by term, such as those over fewer neighbours; gets
            these sums as far as they are evaluated. 0 where nothing is known.
        enough: limit above which the sum does not matter; finite only if no pair cost is negative.
        table: the pair terms; that which exceeds the limit is the first to be evaluated next time.

    Returns:
        The sum, or ``ENOUGH`` if it certainly exceeds the limit.
    """
    others, n, so_far, option = around.others, len(table.address), 0.0, ends[:, k:]
    costs = others[COST]
    for t in range(n):
        so_far += known[t]
    lanes, first_term = in_lanes(count), around.first[0] if around.first[0] < n else 0
    for q in range(n):
        t = first_term + q if first_term + q < n else first_term + q - n
        call_pair_loop(
            table.address[t],
            (lanes, option, others, me.record, table.fields[t], table.numbers[t], costs),
        )
        for b in range(moved - 1, -1, -1):
            a = around.moved[b]
            costs[a], costs[b] = costs[b], costs[a]
        summed = 0.0
        for first in range(0, count, LANES):
            # Most neighbours are too far away to cost anything: additions, which wait for one
            # another, are skipped.
            if any_of(costs, first):
                for a in range(first, min(first + LANES, count)):
                    summed += costs[a]
        more = table.weight[me.kind, t] * summed
        so_far += more - known[t]
        known[t] = more
        if enough < so_far * LITTLE_LESS < np.inf:
            around.first[0] = t
            return ENOUGH
    # In the order of the terms, whichever came first.
    total = 0.0
    for t in range(n):
        total += known[t]
    return total


@force_inlined()
def pair_costs_at_least(
    now: DecisionContext, approximate: bool, first: int, last: int, terms: Terms, work: Workspace
) -> None:
    """Write lower bounds of ``pair_cost`` for the open options ``first`` to ``last``.

    Options are in full lanes (see ``fill_ends``). A bound sums over the foremost neighbours, or if
    ``approximate`` over the marked ones among them. It holds whatever the order of summation.
    """
    n, me, table = in_lanes(last - first), now.me, terms.pair
    around, marked = work.neighbours, work.neighbours.marked
    least, ends = work.opened.least[first : first + n], work.opened.ends[:, first:]
    least[:] = 0.0
    for t in range(len(terms.pairs_address)):
        count = 0
        for a in range(now.foremost):
            marked[count] = a
            count += int(not approximate or around.marks[a] >> t & 1)
        at, numbers, weight = table.fields[t], table.numbers[t], table.weight[me.kind, t]
        call_pairs_loop(
            terms.pairs_address[t],
            (count, marked, n, ends, around.others, me.record, at, numbers, weight, least),
        )
    for k in range(last - first):
        # A value that is not a number is found by the sum over all neighbours.
        least[k] = least[k] * LITTLE_LESS if least[k] < np.inf else 0.0
