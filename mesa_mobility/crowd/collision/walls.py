"""Walls in the coordinates of a pedestrian, and what comes near to them, several at once.

An option whose sample falls within a body's radius of a wall hits it; one whose samples all stay
farther away than it can move between samples does not. Only what is left needs the exact test.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.simd import LANES, SAMPLES, WIDE
from mesa_mobility.compiled.twins import with_twin
from mesa_mobility.compiled.vectors import (
    DOUBLE,
    FLOAT,
    INT,
    LONG,
    Start,
    across,
    bits_of,
    less_of,
    load,
    load_one,
    load_three,
    more_of,
    same,
    spread,
    start_of,
    store,
    whole,
    wholes,
)
from mesa_mobility.crowd.collision.sampled import Decider

BARRIER_FIELDS = 5
"""Rows of barriers: x and y of one end, x and y from there to the other, the inverse square of its
length."""


class Barriers(NamedTuple):
    """Walls in a pedestrian's coordinates: ``at`` (5, n), of which the first ``known`` count."""

    at: NDArray[np.float32]
    known: int


NOTHING, ALL = np.float32(0.0), np.float32(1.0)


@internal()
def walls_to_ego(
    me: Decider,
    walls: NDArray[np.float64],
    farthest: float,
    radius: float,
    to: NDArray[np.float32],
) -> int:
    """Write walls in the pedestrian's coordinates, except walls that their body touches already.

    Of each wall only the part that matters is kept, so that single precision suffices.

    Args:
        me: the pedestrian.
        walls: (w, 5) walls within reach, with squared distances.
        farthest: reach of the pedestrian's options, metres.
        radius: distance to a wall at which a body touches it, metres.
        to: (5, n) is written.

    Returns:
        Their number.
    """
    count = 0
    most = 2.0 * farthest + 1.0
    for w in range(len(walls)):
        if walls[w, 4] <= radius * radius:
            continue
        dx, dy = walls[w, 0] - me.x, walls[w, 1] - me.y
        ax, ay = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        dx, dy = walls[w, 2] - walls[w, 0], walls[w, 3] - walls[w, 1]
        ex, ey = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        length2 = ex * ex + ey * ey
        if length2 > 0.0:
            here, share = -(ax * ex + ay * ey) / length2, most / math.sqrt(length2)
            first, last = max(here - share, 0.0), min(here + share, 1.0)
            ax, ay = ax + first * ex, ay + first * ey
            ex, ey = (last - first) * ex, (last - first) * ey
            length2 = ex * ex + ey * ey
        to[0, count], to[1, count], to[2, count], to[3, count] = ax, ay, ex, ey
        to[4, count] = 1.0 / length2 if length2 > 0.0 else 0.0
        count += 1
    return count


@force_inlined()
def _off2(x: float, y: float, barriers: np.flatiter, size: int, at: int) -> float:
    """Squared distance of a place from a barrier."""
    ax, ay = barriers[at], barriers[at + size]
    ex, ey = barriers[at + 2 * size], barriers[at + 3 * size]
    qx, qy = x - ax, y - ay
    along = (qx * ex + qy * ey) * barriers[at + 4 * size]
    along = along if along > NOTHING else NOTHING
    along = along if along < ALL else ALL
    qx, qy = qx - along * ex, qy - along * ey
    return qx * qx + qy * qy


def _least_off2(
    builder: Any, x: Any, y: Any, barriers: Start, first: Any, size: Any, known: Any
) -> Any:
    """Squared distances of places from the nearest of ``known`` barriers from one on."""
    width = x.type.count
    add, sub, mul = builder.fadd, builder.fsub, builder.fmul
    least = cgutils.alloca_once_value(builder, same(FLOAT, width, math.inf))
    with cgutils.for_range(builder, known) as loop:
        at = builder.add(first, loop.index)
        fields = []
        for _ in range(BARRIER_FIELDS):
            fields.append(spread(builder, load_one(builder, barriers, at), width))
            at = builder.add(at, size)
        ax, ay, ex, ey, inverse = fields
        qx, qy = sub(x, ax), sub(y, ay)
        along = mul(add(mul(qx, ex), mul(qy, ey)), inverse)
        along = more_of(builder, along, same(FLOAT, width, 0.0))
        along = less_of(builder, along, same(FLOAT, width, 1.0))
        qx, qy = sub(qx, mul(along, ex)), sub(qy, mul(along, ey))
        off2 = add(mul(qx, qx), mul(qy, qy))
        builder.store(less_of(builder, off2, builder.load(least)), least)
    return builder.load(least)


def _plain_drop_beside(
    circles: NDArray[np.float32],
    which: tuple[int, int, int],
    barriers: NDArray[np.float32],
    there: tuple[int, int, int],
    apart: float,
    dropped: NDArray[np.int32],
) -> None:
    at, row, n = which
    first, size, known = there
    of, barrier = circles.flat, barriers.flat
    keep = np.float32(apart)
    for k in range(n):
        x, y = of[at + k], of[at + row + k]
        room = keep - of[at + 2 * row + k]
        room = room if room > NOTHING else NOTHING
        found = dropped[k] != 0
        for b in range(first, first + known):
            found |= _off2(x, y, barrier, size, b) < room * room
        dropped[k] = found


@with_twin(_plain_drop_beside)
def drop_beside(typingctx, circles, which, barriers, there, apart, dropped):
    """Set ``dropped`` of those of n circles that lie wholly within ``apart`` of a barrier.

    Args:
        circles: C-contiguous.
        which: ``(at, row, n)``: x of the first circle at place ``at``, its y ``row`` places and its
            radius twice as many farther on; how many circles.
        barriers: C-contiguous.
        there: ``(first, size, known)``: the first field of the first barrier at place ``first``,
            each of the others ``size`` places farther on; how many barriers.
        apart: metres.
        dropped: by circle.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        barriers = start_of(context, builder, sig.args[2], args[2])
        marks = start_of(context, builder, sig.args[5], args[5])
        at, row, n = wholes(context, builder, sig.args[1], args[1])
        of = wholes(context, builder, sig.args[3], args[3])
        keep = spread(builder, builder.fptrunc(args[4], FLOAT), WIDE)
        wide = ir.Constant(LONG, WIDE)
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            off2 = _least_off2(builder, x, y, barriers, *of)
            room = more_of(builder, builder.fsub(keep, radius), same(FLOAT, WIDE, 0.0))
            within = builder.fcmp_ordered("<", off2, builder.fmul(room, room))
            before = load(builder, marks, block, WIDE)
            found = builder.or_(builder.icmp_signed("!=", before, same(INT, WIDE, 0)), within)
            store(builder, builder.zext(found, ir.VectorType(INT, WIDE)), marks, block)
        return context.get_dummy_value()

    return types.void(circles, which, barriers, there, types.float64, dropped), codegen


def _plain_places_beside(
    places: NDArray[np.float32],
    at: int,
    row: int,
    barriers: NDArray[np.float32],
    first: int,
    size: int,
    known: int,
    apart: float,
) -> int:
    of, barrier = places.flat, barriers.flat
    most = np.float32(apart) * np.float32(apart)
    bits = 0
    for lane in range(LANES):
        x, y = of[at + lane], of[at + row + lane]
        within = False
        for b in range(first, first + known):
            within |= _off2(x, y, barrier, size, b) < most
        bits |= int(within) << lane
    return bits


@with_twin(_plain_places_beside)
def places_beside(typingctx, places, at, row, barriers, first, size, known, apart):
    """Bits of those of 8 places closer than ``apart`` to a barrier.

    ``places`` C-contiguous: x of the first at place ``at``, its y ``row`` places farther on;
    ``first``, ``size`` and ``known`` as of ``drop_beside``.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        barriers = start_of(context, builder, sig.args[3], args[3])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        of = [whole(context, builder, sig.args[k], args[k]) for k in (4, 5, 6)]
        x = load(builder, begin, at, LANES)
        y = load(builder, begin, builder.add(at, row), LANES)
        keep = spread(builder, builder.fptrunc(args[7], FLOAT), LANES)
        off2 = _least_off2(builder, x, y, barriers, *of)
        return bits_of(builder, builder.fcmp_ordered("<", off2, builder.fmul(keep, keep)))

    given = [places, at, row, barriers, first, size, known, types.float64]
    return types.int64(*given), codegen


def _plain_path_off2(
    paths: NDArray[np.float32], path: int, barriers: NDArray[np.float32], known: int
) -> float:
    barrier, size = barriers.flat, barriers.shape[1]
    least = np.float32(np.inf)
    for b in range(known):
        for k in range(SAMPLES):
            off2 = _off2(paths[path, 0, k], paths[path, 1, k], barrier, size, b)
            least = off2 if off2 < least else least
    return float(least)


@with_twin(_plain_path_off2)
def path_off2(typingctx, paths, path, barriers, known):
    """Least squared distance of the samples of a path from any of the barriers, inf without any.

    ``paths`` (n, 3, 16): x, y and something else at the samples; ``path`` which one; ``barriers``
    (5, size) C-contiguous, of which the first ``known`` count.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        held = cgutils.create_struct_proxy(sig.args[2])(context, builder, args[2])
        size = builder.extract_value(held.shape, 1)
        path = whole(context, builder, sig.args[1], args[1])
        known = whole(context, builder, sig.args[3], args[3])
        start = builder.mul(path, ir.Constant(LONG, 3 * SAMPLES))
        x = load(builder, begin, start, SAMPLES)
        y = load(builder, begin, builder.add(start, ir.Constant(LONG, SAMPLES)), SAMPLES)
        first = start_of(context, builder, sig.args[2], args[2])
        least = _least_off2(builder, x, y, first, ir.Constant(LONG, 0), size, known)
        return builder.fpext(across(builder, least, less_of), DOUBLE)

    return types.float64(paths, path, barriers, known), codegen
