"""Which neighbours are relevant: likely to cost something, or most."""

from __future__ import annotations

import math

import numpy as np

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.costs.kernel_calls import call_pair_loop
from mesa_mobility.crowd.costs.layout import (
    COST,
    ME_PREFERRED,
    ME_TARGET_X,
    ME_TARGET_Y,
    OTHER_EX,
    OTHER_EY,
    OTHER_VX,
    OTHER_VY,
    OTHER_X,
    OTHER_Y,
    SECONDS,
    SPEED,
    KernelTable,
)
from mesa_mobility.crowd.options.option_groups import DURATION, FASTEST, SLOWEST, OptionGroups
from mesa_mobility.crowd.planning.evaluation.lanes import in_lanes, pick_between
from mesa_mobility.crowd.planning.workspace import DecisionContext, Neighbours, Workspace

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
"""Metres within which people count as near, or as in somebody's way to their target."""


@force_inlined()
def mark_relevant(
    now: DecisionContext, groups: OptionGroups, table: KernelTable, work: Workspace
) -> bool:
    """Mark for each of the foremost neighbours the pair terms to which it is relevant.

    A few groups that are likely to be opened are probed, each as if it were one option. ``work``
    has their ends.

    Returns:
        False if there are too few neighbours to leave any out.
    """
    count, me, others = now.foremost, now.me, work.neighbours.others
    marks = work.neighbours.marks
    if count <= FEW_NEIGHBOURS or len(table.address) > MOST_TERMS:
        return False
    n = pick_between(now.bounds, -np.inf, now.lowest + LIKELY, 0, work.opened.picked)
    marks[:count] = 0
    costs, ends, of, lanes = others[COST], work.opened.ends, groups.ends, in_lanes(count)
    for asked in range(PROBE_GROUPS):
        a = work.opened.picked[(2 * asked + 1) * n // (2 * PROBE_GROUPS)]
        g = now.first + a
        ends[SECONDS, a] = of[DURATION, g]
        ends[SPEED, a] = 0.5 * (of[SLOWEST, g] + of[FASTEST, g])
        for t in range(len(table.address)):
            call_pair_loop(
                table.address[t],
                (lanes, ends[:, a:], others, me.record, table.fields[t], table.numbers[t], costs),
            )
            for b in range(count):
                marks[b] |= int(costs[b] * table.weight[me.kind, t] > WORTH_MENTION) << t
    return True


@internal()
def select_relevant(me: Decider, count: int, neighbours: Neighbours) -> int:
    """Move the relevant ones of the first ``count`` neighbours, likely to cost most, to the front.

    These would come near if the pedestrian walked to their target at their preferred speed, or come
    towards the pedestrian. A sum of pair terms over them alone is a lower bound of the sum over
    all.

    Returns their number.
    """
    others, moved, relevant = neighbours.others, neighbours.moved, neighbours.marks
    own_x, own_y = me.x, me.y
    ex, ey = me.record[ME_TARGET_X] - own_x, me.record[ME_TARGET_Y] - own_y
    away = math.sqrt(ex * ex + ey * ey)
    along = me.record[ME_PREFERRED] / away if away > 0.0 else 0.0
    own_vx, own_vy = along * ex, along * ey
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
        relevant[a] = np.int64(near | (towards & facing & beside))
    n = 0
    for a in range(count):
        moved[n] = a
        n += relevant[a]
    for row in range(len(others)):
        of = others[row]
        for b in range(n):
            a = moved[b]
            of[a], of[b] = of[b], of[a]
    return n
