"""Several numbers at once, where a compiler does not see by itself that it could.

Short loops over parts of arrays mostly spend their time on finding out that the arrays do not
overlap. What is here is written for whole vectors; whatever the processor is, it is compiled
to as many of its registers as they take.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from llvmlite import ir
from llvmlite.binding import llvm_version_info
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

LANES = 8
"""Options of a group, and numbers looked at at once."""

WIDE = 16
"""Groups looked at at once."""

SAMPLES = 16
"""Samples of a path."""

AT_ONCE = 32
"""Numbers of which the least is found at once."""

_PRESSES = 19
"""Version of LLVM from which on it has an instruction for pressing lanes together."""

BIT, INT, LONG = ir.IntType(1), ir.IntType(32), ir.IntType(64)
FLOAT, DOUBLE = ir.FloatType(), ir.DoubleType()


def start_of(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    """Pointer to the first element of a C-contiguous array of the Numba type ``kind``."""
    return cgutils.create_struct_proxy(kind)(context, builder, array).data


def whole(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """A number of the Numba type ``kind`` as one of 64 bits."""
    return context.cast(builder, value, kind, types.int64)


def load(builder: Any, start: Any, at: Any, width: int) -> Any:
    """``width`` elements from place ``at`` on."""
    place = builder.gep(start, [at])
    vector = ir.VectorType(start.type.pointee, width)
    return builder.load(builder.bitcast(place, vector.as_pointer()), align=4)


def load_three(builder: Any, start: Any, at: Any, row: Any, width: int) -> tuple[Any, Any, Any]:
    """``width`` elements from place ``at`` on in each of three rows ``row`` places apart."""
    second, third = builder.add(at, row), builder.add(at, builder.add(row, row))
    return (
        load(builder, start, at, width),
        load(builder, start, second, width),
        load(builder, start, third, width),
    )


def store(builder: Any, value: Any, start: Any, at: Any) -> None:
    """Write a vector from place ``at`` on."""
    place = builder.gep(start, [at])
    builder.store(value, builder.bitcast(place, value.type.as_pointer()), align=4)


def spread(builder: Any, value: Any, width: int) -> Any:
    """A vector of a number ``width`` times."""
    vector = ir.VectorType(value.type, width)
    one = builder.insert_element(ir.Constant(vector, ir.Undefined), value, ir.Constant(INT, 0))
    none = ir.Constant(ir.VectorType(INT, width), [0] * width)
    return builder.shuffle_vector(one, ir.Constant(vector, ir.Undefined), none)


def same(kind: Any, width: int, number: float) -> Any:
    """A vector of a constant ``width`` times."""
    return ir.Constant(ir.VectorType(kind, width), [number] * width)


def numbers(width: int) -> Any:
    """The whole numbers from 0 on."""
    return ir.Constant(ir.VectorType(LONG, width), list(range(width)))


@intrinsic
def place_of_least(typingctx, values, n):
    """Place of the least of n floats, the first of several.

    n is at least 1. Read are whole vectors, ``AT_ONCE`` at a time: what fills up the last ones must
    not be less.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        n = whole(context, builder, sig.args[1], args[1])
        parts = range(AT_ONCE // LANES)
        kinds = ir.VectorType(DOUBLE, LANES), ir.VectorType(LONG, LANES)
        least = [cgutils.alloca_once(builder, kinds[0]) for _ in parts]
        where = [cgutils.alloca_once(builder, kinds[1]) for _ in parts]
        for part in parts:
            first = ir.Constant(LONG, LANES * part)
            builder.store(load(builder, begin, first, LANES), least[part])
            places = ir.Constant(kinds[1], [LANES * part + lane for lane in range(LANES)])
            builder.store(places, where[part])
        lanes = numbers(LANES)
        step = ir.Constant(LONG, AT_ONCE)
        with cgutils.for_range_slice(builder, step, n, step) as (block, _):
            for part in parts:
                place = builder.add(block, ir.Constant(LONG, LANES * part))
                value = load(builder, begin, place, LANES)
                less = builder.fcmp_ordered("<", value, builder.load(least[part]))
                places = builder.add(spread(builder, place, LANES), lanes)
                for new, kept in ((value, least[part]), (places, where[part])):
                    builder.store(builder.select(less, new, builder.load(kept)), kept)
        found = [(builder.load(least[part]), builder.load(where[part])) for part in parts]
        while len(found) > 1:
            found = [
                _lesser(builder, *one, *other)
                for one, other in zip(found[::2], found[1::2], strict=True)
            ]
        value, place = found[0]
        width = LANES
        while width > 1:
            width //= 2
            halves = [
                some_lanes(builder, vector, range(start, start + width))
                for start in (0, width)
                for vector in (value, place)
            ]
            value, place = _lesser(builder, *halves)
        return builder.extract_element(place, ir.Constant(INT, 0))

    return types.int64(values, n), codegen


def _lesser(builder: Any, value: Any, place: Any, other: Any, elsewhere: Any) -> tuple[Any, Any]:
    """Lane by lane, the lesser value and its place, the first one among equals."""
    first = builder.and_(
        builder.fcmp_ordered("==", other, value), builder.icmp_signed("<", elsewhere, place)
    )
    less = builder.or_(builder.fcmp_ordered("<", other, value), first)
    return builder.select(less, other, value), builder.select(less, elsewhere, place)


def some_lanes(builder: Any, vector: Any, lanes: Sequence[int]) -> Any:
    """Those of the lanes of a vector."""
    mask = ir.Constant(ir.VectorType(INT, len(lanes)), list(lanes))
    return builder.shuffle_vector(vector, ir.Constant(vector.type, ir.Undefined), mask)


def times(builder: Any, one: Any, other: Any) -> Any:
    """A product that may be added to something without being rounded, where that is one step."""
    return builder.fmul(one, other, flags=("contract",))


def plus(builder: Any, one: Any, other: Any) -> Any:
    """A sum; a product in it need not be rounded (see ``times``)."""
    return builder.fadd(one, other, flags=("contract",))


def minus(builder: Any, one: Any, other: Any) -> Any:
    """A difference; a product in it need not be rounded (see ``times``)."""
    return builder.fsub(one, other, flags=("contract",))


def less_of(builder: Any, one: Any, other: Any) -> Any:
    """The lesser of two, lane by lane."""
    return builder.select(builder.fcmp_ordered("<", one, other), one, other)


def more_of(builder: Any, one: Any, other: Any) -> Any:
    """The greater of two, lane by lane."""
    return builder.select(builder.fcmp_ordered(">", one, other), one, other)


def across(builder: Any, vector: Any, of_two: Callable[[Any, Any, Any], Any]) -> Any:
    """The least or the greatest of the lanes of a vector, by what tells it of two."""
    width = vector.type.count
    while width > 1:
        width //= 2
        halves = (some_lanes(builder, vector, range(first, first + width)) for first in (0, width))
        vector = of_two(builder, *halves)
    return builder.extract_element(vector, ir.Constant(INT, 0))


@intrinsic
def any_of(typingctx, values, at):
    """Whether any of 8 floats from place ``at`` on is not 0."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        value = load(builder, begin, whole(context, builder, sig.args[1], args[1]), LANES)
        some = builder.fcmp_unordered("!=", value, same(DOUBLE, LANES, 0.0))
        bits = builder.bitcast(some, ir.IntType(LANES))
        return builder.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(LANES), 0))

    return types.boolean(values, at), codegen


@intrinsic
def no_more_than(typingctx, values, at, most):
    """Bits of those of 8 floats from place ``at`` on that are at most so much, or not finite."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        value = load(builder, begin, whole(context, builder, sig.args[1], args[1]), LANES)
        most = spread(builder, args[2], LANES)
        little = builder.fcmp_unordered("<=", value, most)
        endless = builder.fcmp_ordered("==", value, same(DOUBLE, LANES, math.inf))
        bits = builder.bitcast(builder.or_(little, endless), ir.IntType(LANES))
        return builder.zext(bits, LONG)

    return types.int64(values, at, types.float64), codegen


@intrinsic
def lowest_bit(typingctx, bits):
    """Number of the lowest bit that is set; there must be one."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.cttz(args[0], ir.Constant(BIT, 1))

    return types.int64(types.int64), codegen


def _pressed(builder: Any, vector: Any, bits: Any) -> Any:
    """Those lanes of a vector whose bit is set, side by side from the first one on."""
    width = vector.type.count
    mask = builder.bitcast(builder.trunc(bits, ir.IntType(width)), ir.VectorType(BIT, width))
    none = ir.Constant(vector.type, ir.Undefined)
    if llvm_version_info[0] >= _PRESSES:
        kind = f"{'f' if vector.type.element == DOUBLE else 'i'}64"
        press = cgutils.get_or_insert_function(
            builder.module,
            ir.FunctionType(vector.type, [vector.type, mask.type, vector.type]),
            f"llvm.experimental.vector.compress.v{width}{kind}",
        )
        return builder.call(press, [vector, mask, none])
    found = cgutils.alloca_once(builder, ir.VectorType(vector.type.element, width))
    start = builder.bitcast(found, vector.type.element.as_pointer())
    at = ir.Constant(LONG, 0)
    for lane in range(width):
        number = ir.Constant(INT, lane)
        builder.store(builder.extract_element(vector, number), builder.gep(start, [at]))
        at = builder.add(at, builder.zext(builder.extract_element(mask, number), LONG))
    return builder.load(found)


@intrinsic
def press_lanes(typingctx, given, row, at, bits, to, first, place, rows):
    """Copy those of 8 elements of 8 bytes whose bit is set, side by side, in each of so many rows.

    ``given`` and ``to`` are C-contiguous arrays of the same type; rows are copied from ``row`` on,
    from place ``at`` on, to those from ``first`` on, there from ``place`` on. ``rows`` is a literal
    number. Read and written are whole vectors: what follows is of no meaning.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        places = []
        for array, line, at in ((0, 1, 2), (4, 5, 6)):
            kind = sig.args[array]
            held = cgutils.create_struct_proxy(kind)(context, builder, args[array])
            width = cgutils.unpack_tuple(builder, held.shape, kind.ndim)[-1]
            line, at = (whole(context, builder, sig.args[k], args[k]) for k in (line, at))
            places.append((held.data, builder.add(builder.mul(line, width), at), width))
        (source, at, width), (target, place, there) = places
        for k in range(rows.literal_value):
            by = ir.Constant(LONG, k)
            values = load(builder, source, builder.add(at, builder.mul(width, by)), LANES)
            values = _pressed(builder, values, args[3])
            store(builder, values, target, builder.add(place, builder.mul(there, by)))
        return context.get_dummy_value()

    if not isinstance(rows, types.IntegerLiteral):
        return None
    return types.void(given, row, at, types.int64, to, first, place, rows), codegen


@intrinsic
def press_numbers(typingctx, first, bits, to, place):
    """Write those of the 8 whole numbers from ``first`` on whose bit is set, side by side.

    ``to`` int64; written is a whole vector: what follows is of no meaning.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[2], args[2])
        first, place = (whole(context, builder, sig.args[k], args[k]) for k in (0, 3))
        values = builder.add(spread(builder, first, LANES), numbers(LANES))
        store(builder, _pressed(builder, values, args[1]), begin, place)
        return context.get_dummy_value()

    return types.void(first, types.int64, to, place), codegen


@intrinsic
def bits_set(typingctx, bits):
    """How many bits are set."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.ctpop(args[0])

    return types.int64(types.int64), codegen
