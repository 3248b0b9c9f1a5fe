"""Pair costs of an option over all neighbours, and a lower bound over the relevant ones."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, any_of, bits_set, press_numbers
from mesa_mobility.crowd.collision.sampled import EgoPose
from mesa_mobility.crowd.collision.simd_tests import numbers_between
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
from mesa_mobility.crowd.planning.option_costs import Terms, preferred_now
from mesa_mobility.crowd.state.records import CrowdState

LITTLE_LESS = 1.0 - 1e-9
"""Factor by which a sum over some neighbours is reduced, so that rounding cannot lift it above the
sum over all."""

ENOUGH = -1.0
"""Stands for a cost above the limit."""

AHEAD = 1.5
"""Look-ahead in seconds for people who come near: the longest option."""

FEW_NEIGHBOURS = 4
"""Up to this many neighbours are all relevant."""

MOST_TERMS = 60
"""Bits of a mark: pair terms at most."""

PROBE_GROUPS, LIKELY = 3, 1.5
"""Option groups probed to select relevant neighbours, and by how much their bounds may exceed the
least."""

WORTH_MENTION = 0.02
"""Cost that a neighbour must add to a probed group to be relevant."""

NEAR = 0.6
"""Metres within which people count as near, or as in somebody's way to its target."""


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


@force_inlined()
def mark_relevant(
    me: EgoPose,
    first: int,
    bounds: NDArray[np.float64],
    lowest: float,
    ends: NDArray[np.float64],
    groups: OptionGroups,
    count: int,
    others: NDArray[np.float64],
    state: CrowdState,
    terms: Terms,
    likely: NDArray[np.int64],
    marks: NDArray[np.int64],
) -> bool:
    """Mark for each of the first ``count`` neighbours the pair terms to which it is relevant.

    A few groups from ``first`` on that are likely to be opened are probed, each as if it were one
    option. ``ends`` has their ends, ``likely`` is workspace.

    Returns:
        False if there are too few neighbours to leave any out.
    """
    if count <= FEW_NEIGHBOURS or len(terms.pair_address) > MOST_TERMS:
        return False
    n = pick_between(bounds, -np.inf, lowest + LIKELY, 0, likely)
    marks[:count] = 0
    costs, kind = others[COST], state.type_index[me.row]
    for asked in range(PROBE_GROUPS):
        a = likely[(2 * asked + 1) * n // (2 * PROBE_GROUPS)]
        seconds = groups.ends[DURATION, first + a]
        speed = 0.5 * (groups.ends[SLOWEST, first + a] + groups.ends[FASTEST, first + a])
        for t in range(len(terms.pair_address)):
            call_pair_loop(
                terms.pair_address[t], in_lanes(count), ends[END_X, a], ends[END_Y, a],
                ends[END_UX, a], ends[END_UY, a], seconds, speed, me.x, me.y,
                state.target_x[me.row], state.target_y[me.row], others[OTHER_X], others[OTHER_Y],
                others[OTHER_VX], others[OTHER_VY], others[OTHER_EX], others[OTHER_EY],
                others[LEAD], terms.fields[me.row], others[FIELDS:], others.shape[1],
                terms.pair_fields[t], terms.pair_parameters[t], costs,
            )  # fmt: skip
            for b in range(count):
                marks[b] |= int(costs[b] * terms.pair_weight[kind, t] > WORTH_MENTION) << t
    return True


@internal()
def pick_between(
    bounds: NDArray[np.float64],
    above: float,
    up_to: float,
    first: int,
    picked: NDArray[np.int64],
) -> int:
    """Write the indices of bounds, counted from ``first``, that lie in (``above``, ``up_to``].

    Behind the last bound there must be room to read, behind the last number to write 8 of them.
    Returns their number.
    """
    count = 0
    for at in range(0, len(bounds), LANES):
        bits = numbers_between(bounds, at, above, up_to)
        bits &= (1 << min(len(bounds) - at, LANES)) - 1
        press_numbers(first + at, bits, picked, count)
        count += bits_set(bits)
    return count


@internal()
def fill_ends(first: int, last: int, ends: NDArray[np.float64]) -> None:
    """Repeat the last of the options ``first`` to ``last`` until the last lane is full."""
    if last > first:
        for row in range(SPEED + 1):
            for k in range(last, first + in_lanes(last - first)):
                ends[row, k] = ends[row, last - 1]


@internal()
def least(values: NDArray[np.float64]) -> float:
    """Least of some values, none of which is nan; inf if there are none."""
    lowest = np.inf
    for value in values:
        lowest = value if value < lowest else lowest
    return lowest


@internal()
def in_lanes(count: int) -> int:
    """The number rounded up to full lanes."""
    return (count + LANES - 1) // LANES * LANES


@internal()
def fill_lane(count: int, others: NDArray[np.float64]) -> None:
    """Repeat the last of the first ``count`` neighbours until the last lane is full.

    Costs of these copies are computed and ignored: full lanes are faster than a remainder taken one
    by one.
    """
    for row in range(COST):
        for a in range(count, in_lanes(count)):
            others[row, a] = others[row, count - 1]


@internal()
def select_relevant(
    me: EgoPose,
    others: NDArray[np.float64],
    count: int,
    state: CrowdState,
    picked: NDArray[np.int64],
    dropped: NDArray[np.int32],
    to: NDArray[np.float64],
) -> int:
    """Copy the relevant ones of the first ``count`` neighbours, who are likely to cost most.

    They would come near if the pedestrian walked to its target at its preferred speed, or come
    towards it. A sum of pair terms over them alone is a lower bound of the sum over all.

    Args:
        me: the pedestrian.
        others: (8 + fields, n) its neighbours.
        count: their number.
        state: the crowd.
        picked: workspace.
        dropped: workspace.
        to: (8 + fields, n) gets a copy.

    Returns:
        Their number.
    """
    ex, ey = state.target_x[me.row] - me.x, state.target_y[me.row] - me.y
    away = math.sqrt(ex * ex + ey * ey)
    along = preferred_now(me.row, state) / away if away > 0.0 else 0.0
    own_x, own_y, own_vx, own_vy = me.x, me.y, along * ex, along * ey
    x, y, vx, vy = others[OTHER_X], others[OTHER_Y], others[OTHER_VX], others[OTHER_VY]
    to_x, to_y = others[OTHER_EX], others[OTHER_EY]
    for a in range(count):
        dx, dy = x[a] - own_x, y[a] - own_y
        wx, wy = vx[a] - own_vx, vy[a] - own_vy
        t = -(dx * wx + dy * wy) / max(wx * wx + wy * wy, 1e-6)
        t = min(max(t, 0.0), AHEAD)
        qx, qy = dx + t * wx, dy + t * wy
        near = qx * qx + qy * qy < NEAR * NEAR
        towards = dx * to_x[a] + dy * to_y[a] < 0.0
        facing = ex * to_x[a] + ey * to_y[a] < 0.0
        beside = abs(dy * to_x[a] - dx * to_y[a]) < NEAR
        dropped[a] = np.int32(not (near | (towards & facing & beside)))
    n = 0
    for a in range(count):
        picked[n] = a
        n += 1 - dropped[a]
    for row in range(len(others)):
        given, copied = others[row], to[row]
        if row != COST:
            for k in range(n):
                copied[k] = given[picked[k]]
    fill_lane(n, to)
    return n
