"""SIMD operations that the compiler does not find by itself.

Masks are integers: bit i is set if the condition holds for number i.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math
from typing import Any

import numpy as np
from llvmlite import ir
from llvmlite.binding import llvm_version_info
from numba import types
from numba.core import cgutils
from numpy.typing import NDArray

from mesa_mobility.compiled import vectors
from mesa_mobility.compiled.decorators import force_inlined
from mesa_mobility.compiled.twins import with_twin
from mesa_mobility.compiled.vectors import BIT, DOUBLE, INT, LONG

LANES = 8
"""Options of a group, and lanes of a vector."""

WIDE = 16
"""Groups tested at once."""

SAMPLES = 16
"""Samples of a path."""

AT_ONCE = 32
"""Numbers read at once when searching for the least."""

_PRESSES = 19
"""First version of LLVM with an instruction that compresses lanes."""


def _plain_place_of_least(values: NDArray[np.float64], n: int) -> int:
    least, where = values[0], 0
    for k in range(1, n):
        if values[k] < least:
            least, where = values[k], k
    return where


@with_twin(_plain_place_of_least)
def place_of_least(typingctx, values, n):
    """Index of the least of n numbers, the first if several are equal; none may be nan.

    n is at least 1. Whole vectors are read, ``AT_ONCE`` numbers at a time: padding at the end must
    not be less than the least.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = vectors.start_of(context, builder, sig.args[0], args[0])
        n = vectors.whole(context, builder, sig.args[1], args[1])
        parts = range(0, AT_ONCE, LANES)
        numbers = ir.Constant(ir.VectorType(LONG, LANES), list(range(LANES)))

        def look(block: Any, part: int) -> tuple[Any, Any]:
            """A vector of values and the vector of their indices."""
            at = builder.add(block, ir.Constant(LONG, part))
            places = builder.add(vectors.spread(builder, at, LANES), numbers)
            return vectors.load(builder, begin, at, LANES), places

        kept = []
        for part in parts:
            looked = look(ir.Constant(LONG, 0), part)
            kept.append([cgutils.alloca_once_value(builder, each) for each in looked])
        step = ir.Constant(LONG, AT_ONCE)
        with cgutils.for_range_slice(builder, step, n, step) as (block, _):
            for part, slots in zip(parts, kept, strict=True):
                value, places = look(block, part)
                less = builder.fcmp_ordered("<", value, builder.load(slots[0]))
                for new, slot in zip((value, places), slots, strict=True):
                    builder.store(builder.select(less, new, builder.load(slot)), slot)
        found = [tuple(builder.load(slot) for slot in slots) for slots in kept]
        while len(found) > 1:
            pairs = zip(found[::2], found[1::2], strict=True)
            found = [_lesser(builder, *one, *other) for one, other in pairs]
        value, place = found[0]
        width = LANES
        while width > 1:
            width //= 2
            halves = [
                vectors.some_lanes(builder, vector, range(start, start + width))
                for start in (0, width)
                for vector in (value, place)
            ]
            value, place = _lesser(builder, *halves)
        return builder.extract_element(place, ir.Constant(INT, 0))

    return types.int64(values, n), codegen


def _lesser(builder: Any, value: Any, place: Any, other: Any, elsewhere: Any) -> tuple[Any, Any]:
    """Lane by lane, the lesser value and its index, the first among equals."""
    first = builder.and_(
        builder.fcmp_ordered("==", other, value), builder.icmp_signed("<", elsewhere, place)
    )
    less = builder.or_(builder.fcmp_ordered("<", other, value), first)
    return builder.select(less, other, value), builder.select(less, elsewhere, place)


@force_inlined()
def any_of(values: NDArray[np.float64], at: int) -> bool:
    """Whether any of the 8 numbers starting at ``at`` is not 0."""
    found = False
    for lane in range(LANES):
        found |= values[at + lane] != 0.0
    return found


def _plain_no_more_than(values: NDArray[np.float64], at: int, most: float) -> int:
    bits = 0
    for lane in range(LANES):
        value = values[at + lane]
        bits |= int((not value > most) | (value == np.inf)) << lane
    return bits


@with_twin(_plain_no_more_than)
def no_more_than(typingctx, values, at, most):
    """Mask of the 8 numbers starting at ``at`` that are at most a limit, or not finite."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = vectors.start_of(context, builder, sig.args[0], args[0])
        at = vectors.whole(context, builder, sig.args[1], args[1])
        value = vectors.load(builder, begin, at, LANES)
        little = builder.fcmp_unordered("<=", value, vectors.spread(builder, args[2], LANES))
        endless = builder.fcmp_ordered("==", value, vectors.same(DOUBLE, LANES, math.inf))
        return vectors.bits_of(builder, builder.or_(little, endless))

    return types.int64(values, at, types.float64), codegen


@force_inlined()
def lowest_bit(bits: int) -> int:
    """Index of the lowest set bit; there must be one."""
    number = 0
    while not bits >> number & 1:
        number += 1
    return number


@force_inlined()
def bits_set(bits: int) -> int:
    """Number of set bits among the lowest 8."""
    number = 0
    for lane in range(LANES):
        number += bits >> lane & 1
    return number


def _pressed(builder: Any, vector: Any, bits: Any) -> Any:
    """Compress a vector: the lanes whose bit is set, moved to the front."""
    width, element = vector.type.count, vector.type.element
    mask = builder.trunc(bits, ir.IntType(width))
    mask = builder.bitcast(mask, ir.VectorType(BIT, width))
    nothing = ir.Constant(vector.type, ir.Undefined)
    if llvm_version_info[0] >= _PRESSES:
        name = f"llvm.experimental.vector.compress.v{width}{'f' if element == DOUBLE else 'i'}64"
        takes = ir.FunctionType(vector.type, [vector.type, mask.type, vector.type])
        press = cgutils.get_or_insert_function(builder.module, takes, name)
        return builder.call(press, [vector, mask, nothing])
    at = ir.Constant(INT, 0)
    for lane in range(width):
        number = ir.Constant(INT, lane)
        nothing = builder.insert_element(nothing, builder.extract_element(vector, number), at)
        at = builder.add(at, builder.zext(builder.extract_element(mask, number), INT))
    return nothing


def _plain_compress(
    given: NDArray[np.generic],
    row: int,
    at: int,
    bits: int,
    to: NDArray[np.generic],
    first: int,
    place: int,
    rows: int,
) -> None:
    source, target = given.flat, to.flat
    for k in range(rows):
        here = (row + k) * given.shape[-1] + at
        there = (first + k) * to.shape[-1] + place
        for lane in range(LANES):
            target[there] = source[here + lane]
            there += bits >> lane & 1


@with_twin(_plain_compress)
def compress(typingctx, given, row, at, bits, to, first, place, rows):
    """Of 8 elements in each of ``rows`` rows, copy those whose bit is set, side by side.

    ``given`` and ``to`` are C-contiguous arrays of the same 8-byte type. Reading starts at row
    ``row``, column ``at``; writing starts at row ``first``, column ``place``. ``rows``
    is a literal number. 8 elements are written; those after the copied ones are undefined.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        places = []
        for array, line, at in ((0, 1, 2), (4, 5, 6)):
            kind = sig.args[array]
            held = cgutils.create_struct_proxy(kind)(context, builder, args[array])
            width = cgutils.unpack_tuple(builder, held.shape, kind.ndim)[-1]
            line, at = (vectors.whole(context, builder, sig.args[k], args[k]) for k in (line, at))
            start = vectors.start_of(context, builder, kind, args[array])
            places.append((start, builder.add(builder.mul(line, width), at), width))
        (source, at, width), (target, place, there) = places
        for _ in range(rows.literal_value):
            values = vectors.load(builder, source, at, LANES)
            vectors.store(builder, _pressed(builder, values, args[3]), target, place)
            at, place = builder.add(at, width), builder.add(place, there)
        return context.get_dummy_value()

    if not isinstance(rows, types.IntegerLiteral):
        return None
    return types.void(given, row, at, types.int64, to, first, place, rows), codegen


@force_inlined()
def press_numbers(first: int, bits: int, to: NDArray[np.int64], place: int) -> None:
    """Write the integers ``first`` to ``first + 7`` whose bit is set, compressed.

    8 numbers are written; those after the set ones are undefined.
    """
    for lane in range(LANES):
        to[place] = first + lane
        place += bits >> lane & 1
