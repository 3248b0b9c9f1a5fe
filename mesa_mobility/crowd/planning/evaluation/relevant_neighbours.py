"""Which neighbours are relevant: likely to cost something, or most."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.crowd.collision.sampled import EgoPose
from mesa_mobility.crowd.costs.kernel_calls import call_pair_loop
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
)
from mesa_mobility.crowd.options.option_groups import DURATION, FASTEST, SLOWEST, OptionGroups
from mesa_mobility.crowd.planning.evaluation.lanes import fill_lane, in_lanes, pick_between
from mesa_mobility.crowd.planning.evaluation.option_costs import Terms, preferred_now
from mesa_mobility.crowd.state.records import CrowdState

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
