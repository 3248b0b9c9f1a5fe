"""Pair costs of an option over all neighbours, and a lower bound over the relevant ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, any_of
from mesa_mobility.crowd.collision.sampled import EgoPose
from mesa_mobility.crowd.costs.kernel_calls import (
    call_pair_bound_loop,
    call_pair_loop,
    call_pairs_loop,
)
from mesa_mobility.crowd.costs.layout import (
    COST,
    END_UX,
    END_UY,
    END_X,
    END_Y,
    FIELDS,
    LEAD,
    OTHER_EX,
    OTHER_EY,
    OTHER_VX,
    OTHER_VY,
    OTHER_X,
    OTHER_Y,
    SECONDS,
    SPEED,
)
from mesa_mobility.crowd.options.option_groups import (
    DURATION,
    FASTEST,
    RADIUS,
    SLOWEST,
    TURN,
    OptionGroups,
)
from mesa_mobility.crowd.planning.evaluation.lanes import in_lanes
from mesa_mobility.crowd.planning.evaluation.option_costs import Terms
from mesa_mobility.crowd.state.records import CrowdState

LITTLE_LESS = 1.0 - 1e-9
"""Factor by which a sum over some neighbours is reduced, so that rounding cannot lift it above the
sum over all."""

ENOUGH = -1.0
"""Stands for a cost above the limit."""


@internal()
def pair_cost(
    me: EgoPose,
    k: int,
    ends: NDArray[np.float64],
    count: int,
    others: NDArray[np.float64],
    enough: float,
    state: CrowdState,
    terms: Terms,
    sums: NDArray[np.float64],
    most_selective_term: NDArray[np.int64],
) -> float:
    """Weighted sum of the pair terms of option k over the first ``count`` neighbours.

    Args:
        me: the pedestrian.
        k: the option.
        ends: (6, n) ends of options.
        count: number of neighbours.
        others: (8 + fields, n) the neighbours, in full lanes (see ``fill_lane``).
        enough: limit above which the sum does not matter; finite only if no pair cost is negative.
        state: the crowd.
        terms: compiled terms.
        sums: (terms,) workspace.
        most_selective_term: (1,) the term to evaluate first, updated to the one that exceeded the
            limit.

    Returns:
        The sum, or ``ENOUGH`` if it certainly exceeds the limit.
    """
    costs, n, so_far = others[COST], len(terms.pair_address), 0.0
    kind = state.type_index[me.row]
    first_term = most_selective_term[0] if most_selective_term[0] < n else 0
    for q in range(n):
        t = first_term + q if first_term + q < n else first_term + q - n
        call_pair_loop(
            terms.pair_address[t], in_lanes(count), ends[END_X, k], ends[END_Y, k],
            ends[END_UX, k], ends[END_UY, k], ends[SECONDS, k], ends[SPEED, k], me.x, me.y,
            state.target_x[me.row], state.target_y[me.row], others[OTHER_X], others[OTHER_Y],
            others[OTHER_VX], others[OTHER_VY], others[OTHER_EX], others[OTHER_EY], others[LEAD],
            terms.fields[me.row], others[FIELDS:], others.shape[1], terms.pair_fields[t],
            terms.pair_parameters[t], costs,
        )  # fmt: skip
        summed = 0.0
        for first in range(0, count, LANES):
            # Most neighbours are too far away to cost anything: additions, which wait for one
            # another, are skipped.
            if any_of(costs, first):
                for a in range(first, min(first + LANES, count)):
                    summed += costs[a]
        sums[t] = terms.pair_weight[kind, t] * summed
        so_far += sums[t]
        if enough < so_far * LITTLE_LESS < np.inf:
            most_selective_term[0] = t
            return ENOUGH
    # In the order of the terms, whichever came first.
    total = 0.0
    for t in range(n):
        total += sums[t]
    return total


@force_inlined()
def pair_costs_at_least(
    me: EgoPose,
    first: int,
    last: int,
    ends: NDArray[np.float64],
    count: int,
    approximate: bool,
    others: NDArray[np.float64],
    marks: NDArray[np.int64],
    some: NDArray[np.float64],
    state: CrowdState,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Write lower bounds of ``pair_cost`` for options ``first`` to ``last``.

    Options are in full lanes (see ``fill_ends``). A bound sums over the first ``count`` neighbours
    of ``others``, or if ``approximate`` over the marked ones among them. It holds whatever the
    order of summation. ``some`` (8 + fields, n) is workspace.
    """
    n = in_lanes(last - first)
    least, kind = out[first : first + n], state.type_index[me.row]
    least[:] = 0.0
    for t in range(len(terms.pairs_address)):
        counting, given = count, others
        if approximate:
            counting, given = 0, some
            for a in range(count):
                if marks[a] >> t & 1:
                    for row in range(COST):
                        some[row, counting] = others[row, a]
                    for row in range(FIELDS, len(others)):
                        some[row, counting] = others[row, a]
                    counting += 1
        call_pairs_loop(
            terms.pairs_address[t], counting, n, ends[END_X, first:], ends[END_Y, first:],
            ends[END_UX, first:], ends[END_UY, first:], ends[SECONDS, first:], ends[SPEED, first:],
            me.x, me.y, state.target_x[me.row], state.target_y[me.row], given[OTHER_X],
            given[OTHER_Y], given[OTHER_VX], given[OTHER_VY], given[OTHER_EX], given[OTHER_EY],
            given[LEAD], terms.fields[me.row], given[FIELDS:], given.shape[1],
            terms.pair_fields[t], terms.pair_parameters[t], terms.pair_weight[kind, t], least,
        )  # fmt: skip
    for k in range(last - first):
        # A value that is not a number is found by the sum over all neighbours.
        least[k] = least[k] * LITTLE_LESS if least[k] < np.inf else 0.0


@force_inlined()
def add_pair_bounds(
    me: EgoPose,
    first: int,
    last: int,
    groups: OptionGroups,
    count: int,
    others: NDArray[np.float64],
    state: CrowdState,
    terms: Terms,
    ends: NDArray[np.float64],
    some: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Add lower bounds of the pair terms of groups ``first`` to ``last`` over the first ``count``
    neighbours of ``others``.

    ``ends`` has the ends of the groups; ``some``, of one number for each group, is workspace.
    """
    of, n, kind = groups.ends, last - first, state.type_index[me.row]
    some[:n] = 0.0
    for t in range(len(terms.pair_bound_address)):
        if terms.pair_bound_address[t] != 0:
            call_pair_bound_loop(
                terms.pair_bound_address[t], count, n, ends[END_X], ends[END_Y],
                of[RADIUS, first:], ends[END_UX], ends[END_UY], of[TURN, first:],
                of[DURATION, first:], of[SLOWEST, first:], of[FASTEST, first:], me.x, me.y,
                state.target_x[me.row], state.target_y[me.row], others[OTHER_X], others[OTHER_Y],
                others[OTHER_VX], others[OTHER_VY], others[OTHER_EX], others[OTHER_EY],
                others[LEAD], terms.pair_parameters[t], terms.pair_weight[kind, t], some,
            )  # fmt: skip
    for k in range(n):
        # A value that is not a number is found when options are tested.
        out[k] += some[k] * LITTLE_LESS if some[k] < np.inf else 0.0
