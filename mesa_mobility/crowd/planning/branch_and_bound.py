"""Best-first search for the cheapest option that hits nothing.

Groups of options are opened in rising order of a lower bound of their cost. Pair terms are never
negative, so the sum of the option terms is a lower bound of an option's cost. Adding the pair
costs of the few relevant neighbours gives a tighter one. In rising order of that bound an option
is tested: it is dropped if it hits something, and gets all its pair costs otherwise. Once an
option hits nothing, those that certainly cost more are pruned. In a jam, standing is evaluated
first. The result is exactly that of costing every option.
"""

from __future__ import annotations

import numpy as np

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.intrinsics import prefetch
from mesa_mobility.compiled.simd import place_of_least
from mesa_mobility.crowd.costs.layout import SPEED
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.planning.evaluation.lanes import pick_between
from mesa_mobility.crowd.planning.evaluation.neighbour_costs import ENOUGH, LITTLE_LESS, pair_cost
from mesa_mobility.crowd.planning.evaluation.opened_groups import NOT_A_NUMBER, open_groups
from mesa_mobility.crowd.planning.evaluation.option_costs import wall_cost
from mesa_mobility.crowd.planning.feasibility import option_gone_or_blocked
from mesa_mobility.crowd.planning.workspace import DecisionContext, FrameContext, Opened, Workspace

NONE = -1

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

_ROUNDING = 1e-12
"""Relative bound of the rounding error of a sum of costs."""


@internal()
def turns_less(o: int, than: int, table: OptionTable) -> bool:
    """Whether an option turns less than another, or as much and comes before it.

    Without a target no facing is better than another: people would spin on the spot.
    """
    turn, other = abs(table.heading[o]), abs(table.heading[than])
    return bool(turn < other or (turn == other and o < than))


@internal()
def standing(count: int, options: Opened) -> int:
    """Index of the cheapest option to stand still among the first ``count`` options.

    The cheapest is the one with the least lower bound.  Returns ``count`` if none stands still.
    """
    found = count
    for k in range(count):
        if options.ends[SPEED, k] == 0.0 and (
            found == count or options.least[k] < options.least[found]
        ):
            found = k
    return found


@internal()
def _enough(most: float, cost: float) -> float:
    """The most that can be added to ``cost`` without exceeding ``most``, rounding aside."""
    return most - cost + _ROUNDING * (abs(most) + abs(cost))


@force_inlined()
def cheapest_free(
    now: DecisionContext, approximate: bool, scene: FrameContext, work: Workspace
) -> tuple[int, int]:
    """The cheapest option of a pedestrian that hits nothing.

    Args:
        now: the pedestrian's decision.
        approximate: whether bounds count marked neighbours only.
        scene: the frame.
        work: workspace, with the people around.

    Returns:
        The option's row in the table, that of the least turn if several cost the same, -1 if all
        hit something, -2 if a cost is not a number; the frame of leaving by an exit, or -1.
    """
    table, terms, me, options = scene.table, scene.terms, now.me, work.opened
    bounds, first = now.bounds, now.first
    # Typed, as functions are compiled once more for literal numbers.
    best, leaving, most = NONE, -1, np.inf
    band, count, met, k = np.int64(0), np.int64(0), np.int64(0), np.int64(0)
    up_to, dearest = -np.inf, np.inf
    stays = now.stay >= first and bounds[now.stay - first] < np.inf
    while True:
        while stays or (up_to < DEAREST and dearest > up_to and up_to < most):
            opened = 0
            if stays:
                options.picked[0] = now.stay
                bounds[now.stay - first] = np.inf
                opened = 1
            else:
                above = up_to
                if best >= 0:
                    up_to = min(most, DEAREST)
                elif band < BANDS and now.ranked:
                    up_to = now.lowest + FIRST_BAND * WIDENING**band
                else:
                    up_to = DEAREST
                band += 1
                opened = pick_between(bounds, above, up_to, first, options.picked)
            if opened > 0:
                count = open_groups(now, approximate, scene, count, opened, most, work)
            if count < 0:
                return NOT_A_NUMBER, -1
            if stays:
                stays = False
                k = standing(count, options)
                if k < count:
                    dearest = options.least[k]
                    options.approximate[k] = False
                    break
            if count > 0:
                k = place_of_least(options.least, count)
                dearest = options.least[k]
        if dearest > most or dearest > DEAREST:
            return best, leaving
        o, this, least = options.rows[k], k, dearest
        options.least[this] = np.inf
        k = place_of_least(options.least, count)
        dearest = options.least[k]
        # This one is likely to be next.
        prefetch(table.path, options.rows[k], 192)
        prefetch(table.options, options.rows[k], 32)
        if options.unwalled[this]:
            options.unwalled[this] = False
            more = wall_cost(me, this, options.ends, now.walls, terms.wall)
            if not abs(more) < np.inf:
                return NOT_A_NUMBER, -1
            options.costs[this] += more
            bound = least + LITTLE_LESS * more
            if min(dearest, most) < bound:
                options.least[this] = bound
                continue
        if options.approximate[this]:
            # All relevant neighbours.
            options.approximate[this] = False
            enough, some, around = _enough(most, options.costs[this]), now.foremost, work.neighbours
            known = options.known[this]
            more = pair_cost(me, this, options.ends, some, 0, around, known, enough, terms.pair)
            if more == ENOUGH:
                continue
            bound = options.costs[this] + LITTLE_LESS * more
            if min(dearest, most) < bound < np.inf:
                options.least[this] = bound
                continue
        hard_bodies = scene.rules.hard_bodies
        gone, who = option_gone_or_blocked(
            now, scene.frame, o, met, hard_bodies, table, scene.state, scene.around, work
        )
        met = np.int64(who)
        if gone < -1:
            continue
        cost = options.costs[this]
        if not now.has_negative_pairs:
            enough, everybody, around = _enough(most, cost), now.neighbours, work.neighbours
            moved, known = now.foremost, options.known[this]
            more = pair_cost(
                me, this, options.ends, everybody, moved, around, known, enough, terms.pair
            )
            if more == ENOUGH:
                continue
            cost += more
            if not abs(cost) < np.inf:
                return NOT_A_NUMBER, -1
        if cost < most or (cost == most and turns_less(o, best, table)):
            best, leaving, most = o, gone, cost
