"""Groups of similar options, each with bounds that hold for all of its options.

A cluster is a set of similar poses of a mobility map, and it has some 600 options: movements that
begin in one of these poses. They are put in groups of up to 8 with the same duration, similar ends
and similar paths. A lower bound of the cost of all 8, and a circle around their positions at some
times, mostly suffice to drop a group without testing its options. ``LEVELS`` has the numbers of
the samples of a path at these times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.compiled.simd import LANES, WIDE
from mesa_mobility.crowd.options.table import (
    FRAME_SECONDS,
    LEVELS,
    SAMPLES,
    OptionTable,
    Parts,
    in_blocks,
    in_lines,
    sampled,
    squared,
)
from mesa_mobility.mobility import MobilityMap

GROUP_SIZE = LANES
"""Most options in a group."""

_VELOCITY_S = 6.0
_TURN_M = 2.0
"""Metres that a m/s and a radian count for when options are compared.

About what the terms of a preset weigh that follow the mean velocity of an option and its facing.
The times of decisions hardly depend on these numbers (decision record 6).
"""

_SLACK = 1e-6
"""Added to the extent of a group for rounding: metres, radians, m/s."""


CLUSTER = np.dtype(
    [
        ("first", "i8"),
        ("last", "i8"),
        ("stay", "i8"),
        ("whole", "f8", (4,)),
        ("reach", "f8", (len(LEVELS),)),
        ("spans", "f4", (4, len(LEVELS))),
    ],
    align=True,
)
"""Bounds of the options of a cluster.

Fields: ``first``, its first group; ``last``, the group after its last one; ``stay``, the group of
the option that turns least among those that cover no ground, or -1; ``whole``, least x and y, and
greatest x and y along all options, metres; ``spans`` (4, levels), the same for the circles of its
groups at each level; ``reach`` (levels,), the farthest that its options have led by then, metres.
"""

X, Y, RADIUS, UX, UY, TURN, DURATION, SLOWEST, FASTEST = range(9)
"""Rows of ``OptionGroups.ends``; of ``OptionGroups.at`` the first three."""


LANE_FIELDS = 5 + 2 * len(LEVELS)
"""Number of fields of an option in ``OptionGroups.lanes``: x, y, unit vector of the heading, and
speed at the end; x at each level; y at each level."""

AT_X, AT_Y = 5, 5 + len(LEVELS)
"""Fields of x and of y at the first level."""


class OptionGroups(NamedTuple):
    """Bounds of the groups of options in an ``OptionTable``, and fields of their options.

    Positions and headings are relative to the person at the start of the option: the person is at
    the origin and faces along x.

    Attributes:
        clusters: (clusters,) records of ``CLUSTER``.
        first: (groups + 1,) row of the first option of each group, then the number of options.
        ends: (9, groups) with the rows ``X`` to ``FASTEST``: x, y and radius of a circle around the
            final positions, metres; unit vector of the middle final heading, and the greatest
            deviation from it, radians; duration, seconds; least and greatest speed, m/s.
        at: (levels, 3, groups + 16) x, y and radius, metres, of a circle around the positions at
            each of the samples ``LEVELS``: at 0.4, 0.8, 1.2 and 1.5 s. The last 16 entries are 0.
        lanes: (groups, 13, 8) for each group the 13 fields (see ``LANE_FIELDS``) of its 8 options,
            laid out for SIMD instructions. A group of fewer than 8 repeats its last option.
    """

    clusters: NDArray[np.void]
    first: NDArray[np.int64]
    ends: NDArray[np.float64]
    at: NDArray[np.float32]
    lanes: NDArray[np.float32]


def alike(mobility_map: MobilityMap, parts: Parts) -> NDArray[np.float64]:
    """(n, 8) features by which options are compared, all in metres.

    They are the mean velocity, the positions at 0.8 s and at 1.2 s, the final heading and the
    speed.
    """
    places = sampled(mobility_map, parts, (SAMPLES - 1, LEVELS[1], LEVELS[2])).astype(np.float64)
    end = places[:, 0]
    velocity = end[:, :2] / (mobility_map.durations[parts.rows] * FRAME_SECONDS)[:, None]
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    on_the_way = places[:, 1:, :2].reshape(len(places), 4)
    return np.column_stack([_VELOCITY_S * velocity, on_the_way, _TURN_M * end[:, 2], speed])


@internal()
def _sort(rows: NDArray[np.int64], value: NDArray[np.float64]) -> None:
    """Sort rows by their value, the lower row first among equals (heap sort).

    NumPy's argsort takes Numba 3 s to compile, a tenth of the first start of the program.
    """
    for size in range(len(rows), 1, -1):
        # First every row is sifted down to build a heap, later the one just moved to the root.
        for root in range(size // 2 - 1 if size == len(rows) else 0, -1, -1):
            row, at = rows[root], root
            while 2 * at + 1 < size:
                child = 2 * at + 1
                if child + 1 < size and _before(rows[child], rows[child + 1], value):
                    child += 1
                if not _before(row, rows[child], value):
                    break
                rows[at] = rows[child]
                at = child
            rows[at] = row
        rows[0], rows[size - 1] = rows[size - 1], rows[0]


@internal()
def _before(a: int, b: int, value: NDArray[np.float64]) -> bool:
    return value[a] < value[b] or (value[a] == value[b] and a < b)


@kept(nogil=True)
def group(
    features: NDArray[np.float64], bounds: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Halve runs of rows along their widest feature down to ``GROUP_SIZE`` rows at most.

    Groups are full as far as possible: fewer than 8 options take as long as 8.

    Args:
        features: (n, f) rows.
        bounds: first row of each run that is never joined to the next, and n.

    Returns:
        The order of the rows, and the start of each group in it.
    """
    order = np.arange(len(features), dtype=np.int64)
    starts = np.empty(len(features), np.int64)
    count = 0
    stack = np.empty((64, 2), np.int64)
    for run in range(len(bounds) - 1):
        stack[0, 0], stack[0, 1] = bounds[run], bounds[run + 1]
        waiting = 1
        while waiting > 0:
            waiting -= 1
            first, last = stack[waiting]
            if last - first <= GROUP_SIZE:
                starts[count] = first
                count += 1
                continue
            widest, column = -1.0, 0
            for f in range(features.shape[1]):
                low, high = np.inf, -np.inf
                for k in range(first, last):
                    value = features[order[k], f]
                    low, high = min(low, value), max(high, value)
                if high - low > widest:
                    widest, column = high - low, f
            _sort(order[first:last], features[:, column])
            halves = ((last - first) // 2 + GROUP_SIZE - 1) // GROUP_SIZE
            middle = first + halves * GROUP_SIZE
            stack[waiting, 0], stack[waiting, 1] = middle, last
            stack[waiting + 1, 0], stack[waiting + 1, 1] = first, middle
            waiting += 2
    return order, starts[:count]


def make_groups(table: OptionTable, boxes: NDArray[np.float32]) -> OptionGroups:
    """Group the options of a table; ``boxes`` (n, 4) are those of the options."""
    starts, clusters = table.groups, table.offsets[:-1]
    ends = _circles(table.path[:, :2, -1], starts)
    heading, speed = table.heading.astype(np.float64), table.options.speed.astype(np.float64)
    low, high = np.minimum.reduceat(heading, starts), np.maximum.reduceat(heading, starts)
    at = [table.path[:, :2, level] for level in LEVELS]
    legs = np.empty((len(table.path), len(LEVELS)))
    for block, x, y in in_blocks(table.path):
        # From one level to the next, as the farthest by then is at least that of before.
        firsts = [0, *(np.array(LEVELS[:-1], dtype=np.int64) + 1)]
        legs[block] = np.maximum.reduceat(squared(x, y), firsts, axis=0).T
    farthest2 = np.maximum.accumulate(np.maximum.reduceat(legs, clusters, axis=0), axis=1)
    circles = np.array([_circles(places, starts) for places in at]).astype(np.float32)
    of = np.searchsorted(starts, table.offsets).astype(np.int64)
    first = of[:-1]
    r = circles[:, 2]
    x0, y0 = (np.minimum.reduceat(circles[:, k] - r, first, axis=1) for k in (0, 1))
    x1, y1 = (np.maximum.reduceat(circles[:, k] + r, first, axis=1) for k in (0, 1))
    spanned = np.empty(len(clusters), CLUSTER)
    spanned["first"], spanned["last"] = of[:-1], of[1:]
    spanned["stay"] = _stays(table)
    spanned["whole"] = np.column_stack(
        [np.minimum.reduceat(boxes[:, :2], clusters), np.maximum.reduceat(boxes[:, 2:], clusters)]
    )
    spanned["spans"] = np.stack([x0.T, y0.T, x1.T, y1.T], axis=1)
    spanned["reach"] = np.sqrt(farthest2)
    alike_ends = [
        ends[0],
        ends[1],
        ends[2] + _SLACK,
        np.cos((low + high) / 2),
        np.sin((low + high) / 2),
        (high - low) / 2 + _SLACK,
        table.options.frames[starts] * FRAME_SECONDS,
        np.minimum.reduceat(speed, starts) - _SLACK,
        np.maximum.reduceat(speed, starts) + _SLACK,
    ]
    return OptionGroups(
        clusters=spanned,
        first=np.append(starts, len(speed)),
        ends=np.array(alike_ends),
        at=np.pad(circles, ((0, 0), (0, 0), (0, WIDE))),
        lanes=_lanes(table),
    )


def _stays(table: OptionTable) -> NDArray[np.int64]:
    """(clusters,) the group with the option that turns least of those that stay, or -1."""
    stay = np.flatnonzero(table.options.speed == 0.0)
    cluster = np.searchsorted(table.offsets, stay, side="right") - 1
    order = np.lexsort((abs(table.heading[stay]), cluster))
    of, at = np.unique(cluster[order], return_index=True)
    found = np.full(len(table.farthest), -1, dtype=np.int64)
    found[of] = np.searchsorted(table.groups, stay[order[at]], side="right") - 1
    return found


def _lanes(table: OptionTable) -> NDArray[np.float32]:
    """(groups, 13, 8) the options of each group, field by field."""
    starts, options = table.groups, table.options
    last = np.append(starts[1:], len(options)) - 1
    rows = np.minimum(starts[:, None] + np.arange(GROUP_SIZE, dtype=np.int64), last[:, None])
    lanes = in_lines((len(starts), LANE_FIELDS, GROUP_SIZE), np.float32)
    for k, field in enumerate(("x", "y", "ux", "uy", "speed")):
        lanes[:, k] = options[field][rows]
    for k, level in enumerate(LEVELS):
        lanes[:, AT_X + k] = table.path[:, 0, level][rows]
        lanes[:, AT_Y + k] = table.path[:, 1, level][rows]
    return lanes


def _circles(
    places: NDArray[np.float32], starts: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Circles around runs of positions: middle of their extent, and distance of the farthest."""
    places = places.astype(np.float64)
    middle = (np.minimum.reduceat(places, starts) + np.maximum.reduceat(places, starts)) / 2
    counts = np.diff(np.append(starts, len(places)))
    away = np.hypot(*(places - np.repeat(middle, counts, axis=0)).T)
    return middle[:, 0], middle[:, 1], np.maximum.reduceat(away, starts)
