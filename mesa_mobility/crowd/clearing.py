"""Options that are certainly blocked are dropped unseen, whole groups of them at first.

Looked at are a few times ahead. Where the circle around a group lies within a wall or
somebody's body at one of them, the exact test would drop each of its options as well;
and so it would any option that is within somebody at one of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.barriers import drop_beside, places_beside
from mesa_mobility.crowd.close import SLACK, Close, Stance, lay_ahead, off_box2
from mesa_mobility.crowd.collision import MARGIN
from mesa_mobility.crowd.groups import AT_X, AT_Y, LANE_FIELDS, OptionGroups
from mesa_mobility.crowd.lanewise import drop_within, places_within
from mesa_mobility.crowd.options import LEVELS, OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean, part
from mesa_mobility.lanes import LANES, WIDE
from mesa_mobility.machine import fetch

ALL_LANES = 2**LANES - 1
"""Bits of all options of a group."""

_AHEAD = 4
"""People whose paths are fetched before they are needed."""

_STEPS = 2.0**16
"""Steps in a metre that extents are rounded to."""


class Bodies(NamedTuple):
    """Who is where at the levels, in the frame of a pedestrian.

    ``known`` (levels,) how many people; ``at`` (levels, 3, n) x, y and the distance to keep,
    metres.
    """

    known: NDArray[np.int64]
    at: NDArray[np.float32]


class Circles(NamedTuple):
    """Circles to work with: ``of`` (3, n) x, y and radius, metres; ``dropped`` (n,) which are."""

    of: NDArray[np.float32]
    dropped: NDArray[np.int32]


@lean()
def extent(
    x: NDArray[np.float32], y: NDArray[np.float32], radius: NDArray[np.float32]
) -> tuple[float, float, float, float]:
    """A box around circles: x and y that none falls below and that none exceeds.

    Rounded outwards to whole steps: the least of whole numbers is found for several at once, that
    of floats one by one.
    """
    x0 = y0 = np.int32(2**31 - 1)
    x1 = y1 = np.int32(-(2**31))
    scale = np.float32(_STEPS)
    for b in range(len(x)):
        r = radius[b]
        x0, x1 = min(x0, np.int32((x[b] - r) * scale)), max(x1, np.int32((x[b] + r) * scale))
        y0, y1 = min(y0, np.int32((y[b] - r) * scale)), max(y1, np.int32((y[b] + r) * scale))
    # One more step, as conversion rounds towards 0.
    one = 1.0 / _STEPS
    return x0 * one - one, y0 * one - one, x1 * one + one, y1 * one + one


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
    circles: Circles,
    alive: NDArray[np.int64],
) -> int:
    """Find the groups that are not certainly blocked, and the bodies that matter to them.

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
        circles: space to work in; its ``dropped`` is written.
        alive: gets the groups.

    Returns:
        The number of groups; ``circles.dropped`` tells of each of the cluster which they are not.
    """
    spanned = groups.clusters[state.cluster[me.row]]
    first, last = spanned.first, spanned.last
    n = last - first
    bodies.known[:] = 0
    dropped = circles.dropped
    dropped[: n + WIDE] = 0
    levels = 0
    while levels < len(LEVELS) and spanned.reach[levels] < exits_from:
        levels += 1
    for a in range(count if levels > 0 else 0):
        if a + _AHEAD < count:
            fetch(table.path, max(state.option[close.people[a + _AHEAD].who], 0), 192)
        lay_ahead(a, me, frame, table, state, close)
        somebody = close.people[a]
        apart = np.float32(somebody.apart - SLACK)
        for level in range(levels):
            px, py = close.ahead[a, 0, LEVELS[level]], close.ahead[a, 1, LEVELS[level]]
            span = spanned.spans[level]
            if off_box2(px, py, span[0], span[1], span[2], span[3]) < apart * apart:
                met = bodies.known[level]
                bodies.at[level, 0, met], bodies.at[level, 1, met] = px, py
                bodies.at[level, 2, met] = apart
                bodies.known[level] = met + 1
    for level in range(levels):
        if bodies.known[level] > 0:
            drop_within(
                groups.at, 3 * level * groups.at.shape[2] + first, groups.at.shape[2], n,
                bodies.at, 3 * level * bodies.at.shape[2], bodies.at.shape[2],
                bodies.known[level], dropped,
            )  # fmt: skip
        if firm > 0:
            drop_beside(
                groups.at, 3 * level * groups.at.shape[2] + first, groups.at.shape[2], n, barriers,
                firm, me.core + MARGIN - SLACK, dropped,
            )  # fmt: skip
    free = 0
    for a in range(n):
        alive[free] = first + a
        free += 1 - dropped[a]
    if 0 < free < n:
        for level in range(len(LEVELS)):
            if bodies.known[level] > 0:
                x, y, radius = _circles_of(groups, level, alive[:free], circles)
                x0, y0, x1, y1 = extent(x, y, radius)
                _keep_bodies(x0, y0, x1, y1, level, bodies)
    return free


@lean()
def _circles_of(
    groups: OptionGroups, level: int, alive: NDArray[np.int64], circles: Circles
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """The circles at a level of the groups in ``alive``."""
    x, y, radius = groups.at[level, 0], groups.at[level, 1], groups.at[level, 2]
    n = len(alive)
    for a in range(n):
        g = alive[a]
        circles.of[0, a], circles.of[1, a], circles.of[2, a] = x[g], y[g], radius[g]
    return circles.of[0, :n], circles.of[1, :n], circles.of[2, :n]


@lean()
def _keep_bodies(x0: float, y0: float, x1: float, y1: float, level: int, bodies: Bodies) -> None:
    """Forget the bodies at a level that no option within a box meets."""
    kept = 0
    x, y, apart = bodies.at[level, 0], bodies.at[level, 1], bodies.at[level, 2]
    for m in range(bodies.known[level]):
        if off_box2(x[m], y[m], x0, y0, x1, y1) < apart[m] * apart[m]:
            x[kept], y[kept], apart[kept] = x[m], y[m], apart[m]
            kept += 1
    bodies.known[level] = kept


@lean()
def free_lanes(
    group: int,
    wanted: int,
    bodies: Bodies,
    barriers: NDArray[np.float32],
    firm: int,
    apart: float,
    groups: OptionGroups,
) -> int:
    """Bits of the ``wanted`` of a group's 8 options that are within nobody and no wall.

    That is at the levels, closer than ``apart`` to the first ``firm`` barriers.
    """
    # Lanes that are no options do not count.
    free = wanted & ((1 << (groups.first[group + 1] - groups.first[group])) - 1)
    start = group * LANE_FIELDS * LANES
    size = bodies.at.shape[2]
    row = (AT_Y - AT_X) * LANES
    for level in range(len(LEVELS)):
        at = start + (AT_X + level) * LANES
        if firm > 0 and free != 0:
            free &= ~places_beside(groups.lanes, at, row, barriers, firm, apart)
        if bodies.known[level] > 0 and free != 0:
            free &= ~places_within(
                groups.lanes, at, row, bodies.at, 3 * level * size, size, bodies.known[level]
            )
    return free
