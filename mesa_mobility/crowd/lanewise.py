"""What the choice does for several options, groups or people at once.

Arrays are given whole, with the place where a row of theirs starts: to take a part of one
takes as long as to look at 16 of its numbers.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mesa_mobility.crowd.options import LEVELS
from mesa_mobility.lanes import (
    BIT,
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
    more_of,
    plus,
    same,
    some_lanes,
    spread,
    start_of,
    store,
    times,
    whole,
)


def _away2(builder: Any, x: Any, y: Any, bodies: Any, at: Any, row: Any) -> Any:
    """Squared distances of places from a body, and the distance to keep from it."""
    width = x.type.count
    of = [
        spread(builder, builder.load(builder.gep(bodies, [builder.add(at, k)])), width)
        for k in (ir.Constant(LONG, 0), row, builder.add(row, row))
    ]
    dx, dy = builder.fsub(x, of[0]), builder.fsub(y, of[1])
    return plus(builder, times(builder, dx, dx), times(builder, dy, dy)), of[2]


@intrinsic
def drop_within(typingctx, circles, at, row, n, bodies, first, size, known, dropped):
    """Set ``dropped`` of those of n circles that lie wholly within a body.

    Args:
        circles: float32, C-contiguous: x of the first circle at place ``at``, its y ``row`` places
            and its radius twice as many farther on. Read are whole vectors.
        bodies: float32, C-contiguous: x of the first body at place ``first``, its y ``size``
            places and its distance to keep twice as many farther on.
        known: number of bodies.
        dropped: int32 by circle.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        bodies_begin = start_of(context, builder, sig.args[4], args[4])
        marks = start_of(context, builder, sig.args[8], args[8])
        at, row, n = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2, 3))
        first, size, known = (whole(context, builder, sig.args[k], args[k]) for k in (5, 6, 7))
        wide = ir.Constant(LONG, WIDE)
        none = same(FLOAT, WIDE, 0.0)
        found = cgutils.alloca_once(builder, ir.VectorType(BIT, WIDE))
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            before = load(builder, marks, block, WIDE)
            builder.store(builder.icmp_signed("!=", before, same(INT, WIDE, 0)), found)
            with cgutils.for_range(builder, known) as loop:
                body = builder.add(first, loop.index)
                away2, apart = _away2(builder, x, y, bodies_begin, body, size)
                room = builder.fsub(apart, radius)
                room = more_of(builder, room, none)
                within = builder.fcmp_ordered("<", away2, builder.fmul(room, room))
                builder.store(builder.or_(builder.load(found), within), found)
            store(
                builder, builder.zext(builder.load(found), ir.VectorType(INT, WIDE)), marks, block
            )
        return context.get_dummy_value()

    return types.void(circles, at, row, n, bodies, first, size, known, dropped), codegen


@intrinsic
def places_within(typingctx, places, at, row, bodies, first, size, known):
    """Bits of those of 8 places that are within a body; arguments as of ``drop_within``."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        bodies_begin = start_of(context, builder, sig.args[3], args[3])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        first, size, known = (whole(context, builder, sig.args[k], args[k]) for k in (4, 5, 6))
        x = load(builder, begin, at, LANES)
        y = load(builder, begin, builder.add(at, row), LANES)
        found = cgutils.alloca_once(builder, ir.VectorType(BIT, LANES))
        builder.store(same(BIT, LANES, 0), found)
        with cgutils.for_range(builder, known) as loop:
            body = builder.add(first, loop.index)
            away2, apart = _away2(builder, x, y, bodies_begin, body, size)
            within = builder.fcmp_ordered("<", away2, builder.fmul(apart, apart))
            builder.store(builder.or_(builder.load(found), within), found)
        return builder.zext(builder.bitcast(builder.load(found), ir.IntType(LANES)), LONG)

    return types.int64(places, at, row, bodies, first, size, known), codegen


@intrinsic
def places_near(typingctx, x, y, at, px, py, radius):
    """Bits of those of 8 places from ``at`` on that are within ``radius`` of (px, py).

    ``x`` and ``y`` are float64. Nothing is rounded otherwise than for one place.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        at = whole(context, builder, sig.args[2], args[2])
        away2 = []
        for k in range(2):
            begin = start_of(context, builder, sig.args[k], args[k])
            away = builder.fsub(
                load(builder, begin, at, LANES), spread(builder, args[3 + k], LANES)
            )
            away2.append(builder.fmul(away, away))
        most = spread(builder, builder.fmul(args[5], args[5]), LANES)
        near = builder.fcmp_ordered("<=", builder.fadd(*away2), most)
        return builder.zext(builder.bitcast(near, ir.IntType(LANES)), LONG)

    return types.int64(x, y, at, *[types.float64] * 3), codegen


@intrinsic
def numbers_between(typingctx, values, at, above, up_to):
    """Bits of those of 8 float64 from place ``at`` on that are more than a number up to another."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        value = load(builder, begin, whole(context, builder, sig.args[1], args[1]), LANES)
        more = builder.fcmp_ordered(">", value, spread(builder, args[2], LANES))
        little = builder.fcmp_ordered("<=", value, spread(builder, args[3], LANES))
        bits = builder.bitcast(builder.and_(more, little), ir.IntType(LANES))
        return builder.zext(bits, LONG)

    return types.int64(values, at, types.float64, types.float64), codegen


@intrinsic
def near_box(typingctx, circles, at, row, x0, y0, x1, y1):
    """Bits of those of 16 circles that reach into a box; arguments as of ``drop_within``."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        box = [context.cast(builder, args[k], sig.args[k], types.float32) for k in (3, 4, 5, 6)]
        x0, y0, x1, y1 = (spread(builder, number, WIDE) for number in box)
        x, y, radius = load_three(builder, begin, at, row, WIDE)
        off = None
        for place, low, high in ((x, x0, x1), (y, y0, y1)):
            away = same(FLOAT, WIDE, 0.0)
            for gap in (builder.fsub(low, place), builder.fsub(place, high)):
                away = more_of(builder, gap, away)
            squared = builder.fmul(away, away)
            off = squared if off is None else builder.fadd(off, squared)
        near = builder.fcmp_ordered("<", off, builder.fmul(radius, radius))
        return builder.zext(builder.bitcast(near, ir.IntType(WIDE)), LONG)

    return types.int64(circles, at, row, x0, y0, x1, y1), codegen


@intrinsic
def extent(typingctx, circles, at, row, n, dropped):
    """A box around those of n circles that are not dropped: least x and y, greatest x and y.

    Arguments as of ``drop_within``; what fills up the last vector must be dropped. If all are, it
    is empty: the least are inf, the greatest -inf.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        marks = start_of(context, builder, sig.args[4], args[4])
        at, row, n = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2, 3))
        ends = [
            (less_of, math.inf),
            (less_of, math.inf),
            (more_of, -math.inf),
            (more_of, -math.inf),
        ]
        found = [cgutils.alloca_once(builder, ir.VectorType(FLOAT, WIDE)) for _ in ends]
        for (_, none), end in zip(ends, found, strict=True):
            builder.store(same(FLOAT, WIDE, none), end)
        wide = ir.Constant(LONG, WIDE)
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            kept = builder.icmp_signed("==", load(builder, marks, block, WIDE), same(INT, WIDE, 0))
            reached = [
                change(middle, radius)
                for change in (builder.fsub, builder.fadd)
                for middle in (x, y)
            ]
            for (of_two, none), end, value in zip(ends, found, reached, strict=True):
                value = builder.select(kept, value, same(FLOAT, WIDE, none))
                builder.store(of_two(builder, value, builder.load(end)), end)
        box = [
            builder.fpext(across(builder, builder.load(end), of_two), DOUBLE)
            for (of_two, _), end in zip(ends, found, strict=True)
        ]
        return context.make_tuple(builder, sig.return_type, box)

    return types.UniTuple(types.float64, 4)(circles, at, row, n, dropped), codegen


@intrinsic
def levels_within(typingctx, ahead, at, row, spans, apart):
    """Bits of the levels at which somebody is less than ``apart`` from a box.

    ``ahead`` float32, C-contiguous: x at the 16 samples from place ``at`` on, y ``row`` places
    farther on; ``spans`` (4, levels) float32, C-contiguous: least x and y, greatest x and y of the
    boxes.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        spans = start_of(context, builder, sig.args[3], args[3])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        width = len(LEVELS)
        apart = spread(builder, builder.fptrunc(args[4], FLOAT), width)
        off2 = []
        for k in range(2):
            samples = load(builder, begin, builder.add(at, row) if k else at, SAMPLES)
            place = some_lanes(builder, samples, LEVELS)
            low, high = (
                load(builder, spans, ir.Constant(LONG, width * end), width) for end in (k, k + 2)
            )
            off = more_of(builder, builder.fsub(low, place), builder.fsub(place, high))
            off = more_of(builder, off, same(FLOAT, width, 0.0))
            off2.append(builder.fmul(off, off))
        near = builder.fcmp_ordered("<", builder.fadd(*off2), builder.fmul(apart, apart))
        return builder.zext(builder.bitcast(near, ir.IntType(width)), LONG)

    return types.int64(ahead, at, row, spans, types.float64), codegen
