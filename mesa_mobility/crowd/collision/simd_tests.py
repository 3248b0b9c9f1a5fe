"""Collision tests of several options, groups or people at once.

Arrays are given whole, with the place where a row of theirs starts: to take a part of one
takes as long as to look at 16 of its numbers. Hand-written code reads and writes whole vectors.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numpy.typing import NDArray

from mesa_mobility.compiled.simd import LANES, SAMPLES, WIDE
from mesa_mobility.compiled.twins import with_twin
from mesa_mobility.compiled.vectors import (
    BIT,
    FLOAT,
    INT,
    LONG,
    Start,
    bits_of,
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

NOTHING = np.float32(0.0)


def _away2(builder: Any, x: Any, y: Any, bodies: Start, at: Any) -> tuple[Any, Any]:
    """Squared distances of places from a body, and the distance to keep from it."""
    rows = [builder.add(at, ir.Constant(LONG, k * SAMPLES)) for k in range(3)]
    of = [spread(builder, load_one(builder, bodies, row), x.type.count) for row in rows]
    dx, dy = builder.fsub(x, of[0]), builder.fsub(y, of[1])
    return builder.fadd(builder.fmul(dx, dx), builder.fmul(dy, dy)), of[2]


def _plain_drop_within(
    circles: NDArray[np.float32],
    which: tuple[int, int, int],
    bodies: NDArray[np.float32],
    places: NDArray[np.int64],
    there: tuple[int, int],
    dropped: NDArray[np.int32],
) -> None:
    at, row, n = which
    first, known = there
    of, body, starts = circles.flat, bodies.flat, places.flat
    for k in range(n):
        x, y, radius = of[at + k], of[at + row + k], of[at + 2 * row + k]
        found = dropped[k] != 0
        for m in range(first, first + known):
            b = starts[m]
            dx, dy = x - body[b], y - body[b + SAMPLES]
            room = body[b + 2 * SAMPLES] - radius
            room = room if room > NOTHING else NOTHING
            found |= dx * dx + dy * dy < room * room
        dropped[k] = found


@with_twin(_plain_drop_within)
def drop_within(typingctx, circles, which, bodies, places, there, dropped):
    """Set ``dropped`` of those of n circles that lie wholly within a body.

    Args:
        circles: C-contiguous.
        which: ``(at, row, n)``: x of the first circle at place ``at``, its y ``row`` places and its
            radius twice as many farther on; how many circles.
        bodies: C-contiguous, 16 numbers a row.
        places: C-contiguous: where in ``bodies`` the x of each one is, with its y a row and its
            distance to keep two rows farther on.
        there: ``(first, known)``: the first of ``places`` that counts; how many do.
        dropped: by circle.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        bodies = start_of(context, builder, sig.args[2], args[2])
        places = start_of(context, builder, sig.args[3], args[3])
        marks = start_of(context, builder, sig.args[5], args[5])
        at, row, n = wholes(context, builder, sig.args[1], args[1])
        first, known = wholes(context, builder, sig.args[4], args[4])
        wide = ir.Constant(LONG, WIDE)
        found = cgutils.alloca_once(builder, ir.VectorType(BIT, WIDE))
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            before = load(builder, marks, block, WIDE)
            builder.store(builder.icmp_signed("!=", before, same(INT, WIDE, 0)), found)
            with cgutils.for_range(builder, known) as loop:
                body = load_one(builder, places, builder.add(first, loop.index))
                away2, apart = _away2(builder, x, y, bodies, body)
                room = more_of(builder, builder.fsub(apart, radius), same(FLOAT, WIDE, 0.0))
                within = builder.fcmp_ordered("<", away2, builder.fmul(room, room))
                builder.store(builder.or_(builder.load(found), within), found)
            dropped = builder.zext(builder.load(found), ir.VectorType(INT, WIDE))
            store(builder, dropped, marks, block)
        return context.get_dummy_value()

    return types.void(circles, which, bodies, places, there, dropped), codegen


def _plain_places_within(
    places: NDArray[np.float32],
    at: int,
    row: int,
    bodies: NDArray[np.float32],
    which: NDArray[np.int64],
    there: tuple[int, int],
) -> int:
    of, body, starts = places.flat, bodies.flat, which.flat
    first, known = there
    bits = 0
    for lane in range(LANES):
        x, y = of[at + lane], of[at + row + lane]
        within = False
        for m in range(first, first + known):
            b = starts[m]
            dx, dy, apart = x - body[b], y - body[b + SAMPLES], body[b + 2 * SAMPLES]
            within |= bool(dx * dx + dy * dy < apart * apart)
        bits |= int(within) << lane
    return bits


@with_twin(_plain_places_within)
def places_within(typingctx, places, at, row, bodies, which, there):
    """A mask of 8 bits: which of 8 places lie within a body.

    Args:
        places: C-contiguous.
        at: index of the x of the first place.
        row: y of a place is this far after its x.
        bodies, which, there: as ``bodies``, ``places`` and ``there`` of ``drop_within``.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        bodies = start_of(context, builder, sig.args[3], args[3])
        which = start_of(context, builder, sig.args[4], args[4])
        at, row = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2))
        first, known = wholes(context, builder, sig.args[5], args[5])
        x = load(builder, begin, at, LANES)
        y = load(builder, begin, builder.add(at, row), LANES)
        found = cgutils.alloca_once_value(builder, same(BIT, LANES, 0))
        with cgutils.for_range(builder, known) as loop:
            body = load_one(builder, which, builder.add(first, loop.index))
            away2, apart = _away2(builder, x, y, bodies, body)
            within = builder.fcmp_ordered("<", away2, builder.fmul(apart, apart))
            builder.store(builder.or_(builder.load(found), within), found)
        return bits_of(builder, builder.load(found))

    return types.int64(places, at, row, bodies, which, there), codegen


def _plain_places_near(
    x: NDArray[np.float64], y: NDArray[np.float64], at: int, px: float, py: float, radius: float
) -> int:
    bits = 0
    for lane in range(LANES):
        dx, dy = x[at + lane] - px, y[at + lane] - py
        bits |= int(dx * dx + dy * dy <= radius * radius) << lane
    return bits


@with_twin(_plain_places_near)
def places_near(typingctx, x, y, at, px, py, radius):
    """Bits of those of 8 places from ``at`` on that are within ``radius`` of (px, py)."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        at = whole(context, builder, sig.args[2], args[2])
        away2 = []
        for k in range(2):
            begin = start_of(context, builder, sig.args[k], args[k])
            place = spread(builder, args[3 + k], LANES)
            away = builder.fsub(load(builder, begin, at, LANES), place)
            away2.append(builder.fmul(away, away))
        most = spread(builder, builder.fmul(args[5], args[5]), LANES)
        return bits_of(builder, builder.fcmp_ordered("<=", builder.fadd(*away2), most))

    return types.int64(x, y, at, *[types.float64] * 3), codegen


def _plain_numbers_between(values: NDArray[np.float64], at: int, above: float, up_to: float) -> int:
    bits = 0
    for lane in range(LANES):
        value = values[at + lane]
        bits |= int((value > above) & (value <= up_to)) << lane
    return bits


@with_twin(_plain_numbers_between)
def numbers_between(typingctx, values, at, above, up_to):
    """Bits of those of 8 numbers from place ``at`` on that are more than a number up to another."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        value = load(builder, begin, whole(context, builder, sig.args[1], args[1]), LANES)
        more = builder.fcmp_ordered(">", value, spread(builder, args[2], LANES))
        little = builder.fcmp_ordered("<=", value, spread(builder, args[3], LANES))
        return bits_of(builder, builder.and_(more, little))

    return types.int64(values, at, types.float64, types.float64), codegen
