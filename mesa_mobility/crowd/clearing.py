"""Options that are certainly blocked are dropped unseen, whole groups of them at first.

Looked at are a few times ahead. Where the circle around a group lies within a wall or
somebody's body at one of them, the exact test would drop each of its options as well;
and so it would any option that is within somebody at one of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.close import SLACK, Close, Stance, off_box2
from mesa_mobility.crowd.collision import MARGIN
from mesa_mobility.crowd.groups import OptionGroups
from mesa_mobility.crowd.options import LEVELS, SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.under_way import position_at
from mesa_mobility.floorplan.kernels import point_segment_distance2
from mesa_mobility.jit import lean

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


@lean()
def compact(rows: NDArray[np.int64], dropped: NDArray[np.int32]) -> int:
    """Move the rows that are not dropped to the front; return their number."""
    kept = 0
    for k in range(len(rows)):
        rows[kept] = rows[k]
        kept += 1 - dropped[k]
    return kept


@lean()
def free_groups(
    me: Stance,
    frame: int,
    close: Close,
    count: int,
    walls: NDArray[np.float64],
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
        walls: (w, 5) walls within reach, with squared distances.
        exits_from: metres to the nearest way out: whoever may be out by then may not meet
            anybody.
        table: options of all capabilities.
        groups: what the groups of options span.
        state: the crowd.
        bodies: is written.
        circles: space to work in.
        alive: gets the groups.

    Returns:
        The number of groups.
    """
    cluster = state.cluster[me.row]
    spanned = groups.clusters[cluster]
    first, last = spanned.first, spanned.last
    n = last - first
    for a in range(n):
        alive[a] = first + a
    bodies.known[:] = 0
    dropped = circles.dropped
    for level in range(len(LEVELS)):
        if n == 0 or spanned.reach[level] >= exits_from:
            break
        x, y, radius = _circles_of(groups, level, first, last, alive[:n], circles)
        if n == last - first:
            span = spanned.spans[level]
            x0, y0, x1, y1 = span[0], span[1], span[2], span[3]
        else:
            x0, y0, x1, y1 = extent(x, y, radius)
        dropped[:n] = 0
        time = frame + LEVELS[level] * SAMPLE_FRAMES
        met = 0
        for a in range(count):
            somebody = close.people[a]
            sweep = somebody.sweep
            if off_box2(somebody.x, somebody.y, x0, y0, x1, y1) >= sweep * sweep:
                continue
            j = somebody.who
            wx, wy = position_at(state, table, j, time)
            dx, dy = wx - me.x, wy - me.y
            px, py = np.float32(me.c * dx + me.s * dy), np.float32(me.c * dy - me.s * dx)
            apart = np.float32(somebody.apart - SLACK)
            if off_box2(px, py, x0, y0, x1, y1) < apart * apart:
                bodies.at[level, 0, met], bodies.at[level, 1, met] = px, py
                bodies.at[level, 2, met] = apart
                met += 1
                for b in range(len(x)):
                    room = max(apart - radius[b], np.float32(0.0))
                    away2 = (x[b] - px) * (x[b] - px) + (y[b] - py) * (y[b] - py)
                    dropped[b] |= np.int32(away2 < room * room)
        bodies.known[level] = met
        _drop_in_walls(me, walls, spanned.around[level], x, y, radius, dropped)
        if dropped[:n].any():
            n = compact(alive[:n], dropped)
    if n < last - first:
        for level in range(len(LEVELS)):
            if n > 0 and bodies.known[level] > 0:
                x, y, radius = _circles_of(groups, level, first, last, alive[:n], circles)
                x0, y0, x1, y1 = extent(x, y, radius)
                _keep_bodies(x0, y0, x1, y1, level, bodies)
    return n


@lean()
def _circles_of(
    groups: OptionGroups,
    level: int,
    first: int,
    last: int,
    alive: NDArray[np.int64],
    circles: Circles,
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """The circles at a level of the groups in ``alive``, from ``first`` to ``last`` if all are."""
    x, y, radius = groups.at[level, 0], groups.at[level, 1], groups.at[level, 2]
    n = len(alive)
    if n == last - first:
        return x[first:last], y[first:last], radius[first:last]
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
def _drop_in_walls(
    me: Stance,
    walls: NDArray[np.float64],
    circle: NDArray[np.float64],
    x: NDArray[np.float32],
    y: NDArray[np.float32],
    radius: NDArray[np.float32],
    dropped: NDArray[np.int32],
) -> None:
    """Mark the groups too near to a wall, but for walls that the person touches already."""
    r = me.core + MARGIN
    least = np.float32(r - SLACK)
    for w in range(len(walls)):
        if walls[w, 4] <= r * r:
            continue
        dx, dy = walls[w, 0] - me.x, walls[w, 1] - me.y
        ax, ay = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        dx, dy = walls[w, 2] - me.x, walls[w, 3] - me.y
        bx, by = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        d2 = point_segment_distance2(circle[0], circle[1], ax, ay, bx, by)
        if d2 >= (circle[2] + r) ** 2:
            continue
        length2 = (bx - ax) ** 2 + (by - ay) ** 2
        scale = np.float32(1.0 / length2 if length2 > 0.0 else 0.0)
        px, py = np.float32(ax), np.float32(ay)
        ex, ey = np.float32(bx - ax), np.float32(by - ay)
        for b in range(len(x)):
            qx, qy = x[b] - px, y[b] - py
            t = min(max((qx * ex + qy * ey) * scale, np.float32(0.0)), np.float32(1.0))
            qx, qy = qx - t * ex, qy - t * ey
            room = max(least - radius[b], np.float32(0.0))
            dropped[b] |= np.int32(qx * qx + qy * qy < room * room)


@lean()
def free_options(
    bodies: Bodies, rows: NDArray[np.int64], table: OptionTable, circles: Circles
) -> int:
    """Move those of the options in ``rows`` to the front that are within nobody at any level.

    ``circles`` is space to work in.  Returns their number.
    """
    n = len(rows)
    for level in range(len(LEVELS)):
        if bodies.known[level] == 0:
            continue
        x, y, dropped = circles.of[0, :n], circles.of[1, :n], circles.dropped[:n]
        for k in range(n):
            option = table.options[rows[k]]
            x[k], y[k] = option.at_x[level], option.at_y[level]
            dropped[k] = 0
        for m in range(bodies.known[level]):
            px, py = bodies.at[level, 0, m], bodies.at[level, 1, m]
            apart2 = bodies.at[level, 2, m] * bodies.at[level, 2, m]
            for k in range(len(x)):
                away2 = (x[k] - px) * (x[k] - px) + (y[k] - py) * (y[k] - py)
                dropped[k] |= np.int32(away2 < apart2)
        n = compact(rows[:n], dropped)
    return n
