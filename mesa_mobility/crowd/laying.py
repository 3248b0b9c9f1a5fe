"""Options and movements under way laid out where they lead, several numbers at once.

Arrays are given whole, with the place where a row of theirs starts: to take a part of one
takes as long as to look at 16 of its numbers.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mesa_mobility.lanes import (
    DOUBLE,
    FLOAT,
    LANES,
    LONG,
    SAMPLES,
    load,
    numbers,
    same,
    spread,
    start_of,
    store,
    whole,
)


@intrinsic
def lay_lanes(typingctx, lanes, group, ends, at, c, s, px, py, seconds):
    """Write where the 8 options of a group end, in the world, from column ``at`` of ``ends`` on.

    ``lanes`` (groups, fields, 8) float32 with the fields x, y, ux, uy and speed first; ``ends``
    (6, n) gets x, y, ux, uy, the seconds that they all take and the speed.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        to = start_of(context, builder, sig.args[2], args[2])
        fields, columns = sig.args[0], sig.args[2]
        shape = cgutils.create_struct_proxy(fields)(context, builder, args[0]).shape
        width = cgutils.create_struct_proxy(columns)(context, builder, args[2]).shape
        per_group = builder.mul(builder.extract_value(shape, 1), builder.extract_value(shape, 2))
        of = builder.mul(per_group, whole(context, builder, sig.args[1], args[1]))
        row, at = builder.extract_value(width, 1), whole(context, builder, sig.args[3], args[3])
        wide = ir.VectorType(DOUBLE, LANES)
        x, y, ux, uy, speed = (
            builder.fpext(
                load(builder, begin, builder.add(of, ir.Constant(LONG, LANES * k)), LANES), wide
            )
            for k in range(5)
        )
        c, s, px, py, seconds = (spread(builder, args[k], LANES) for k in range(4, 9))
        add, sub, mul = builder.fadd, builder.fsub, builder.fmul
        rows = (
            sub(add(px, mul(c, x)), mul(s, y)),
            add(add(py, mul(s, x)), mul(c, y)),
            sub(mul(c, ux), mul(s, uy)),
            add(mul(s, ux), mul(c, uy)),
            seconds,
            speed,
        )
        for k, value in enumerate(rows):
            store(builder, value, to, builder.add(at, builder.mul(row, ir.Constant(LONG, k))))
        return context.get_dummy_value()

    return types.void(lanes, group, ends, at, *[types.float64] * 5), codegen


@intrinsic
def lay_samples(typingctx, paths, path, first, share, c, s, x, y, to, at, row):
    """Write where somebody on a path is at the sample times to come, 16 of them.

    Args:
        paths: (n, 3, 16) float32, C-contiguous: x, y and something else at the samples, the last
            ones at the end.
        path: which one.
        first: sample that comes before now, 15 at most.
        share: how much of the way from there to the next one is behind, 0 to 1.
        c, s, x, y: cosine and sine of what the path is turned by, and where it begins.
        to: float32, C-contiguous; gets x from place ``at`` on and y ``row`` places farther on.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        target = start_of(context, builder, sig.args[8], args[8])
        path, first = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (9, 10))
        share, c, s, x, y = (
            spread(builder, builder.fptrunc(args[k], FLOAT), SAMPLES) for k in range(3, 8)
        )
        start = builder.mul(path, ir.Constant(LONG, 3 * SAMPLES))
        add, sub, mul = builder.fadd, builder.fsub, builder.fmul
        # Where the samples end, those of the next row follow: the last one stands for them.
        beyond = builder.add(spread(builder, first, SAMPLES), numbers(SAMPLES))
        own = []
        for k in range(2):
            begins = builder.add(start, ir.Constant(LONG, SAMPLES * k))
            end = builder.load(builder.gep(begin, [builder.add(begins, ir.Constant(LONG, 15))]))
            end = spread(builder, end, SAMPLES)
            begins = builder.add(begins, first)
            here = load(builder, begin, begins, SAMPLES)
            there = load(builder, begin, builder.add(begins, ir.Constant(LONG, 1)), SAMPLES)
            between = add(here, mul(share, sub(there, here)))
            ended = builder.icmp_signed(">=", beyond, same(LONG, SAMPLES, SAMPLES - 1))
            own.append(builder.select(ended, end, between))
        store(builder, add(x, sub(mul(c, own[0]), mul(s, own[1]))), target, at)
        place = builder.add(at, row)
        store(builder, add(y, add(mul(s, own[0]), mul(c, own[1]))), target, place)
        return context.get_dummy_value()

    given = [types.float64] * 5
    return types.void(paths, path, first, *given, to, at, row), codegen
