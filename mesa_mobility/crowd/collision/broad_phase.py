"""Broad phase: option groups, then options, that are certainly blocked are dropped.

It tests a few times ahead, the levels. If the circle around a group lies within a wall or a body
at one of them, the exact test would drop each of its options. The same holds for a single option
that lies within a body at a level.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, WIDE
from mesa_mobility.crowd.collision.sampled import SLACK, Close, Decider
from mesa_mobility.crowd.collision.simd_boxes import extent, levels_within, off_box2
from mesa_mobility.crowd.collision.simd_tests import drop_within, places_within
from mesa_mobility.crowd.collision.walls import (
    BARRIER_FIELDS,
    Barriers,
    drop_beside,
    places_beside,
)
from mesa_mobility.crowd.options.option_groups import AT_X, AT_Y, LANE_FIELDS, OptionGroups
from mesa_mobility.crowd.options.table import LEVELS, SAMPLES
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import Box
from mesa_mobility.crowd.state.records import CrowdState

ALL_LANES = 2**LANES - 1
"""Bits of all options of a group."""


class Bodies(NamedTuple):
    """Who of the people close may be hit at the levels.

    ``known`` (levels,) their number; ``at`` (levels, n) for each the place of x in ``Close.ahead``.
    """

    known: NDArray[np.int64]
    at: NDArray[np.int64]


class Fences(NamedTuple):
    """Walls that options may reach at the levels, in a pedestrian's coordinates.

    ``known`` (levels,) number of walls; ``at`` (levels, 5, n) fields as of barriers.
    """

    known: NDArray[np.int64]
    at: NDArray[np.float32]


class Blocks(NamedTuple):
    """What blocks the groups of a cluster.

    ``bodies`` and ``fences`` at the levels; ``dropped`` (groups and padding,) 1 for groups that are
    certainly blocked.
    """

    bodies: Bodies
    fences: Fences
    dropped: NDArray[np.int32]


@force_inlined()
def cull_groups(
    me: Decider,
    close: Close,
    barriers: Barriers,
    exits_from: float,
    groups: OptionGroups,
    state: CrowdState,
    to: Blocks,
) -> int:
    """Find groups that are not certainly blocked, and the bodies and walls that matter to them.

    Args:
        me: the pedestrian.
        close: people who may come in the way.
        barriers: walls within reach that do not touch the body.
        exits_from: metres to the nearest open exit.  Levels by which options may reach it are not
            tested: the pedestrian may have left.
        groups: options of all capabilities in groups, with the extent of each.
        state: the crowd.
        to: is written.

    Returns:
        The number of groups that are not certainly blocked.
    """
    bodies, fences, dropped = to.bodies, to.fences, to.dropped
    count = close.known[0]
    spanned = groups.clusters[state.cluster[me.row]]
    first, last = spanned.first, spanned.last
    n = last - first
    bodies.known[:] = 0
    fences.known[:] = 0
    dropped[:n] = 0
    # Padding of the last batch.
    dropped[n : n + WIDE] = 1
    levels = 0
    while levels < len(LEVELS) and spanned.reach[levels] < exits_from:
        levels += 1
    within = (1 << levels) - 1
    for a in range(count if levels > 0 else 0):
        at = 3 * SAMPLES * a
        bits = within & levels_within(close.ahead, at, SAMPLES, spanned.spans)
        # Without branches, which could not be predicted.
        for level in range(len(LEVELS)):
            met = bodies.known[level]
            bodies.at[level, met] = at + LEVELS[level]
            bodies.known[level] = met + (bits >> level & 1)
    circles, row, size, far = groups.at, groups.at.shape[2], bodies.at.shape[1], fences.at.shape[2]
    keep = me.core + MARGIN - SLACK
    for level in range(levels):
        which = 3 * level * row + first, row, n
        if bodies.known[level] > 0:
            there = level * size, bodies.known[level]
            drop_within(circles, which, close.ahead, bodies.at, there, dropped)
        if barriers.known > 0:
            span = spanned.spans
            spans = span[0, level], span[1, level], span[2, level], span[3, level]
            _keep_fences(spans, keep, barriers.at, barriers.known, level, fences)
            known = BARRIER_FIELDS * level * far, far, fences.known[level]
            drop_beside(circles, which, fences.at, known, keep, dropped)
    free = n
    for a in range(n):
        free -= dropped[a]
    if 0 < free < n:
        for level in range(levels):
            walls = fences.known[level]
            if bodies.known[level] + walls > 0:
                box = extent(circles, 3 * level * row + first, row, n, dropped)
                _keep_bodies(box, level, close.ahead, bodies)
                _keep_fences(box, keep, fences.at[level], walls, level, fences)
    return free


@internal()
def _keep_bodies(box: Box, level: int, ahead: NDArray[np.float32], bodies: Bodies) -> None:
    """Drop the bodies at a level that no option within a box can hit."""
    kept, at, of = 0, bodies.at[level], ahead.flat
    for m in range(bodies.known[level]):
        x, y, apart = of[at[m]], of[at[m] + SAMPLES], of[at[m] + 2 * SAMPLES]
        at[kept] = at[m]
        kept += int(off_box2(x, y, box) < apart * apart)
    bodies.known[level] = kept


@internal()
def _keep_fences(
    box: Box,
    apart: float,
    barriers: NDArray[np.float32],
    count: int,
    level: int,
    fences: Fences,
) -> None:
    """Keep at a level those of the first ``count`` barriers that may be near a box.

    ``barriers`` (5, n) may be the arrays of the level itself.
    """
    x0, y0, x1, y1 = box
    kept = 0
    to = fences.at[level]
    for w in range(count):
        ax, ay, ex, ey = barriers[0, w], barriers[1, w], barriers[2, w], barriers[3, w]
        inverse = barriers[4, w]
        off_x = max(x0 - max(ax, ax + ex), min(ax, ax + ex) - x1, 0.0)
        off_y = max(y0 - max(ay, ay + ey), min(ay, ay + ey) - y1, 0.0)
        to[0, kept], to[1, kept], to[2, kept], to[3, kept] = ax, ay, ex, ey
        to[4, kept] = inverse
        kept += int(off_x * off_x + off_y * off_y < apart * apart)
    fences.known[level] = kept


@internal()
def free_options(
    group: int, wanted: int, close: Close, blocks: Blocks, apart: float, groups: OptionGroups
) -> int:
    """Bits of the ``wanted`` ones of a group's 8 options that are free at all levels.

    A free option is within no body, and no closer than ``apart`` to a wall.
    """
    bodies, fences = blocks.bodies, blocks.fences
    # Lanes without an option do not count.
    free = wanted & ((1 << (groups.first[group + 1] - groups.first[group])) - 1)
    start = group * LANE_FIELDS * LANES
    size, far = bodies.at.shape[1], fences.at.shape[2]
    row = (AT_Y - AT_X) * LANES
    for level in range(len(LEVELS)):
        at = start + (AT_X + level) * LANES
        if fences.known[level] > 0 and free != 0:
            first, known = BARRIER_FIELDS * level * far, fences.known[level]
            free &= ~places_beside(groups.lanes, at, row, fences.at, first, far, known, apart)
        if bodies.known[level] > 0 and free != 0:
            there = level * size, bodies.known[level]
            free &= ~places_within(groups.lanes, at, row, close.ahead, bodies.at, there)
    return free
