"""The people around somebody who decides, gathered when the decision begins."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, bits_set, compress, press_numbers
from mesa_mobility.crowd.collision.sampled import SLACK, Decider, lay_close
from mesa_mobility.crowd.collision.simd_boxes import sweeps_near
from mesa_mobility.crowd.collision.simd_tests import places_near
from mesa_mobility.crowd.costs.layout import (
    AWAY,
    FIELDS,
    LEAD,
    ME_AHEAD,
    ME_CORE,
    ME_PREFERRED,
    ME_TARGET_X,
    ME_TARGET_Y,
    ME_VX,
    ME_VY,
    ME_X,
    ME_Y,
    OTHER_X,
    OTHER_Y,
    Terms,
)
from mesa_mobility.crowd.planning.evaluation.lanes import fill_lane
from mesa_mobility.crowd.planning.following import keep_seen
from mesa_mobility.crowd.planning.grid import farthest_range, interact
from mesa_mobility.crowd.planning.workspace import FrameContext, Neighbours
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import Box
from mesa_mobility.crowd.state.people_grid import COVERED, Grid, cells_within
from mesa_mobility.crowd.state.records import CrowdState


@force_inlined()
def gather_neighbours(
    i: int, place: int, box: Box, scene: FrameContext, to: Neighbours
) -> tuple[Decider, int]:
    """Write pedestrian i, who decides, and the people around.

    Args:
        i: the pedestrian.
        place: their index in the grid.
        box: what they may reach, in their coordinates.
        scene: the frame.
        to: is written.

    Returns:
        The pedestrian, and the number of columns of ``to.others``.
    """
    state, rules, others = scene.state, scene.rules, to.others
    me = _lay_self(i, state, scene.terms, to.own)
    counts_within = farthest_range(i, rules.interaction_ranges, state)
    found, count = neighbours_within(
        scene.grid, me, place, rules.search_radius, counts_within, box, to
    )
    if len(rules.interaction_ranges) > 1:
        count = keep_interacting(i, count, rules.interaction_ranges, state, to)
    if len(scene.twins.follow) > 0:
        count = keep_seen(count, scene.twins, to)
    if state.presses[i]:
        count = 0
    route, lead = state.route[i], others[LEAD]
    for a in range(count):
        lead[a] = route - lead[a]
    for row in range(FIELDS, len(others)):
        for a in range(count):
            others[row, a] = scene.terms.fields[to.rows[a], row - FIELDS]
    me.record[ME_AHEAD] = _nearest_ahead(me, others, count)
    fill_lane(count, others)
    near = to.near[: found if rules.hard_bodies else 0]
    lay_close(me, near, scene.grid, scene.frame, scene.table, state, to.close)
    return me, count


@force_inlined()
def _lay_self(i: int, state: CrowdState, terms: Terms, record: NDArray[np.float64]) -> Decider:
    """The pedestrian; ``record`` is written."""
    x, y, heading, core = state.x[i], state.y[i], state.heading[i], state.core[i]
    record[ME_X], record[ME_Y] = x, y
    record[ME_TARGET_X], record[ME_TARGET_Y] = state.target_x[i], state.target_y[i]
    # Somebody without a route does not want to walk.
    record[ME_PREFERRED] = state.preferred[i] if state.route[i] < np.inf else 0.0
    record[ME_VX], record[ME_VY] = state.vx[i], state.vy[i]
    record[ME_CORE], record[ME_AHEAD] = core, np.inf
    for field in range(terms.fields.shape[1]):
        record[FIELDS + field] = terms.fields[i, field]
    return Decider(i, state.type_index[i], x, y, math.cos(heading), math.sin(heading), core, record)


@internal()
def _nearest_ahead(me: Decider, others: NDArray[np.float64], count: int) -> float:
    """Metres to the nearest of ``count`` others on the side of the target; inf without any."""
    dx, dy = me.record[ME_TARGET_X] - me.x, me.record[ME_TARGET_Y] - me.y
    x, y, away2 = others[OTHER_X], others[OTHER_Y], others[AWAY]
    least = np.inf
    for a in range(count):
        wx, wy = x[a] - me.x, y[a] - me.y
        away2[a] = wx * wx + wy * wy if wx * dx + wy * dy > 0.0 else np.inf
    for a in range(count):
        least = min(least, away2[a])
    return math.sqrt(least)


@force_inlined()
def neighbours_within(
    grid: Grid,
    me: Decider,
    place: int,
    radius: float,
    counts_within: float,
    box: Box,
    to: Neighbours,
) -> tuple[int, int]:
    """Find the people around somebody who decides, 8 at a time.

    Args:
        grid: that of the frame.
        me: who decides.
        place: their index in the grid.
        radius: metres within which people may get in the way.
        counts_within: metres within which they count in cost terms, at most ``radius``.
        box: the places that the pedestrian may reach, in their coordinates.
        to: is written.

    Returns:
        How many there are whose paths may lead into the box, and how many who count; each array
        must have room for everybody and 8 more.
    """
    near, rows, others, table = to.near, to.rows, to.others, grid.table
    cx0, cx1, cy0, cy1 = cells_within(grid, me.x, me.y, radius)
    pose, keep = (me.x, me.y, me.c, me.s), me.core + MARGIN + SLACK
    found, count = 0, 0
    for cy in range(cy0, cy1 + 1):
        last = grid.offsets[cy * grid.nx + cx1 + 1]
        for at in range(grid.offsets[cy * grid.nx + cx0], last, LANES):
            bits = places_near(grid.x, grid.y, at, me.x, me.y, radius)
            bits &= (1 << min(last - at, LANES)) - 1
            if at <= place < at + LANES:
                bits &= ~(1 << (place - at))
            circles = COVERED * table.shape[1] + at
            ahead = bits & sweeps_near(table, circles, table.shape[1], pose, keep, box)
            press_numbers(at, ahead, near, found)
            found += bits_set(ahead)
            bits &= places_near(grid.x, grid.y, at, me.x, me.y, counts_within)
            compress(table, 0, at, bits, others, 0, count, COVERED)
            compress(grid.people, 0, at, bits, rows, 0, count, 1)
            count += bits_set(bits)
    return found, count


@internal()
def keep_interacting(
    i: int, count: int, ranges: NDArray[np.float64], state: CrowdState, to: Neighbours
) -> int:
    """Keep those of the first ``count`` neighbours who count for i, by types; returns how many."""
    kept, rows, others = 0, to.rows, to.others
    for a in range(count):
        j = rows[a]
        rows[kept] = j
        for row in range(COVERED):
            others[row, kept] = others[row, a]
        kept += int(interact(i, j, ranges, state))
    return kept
