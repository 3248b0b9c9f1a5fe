"""Options that are certainly blocked are dropped unseen, whole groups of them at first.

Looked at are a few times ahead. Where the circle around a group lies within a wall or
somebody's body at one of them, the exact test would drop each of its options as well;
and so it would any option that is within somebody at one of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.barriers import BARRIER_FIELDS, drop_beside, places_beside
from mesa_mobility.crowd.close import SLACK, Close, Stance, lay_ahead, off_box2
from mesa_mobility.crowd.collision import MARGIN
from mesa_mobility.crowd.groups import AT_X, AT_Y, LANE_FIELDS, OptionGroups
from mesa_mobility.crowd.lanewise import drop_within, extent, levels_within, places_within
from mesa_mobility.crowd.options import LEVELS, SAMPLES, OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean, part
from mesa_mobility.lanes import LANES, WIDE
from mesa_mobility.machine import fetch

ALL_LANES = 2**LANES - 1
"""Bits of all options of a group."""

_AHEAD = 4
"""People whose paths are fetched before they are needed."""


class Bodies(NamedTuple):
    """Who is where at the levels, in the frame of a pedestrian.

    ``known`` (levels,) how many people; ``at`` (levels, 3, n) x, y and the distance to keep,
    metres.
    """

    known: NDArray[np.int64]
    at: NDArray[np.float32]


class Fences(NamedTuple):
    """Walls that options may reach at the levels, in the frame of a pedestrian.

    ``known`` (levels,) how many; ``at`` (levels, 5, n) as of barriers.
    """

    known: NDArray[np.int64]
    at: NDArray[np.float32]


@part()
def free_groups(
    me: Stance,
    frame: int,
    close: Close,
    count: int,
    barriers: NDArray[np.float32],
    firm: int,
    exits_from: float,
    table: OptionTable,
    groups: OptionGroups,
    state: CrowdState,
    bodies: Bodies,
    fences: Fences,
    dropped: NDArray[np.int32],
) -> int:
    """Find the groups that are not certainly blocked, and the bodies and walls that matter to them.

    Args:
        me: the pedestrian.
        frame: now.
        close: people who may come in the way.
        count: how many.
        barriers: (5, n) walls within reach, in the pedestrian's frame.
        firm: how many.
        exits_from: metres to the nearest way out: whoever may be out by then may not meet
            anybody.
        table: options of all capabilities.
        groups: what the groups of options span.
        state: the crowd.
        bodies: is written.
        fences: is written.
        dropped: is written: which groups of the cluster are certainly blocked.

    Returns:
        The number of groups that are not.
    """
    spanned = groups.clusters[state.cluster[me.row]]
    first, last = spanned.first, spanned.last
    n = last - first
    bodies.known[:] = 0
    fences.known[:] = 0
    dropped[:n] = 0
    # What fills up the last ones that are looked at at once.
    dropped[n : n + WIDE] = 1
    levels = 0
    while levels < len(LEVELS) and spanned.reach[levels] < exits_from:
        levels += 1
    within = (1 << levels) - 1
    for a in range(count if levels > 0 else 0):
        if a + _AHEAD < count:
            fetch(table.path, max(state.option[close.people[a + _AHEAD].who], 0), 192)
        lay_ahead(a, me, frame, table, state, close)
        apart = close.people[a].apart - SLACK
        bits = within & levels_within(close.ahead, 2 * SAMPLES * a, SAMPLES, spanned.spans, apart)
        # No branches: who is where cannot be foreseen.
        for level in range(len(LEVELS)):
            met = bodies.known[level]
            bodies.at[level, 0, met] = close.ahead[a, 0, LEVELS[level]]
            bodies.at[level, 1, met] = close.ahead[a, 1, LEVELS[level]]
            bodies.at[level, 2, met] = apart
            bodies.known[level] = met + (bits >> level & 1)
    circles, row, size, far = groups.at, groups.at.shape[2], bodies.at.shape[2], fences.at.shape[2]
    keep = me.core + MARGIN - SLACK
    for level in range(levels):
        at = 3 * level * row + first
        if bodies.known[level] > 0:
            drop_within(
                circles, at, row, n, bodies.at, 3 * level * size, size, bodies.known[level], dropped
            )
        if firm > 0:
            span = spanned.spans
            _keep_fences(
                span[0, level], span[1, level], span[2, level], span[3, level], keep, barriers,
                firm, level, fences,
            )  # fmt: skip
            drop_beside(
                circles, at, row, n, fences.at, BARRIER_FIELDS * level * far, far,
                fences.known[level], keep, dropped,
            )  # fmt: skip
    free = n
    for a in range(n):
        free -= dropped[a]
    if 0 < free < n:
        for level in range(levels):
            walls = fences.known[level]
            if bodies.known[level] + walls > 0:
                x0, y0, x1, y1 = extent(circles, 3 * level * row + first, row, n, dropped)
                _keep_bodies(x0, y0, x1, y1, level, bodies)
                _keep_fences(x0, y0, x1, y1, keep, fences.at[level], walls, level, fences)
    return free


@lean()
def _keep_bodies(x0: float, y0: float, x1: float, y1: float, level: int, bodies: Bodies) -> None:
    """Forget the bodies at a level that no option within a box meets."""
    kept = 0
    at = bodies.at[level]
    for m in range(bodies.known[level]):
        x, y, apart = at[0, m], at[1, m], at[2, m]
        at[0, kept], at[1, kept], at[2, kept] = x, y, apart
        kept += int(off_box2(x, y, x0, y0, x1, y1) < apart * apart)
    bodies.known[level] = kept


@lean()
def _keep_fences(
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    apart: float,
    barriers: NDArray[np.float32],
    count: int,
    level: int,
    fences: Fences,
) -> None:
    """Keep at a level those of the first ``count`` barriers that may come near a box.

    ``barriers`` (5, n) may be those at the level themselves.
    """
    kept = 0
    to = fences.at[level]
    for w in range(count):
        ax, ay, ex, ey, inverse = (
            barriers[0, w], barriers[1, w], barriers[2, w], barriers[3, w], barriers[4, w]
        )  # fmt: skip
        off_x = max(x0 - max(ax, ax + ex), min(ax, ax + ex) - x1, 0.0)
        off_y = max(y0 - max(ay, ay + ey), min(ay, ay + ey) - y1, 0.0)
        to[0, kept], to[1, kept], to[2, kept], to[3, kept] = ax, ay, ex, ey
        to[4, kept] = inverse
        kept += int(off_x * off_x + off_y * off_y < apart * apart)
    fences.known[level] = kept


@lean()
def free_lanes(
    group: int, wanted: int, bodies: Bodies, fences: Fences, apart: float, groups: OptionGroups
) -> int:
    """Bits of the ``wanted`` of a group's 8 options that are within nobody and no wall.

    That is at the levels, closer than ``apart`` to a wall.
    """
    # Lanes that are no options do not count.
    free = wanted & ((1 << (groups.first[group + 1] - groups.first[group])) - 1)
    start = group * LANE_FIELDS * LANES
    size, far = bodies.at.shape[2], fences.at.shape[2]
    row = (AT_Y - AT_X) * LANES
    for level in range(len(LEVELS)):
        at = start + (AT_X + level) * LANES
        if fences.known[level] > 0 and free != 0:
            free &= ~places_beside(
                groups.lanes, at, row, fences.at, BARRIER_FIELDS * level * far, far,
                fences.known[level], apart,
            )  # fmt: skip
        if bodies.known[level] > 0 and free != 0:
            free &= ~places_within(
                groups.lanes, at, row, bodies.at, 3 * level * size, size, bodies.known[level]
            )
    return free
