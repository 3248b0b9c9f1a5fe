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
from mesa_mobility.compiled.intrinsics import prefetch
from mesa_mobility.compiled.simd import LANES, WIDE
from mesa_mobility.crowd.collision.sampled import SLACK, Close, EgoPose, lay_ahead, off_box2
from mesa_mobility.crowd.collision.simd_boxes import extent, levels_within
from mesa_mobility.crowd.collision.simd_tests import drop_within, places_within
from mesa_mobility.crowd.collision.walls import (
    BARRIER_FIELDS,
    Barriers,
    drop_beside,
    places_beside,
)
from mesa_mobility.crowd.options.option_groups import AT_X, AT_Y, LANE_FIELDS, OptionGroups
from mesa_mobility.crowd.options.table import LEVELS, SAMPLES, OptionTable
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import Box
from mesa_mobility.crowd.state.records import CrowdState

ALL_LANES = 2**LANES - 1
"""Bits of all options of a group."""

_AHEAD = 4
"""People whose paths are prefetched."""


class Bodies(NamedTuple):
    """Bodies at the levels, in a pedestrian's coordinates.

    ``known`` (levels,) number of people; ``at`` (levels, 3, n) x, y and the distance to keep,
    metres.
    """

    known: NDArray[np.int64]
    at: NDArray[np.float32]


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
    me: EgoPose,
    frame: int,
    close: Close,
    barriers: Barriers,
    exits_from: float,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    to: Blocks,
) -> int:
    """Find groups that are not certainly blocked, and the bodies and walls that matter to them.

    Args:
        me: the pedestrian.
        frame: now.
        close: people who may come in the way.
        barriers: walls within reach that do not touch the body.
        exits_from: metres to the nearest open exit.  Levels by which options may reach it are not
            tested: the pedestrian may have left.
        table: options of all capabilities.
        groups: these options in groups, with the extent of each.
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
        if a + _AHEAD < count:
            prefetch(table.path, max(state.option[close.people[a + _AHEAD].who], 0), 192)
        lay_ahead(a, me, frame, table, state, close)
        apart = close.people[a].apart - SLACK
        bits = within & levels_within(close.ahead, 2 * SAMPLES * a, SAMPLES, spanned.spans, apart)
        # Without branches, which could not be predicted.
        for level in range(len(LEVELS)):
            met = bodies.known[level]
            bodies.at[level, 0, met] = close.ahead[a, 0, LEVELS[level]]
            bodies.at[level, 1, met] = close.ahead[a, 1, LEVELS[level]]
            bodies.at[level, 2, met] = apart
            bodies.known[level] = met + (bits >> level & 1)
    circles, row, size, far = groups.at, groups.at.shape[2], bodies.at.shape[2], fences.at.shape[2]
    keep = me.core + MARGIN - SLACK
    for level in range(levels):
        which = 3 * level * row + first, row, n
        if bodies.known[level] > 0:
            there = 3 * level * size, size, bodies.known[level]
            drop_within(circles, which, bodies.at, there, dropped)
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
                _keep_bodies(box, level, bodies)
                _keep_fences(box, keep, fences.at[level], walls, level, fences)
    return free


@internal()
def _keep_bodies(box: Box, level: int, bodies: Bodies) -> None:
    """Drop the bodies at a level that no option within a box can hit."""
    kept = 0
    at = bodies.at[level]
    for m in range(bodies.known[level]):
        x, y, apart = at[0, m], at[1, m], at[2, m]
        at[0, kept], at[1, kept], at[2, kept] = x, y, apart
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
    group: int, wanted: int, blocks: Blocks, apart: float, groups: OptionGroups
) -> int:
    """Bits of the ``wanted`` ones of a group's 8 options that are free at all levels.

    A free option is within no body, and no closer than ``apart`` to a wall.
    """
    bodies, fences = blocks.bodies, blocks.fences
    # Lanes without an option do not count.
    free = wanted & ((1 << (groups.first[group + 1] - groups.first[group])) - 1)
    start = group * LANE_FIELDS * LANES
    size, far = bodies.at.shape[2], fences.at.shape[2]
    row = (AT_Y - AT_X) * LANES
    for level in range(len(LEVELS)):
        at = start + (AT_X + level) * LANES
        if fences.known[level] > 0 and free != 0:
            first, known = BARRIER_FIELDS * level * far, fences.known[level]
            free &= ~places_beside(groups.lanes, at, row, fences.at, first, far, known, apart)
        if bodies.known[level] > 0 and free != 0:
            free &= ~places_within(
                groups.lanes, at, row, bodies.at, 3 * level * size, size, bodies.known[level]
            )
    return free
