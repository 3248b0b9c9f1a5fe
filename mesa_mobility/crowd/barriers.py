"""Walls around a pedestrian in its own frame, and what comes near to them, several at once.

An option whose sample falls within a body's radius of a wall hits it; one whose samples all stay
farther away than it can move between samples does not. Only what is left needs the exact test.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from mesa_mobility.crowd.close import Stance
from mesa_mobility.jit import lean
from mesa_mobility.lanes import (
    DOUBLE,
    FLOAT,
    INT,
    LANES,
    LONG,
    SAMPLES,
    WIDE,
    across,
    less_of,
    load,
    load_three,
    minus,
    more_of,
    plus,
    same,
    spread,
    start_of,
    store,
    times,
    whole,
)

BARRIER_FIELDS = 5
"""Rows of barriers: x and y of one end, x and y from there to the other, the inverse square of its
length."""


@lean()
def lay_barriers(
    me: Stance,
    walls: NDArray[np.float64],
    farthest: float,
    radius: float,
    to: NDArray[np.float32],
) -> int:
    """Write walls in the pedestrian's frame, but for those that it touches already.

    Of each only the part that matters is kept, so that single precision suffices.

    Args:
        me: the pedestrian.
        walls: (w, 5) walls within reach, with squared distances.
        farthest: reach of its options, metres.
        radius: whoever is closer touches, metres.
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


def _off2(builder: Any, x: Any, y: Any, barriers: Any, size: Any, at: Any) -> Any:
    """Squared distances of places from a barrier."""
    width = x.type.count
    ax, ay, ex, ey, inverse = (
        spread(
            builder,
            builder.load(
                builder.gep(barriers, [builder.add(at, builder.mul(size, ir.Constant(LONG, k)))])
            ),
            width,
        )
        for k in range(BARRIER_FIELDS)
    )
    add, sub, mul = (partial(step, builder) for step in (plus, minus, times))
    qx, qy = sub(x, ax), sub(y, ay)
    along = mul(add(mul(qx, ex), mul(qy, ey)), inverse)
    along = more_of(builder, along, same(FLOAT, width, 0.0))
    along = less_of(builder, along, same(FLOAT, width, 1.0))
    qx, qy = sub(qx, mul(along, ex)), sub(qy, mul(along, ey))
    return add(mul(qx, qx), mul(qy, qy))


def _least_off2(builder: Any, x: Any, y: Any, begin: Any, first: Any, size: Any, known: Any) -> Any:
    """Squared distances of places from the nearest of ``known`` barriers from one on."""
    least = cgutils.alloca_once(builder, x.type)
    builder.store(same(FLOAT, x.type.count, math.inf), least)
    with cgutils.for_range(builder, known) as loop:
        off2 = _off2(builder, x, y, begin, size, builder.add(first, loop.index))
        builder.store(less_of(builder, off2, builder.load(least)), least)
    return builder.load(least)


@intrinsic
def drop_beside(typingctx, circles, at, row, n, barriers, first, size, known, apart, dropped):
    """Set ``dropped`` of those of n circles that lie wholly within ``apart`` of a barrier.

    Args:
        circles: float32, C-contiguous: x of the first circle at place ``at``, its y ``row`` places
            and its radius twice as many farther on. Read are whole vectors.
        barriers: float32, C-contiguous: the first field of the first barrier at place ``first``,
            each of the others ``size`` places farther on.
        known: how many barriers.
        apart: metres.
        dropped: int32 by circle.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        barriers_begin = start_of(context, builder, sig.args[4], args[4])
        marks = start_of(context, builder, sig.args[9], args[9])
        at, row, n = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2, 3))
        of = [whole(context, builder, sig.args[k], args[k]) for k in (5, 6, 7)]
        apart = spread(builder, builder.fptrunc(args[8], FLOAT), WIDE)
        wide = ir.Constant(LONG, WIDE)
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            off2 = _least_off2(builder, x, y, barriers_begin, *of)
            room = more_of(builder, builder.fsub(apart, radius), same(FLOAT, WIDE, 0.0))
            within = builder.fcmp_ordered("<", off2, builder.fmul(room, room))
            before = builder.icmp_signed(
                "!=", load(builder, marks, block, WIDE), same(INT, WIDE, 0)
            )
            found = builder.or_(before, within)
            store(builder, builder.zext(found, ir.VectorType(INT, WIDE)), marks, block)
        return context.get_dummy_value()

    given = [circles, at, row, n, barriers, first, size, known, types.float64, dropped]
    return types.void(*given), codegen


@intrinsic
def places_beside(typingctx, places, at, row, barriers, first, size, known, apart):
    """Bits of those of 8 places closer than ``apart`` to a barrier.

    ``places`` float32, C-contiguous: x of the first at place ``at``, its y ``row`` places farther
    on; the others as of ``drop_beside``.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        barriers_begin = start_of(context, builder, sig.args[3], args[3])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        of = [whole(context, builder, sig.args[k], args[k]) for k in (4, 5, 6)]
        x = load(builder, begin, at, LANES)
        y = load(builder, begin, builder.add(at, row), LANES)
        apart = spread(builder, builder.fptrunc(args[7], FLOAT), LANES)
        off2 = _least_off2(builder, x, y, barriers_begin, *of)
        within = builder.fcmp_ordered("<", off2, builder.fmul(apart, apart))
        return builder.zext(builder.bitcast(within, ir.IntType(LANES)), LONG)

    given = [places, at, row, barriers, first, size, known, types.float64]
    return types.int64(*given), codegen


@intrinsic
def path_off2(typingctx, paths, path, barriers, known):
    """Least squared distance of the samples of a path from any of the barriers, inf without any.

    ``paths`` (n, 3, 16) float32, C-contiguous: x, y and something else at the samples; ``path``
    which one; ``barriers`` (5, size) float32, C-contiguous, of which the first ``known`` count.
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
        least = _least_off2(builder, x, y, held.data, ir.Constant(LONG, 0), size, known)
        return builder.fpext(across(builder, least, less_of), DOUBLE)

    return types.float64(paths, path, barriers, known), codegen
