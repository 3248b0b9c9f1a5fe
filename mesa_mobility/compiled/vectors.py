"""Building blocks of the hand-written LLVM code.

Pointers carry no element type here: each function names the type that it loads, and the type
in which an index is counted. The same code therefore serves llvmlite's typed pointers, which
are cast to the type needed, and its opaque ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils

BIT, BYTE, INT, LONG = (ir.IntType(bits) for bits in (1, 8, 32, 64))
FLOAT, DOUBLE = ir.FloatType(), ir.DoubleType()


class Start(NamedTuple):
    """Pointer to the first element of an array, and the LLVM type of its elements."""

    pointer: Any
    element: Any


def start_of(context: Any, builder: Any, kind: Any, array: Any) -> Start:
    """The first element of a C-contiguous array of the Numba type ``kind``."""
    held = cgutils.create_struct_proxy(kind)(context, builder, array)
    return Start(held.data, context.get_data_type(kind.dtype))


def whole(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """A number of the Numba type ``kind``, as a 64-bit integer."""
    return context.cast(builder, value, kind, types.int64)


def wholes(context: Any, builder: Any, kind: Any, value: Any) -> list[Any]:
    """Numbers of a tuple, as 64-bit integers."""
    return [
        whole(context, builder, each, builder.extract_value(value, k))
        for k, each in enumerate(kind)
    ]


def place_in(builder: Any, start: Start, at: Any, kind: Any | None = None) -> Any:
    """Pointer to element ``at``, as a pointer to ``kind``, by default the element's type."""
    place = builder.gep(start.pointer, [at], source_etype=start.element)
    wanted = start.element if kind is None else kind
    if place.type.is_opaque or place.type.pointee == wanted:
        return place
    return builder.bitcast(place, wanted.as_pointer())


def load_one(builder: Any, start: Start, at: Any) -> Any:
    """Element ``at``."""
    return builder.load(place_in(builder, start, at), typ=start.element)


def load(builder: Any, start: Start, at: Any, width: int) -> Any:
    """Load ``width`` elements, starting at ``at``, as a vector."""
    vector = ir.VectorType(start.element, width)
    # Aligned as an element is, not as a whole vector.
    return builder.load(place_in(builder, start, at, vector), align=4, typ=vector)


def load_three(builder: Any, start: Start, at: Any, row: Any, width: int) -> tuple[Any, Any, Any]:
    """Load three vectors, each of ``width`` elements, from three rows of an array.

    The first vector starts at element ``at``.  The rows are ``row`` elements apart.
    """
    second, third = builder.add(at, row), builder.add(at, builder.add(row, row))
    return (
        load(builder, start, at, width),
        load(builder, start, second, width),
        load(builder, start, third, width),
    )


def store(builder: Any, value: Any, start: Start, at: Any) -> None:
    """Store a vector, starting at element ``at``."""
    builder.store(value, place_in(builder, start, at, value.type), align=4)


def same(kind: Any, width: int, number: float) -> Any:
    """A vector that repeats a constant ``width`` times."""
    return ir.Constant(ir.VectorType(kind, width), [number] * width)


def less_of(builder: Any, one: Any, other: Any) -> Any:
    """The lesser of two, lane by lane."""
    return builder.select(builder.fcmp_ordered("<", one, other), one, other)


def more_of(builder: Any, one: Any, other: Any) -> Any:
    """The greater of two, lane by lane."""
    return builder.select(builder.fcmp_ordered(">", one, other), one, other)


def bits_of(builder: Any, found: Any) -> Any:
    """Mask of the lanes for which a condition holds, as an integer."""
    return builder.zext(builder.bitcast(found, ir.IntType(found.type.count)), LONG)


def spread(builder: Any, value: Any, width: int) -> Any:
    """A vector that repeats a value ``width`` times."""
    vector = ir.VectorType(value.type, width)
    nothing = ir.Constant(vector, ir.Undefined)
    one = builder.insert_element(nothing, value, ir.Constant(INT, 0))
    return builder.shuffle_vector(one, nothing, ir.Constant(ir.VectorType(INT, width), [0] * width))


def some_lanes(builder: Any, vector: Any, lanes: Sequence[int]) -> Any:
    """Select lanes of a vector."""
    mask = ir.Constant(ir.VectorType(INT, len(lanes)), list(lanes))
    return builder.shuffle_vector(vector, ir.Constant(vector.type, ir.Undefined), mask)


def bytes_of(builder: Any, pointer: Any) -> Start:
    """The same address, as a pointer to bytes."""
    if not pointer.type.is_opaque:
        pointer = builder.bitcast(pointer, BYTE.as_pointer())
    return Start(pointer, BYTE)


def prefetch(builder: Any, place: Any) -> None:
    """Prefetch an address for reading, into all cache levels."""
    takes = ir.FunctionType(ir.VoidType(), [place.type, INT, INT, INT])
    # LLVM itself appends the pointer type to the name.
    function = cgutils.get_or_insert_function(builder.module, takes, "llvm.prefetch.p0")
    builder.call(function, [place, *(ir.Constant(INT, number) for number in (0, 3, 1))])


def take_number(builder: Any, place: Any) -> Any:
    """Atomic fetch-and-add of 1; returns the old value."""
    return builder.atomic_rmw("add", place, ir.Constant(LONG, 1), "seq_cst")


def store_release(builder: Any, number: Any, place: Any) -> None:
    """Store an integer with release semantics: threads that load it see all earlier stores.

    This is an exchange, since llvmlite's atomic store takes typed pointers only.
    """
    builder.atomic_rmw("xchg", place, number, "release")


def load_acquire(builder: Any, place: Any) -> Any:
    """Load an integer with acquire semantics: all stores before its release are visible."""
    return builder.load_atomic(place, "acquire", 8, typ=LONG)


def across(builder: Any, vector: Any, of_two: Callable[[Any, Any, Any], Any]) -> Any:
    """Reduce a vector to its least or greatest lane, with the function that selects from two."""
    width = vector.type.count
    while width > 1:
        width //= 2
        halves = (some_lanes(builder, vector, range(k, k + width)) for k in (0, width))
        vector = of_two(builder, *halves)
    return builder.extract_element(vector, ir.Constant(INT, 0))
