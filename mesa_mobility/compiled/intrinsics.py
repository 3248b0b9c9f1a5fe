"""Processor instructions that Numba does not offer: prefetching, and memory shared by threads."""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import sys
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numpy.typing import NDArray

from mesa_mobility.compiled import vectors
from mesa_mobility.compiled.twins import with_twin

_LINE = 64
"""Bytes that come from memory together."""

_REST_US = 50
"""Microseconds; systems wake a thread some 50 later than it asked for."""


def _plain_prefetch(array: NDArray, row: int, size: int) -> None:
    pass


@with_twin(_plain_prefetch)
def prefetch(typingctx, array, row, size):
    """Have the first ``size`` bytes of a row of a C-contiguous array brought from memory.

    To wait for main memory takes a hundred nanoseconds; what is fetched ahead comes meanwhile.
    ``size`` is a literal number.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = sig.args[0]
        held = cgutils.create_struct_proxy(kind)(context, builder, args[0])
        stride = cgutils.unpack_tuple(builder, held.strides, kind.ndim)[0]
        row = context.cast(builder, args[1], sig.args[1], types.int64)
        start = vectors.bytes_of(builder, held.data)
        at = builder.mul(stride, row)
        for line in range(0, size.literal_value, _LINE):
            offset = builder.add(at, ir.Constant(vectors.LONG, line))
            vectors.prefetch(builder, vectors.place_in(builder, start, offset))
        return context.get_dummy_value()

    if not isinstance(size, types.IntegerLiteral):
        return None
    return types.void(array, row, size), codegen


def _place(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Pointer to a place in a one-dimensional C-contiguous array of int64."""
    start = vectors.start_of(context, builder, sig.args[0], args[0])
    return vectors.place_in(builder, start, vectors.whole(context, builder, sig.args[1], args[1]))


def _plain_take_number(array: NDArray, place: int) -> int:
    number = array[place]
    array[place] = number + 1
    return number


@with_twin(_plain_take_number)
def take_number(typingctx, array, place):
    """Add 1 to a place of an int64 array and return what was there: no two threads get the same."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return vectors.take_number(builder, _place(context, builder, sig, args))

    return types.int64(array, place), codegen


def _plain_store_release(array: NDArray, place: int, value: int) -> None:
    array[place] = value


@with_twin(_plain_store_release)
def store_release(typingctx, array, place, value):
    """Store to a place of an int64 array; ``load_acquire`` of it sees all earlier stores."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        number = context.cast(builder, args[2], sig.args[2], types.int64)
        vectors.store_release(builder, number, _place(context, builder, sig, args))
        return context.get_dummy_value()

    return types.void(array, place, value), codegen


def _plain_rest() -> None:
    pass


@with_twin(_plain_rest)
def rest(typingctx):
    """Leave the processor to others for some 0.1 ms, since another thread may need it to finish.

    Yielding it is not enough: the other thread may wait for another processor, and gets this one
    only if it is idle.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        # Windows rests for a whole tick of its clock, which is too long.
        name, takes = (
            ("SwitchToThread", []) if sys.platform == "win32" else ("usleep", [vectors.INT])
        )
        function = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(vectors.INT, takes), name
        )
        builder.call(function, [ir.Constant(kind, _REST_US) for kind in takes])
        return context.get_dummy_value()

    return types.void(), codegen


def _plain_load_acquire(array: NDArray, place: int) -> int:
    return array[place]


@with_twin(_plain_load_acquire)
def load_acquire(typingctx, array, place):
    """Load what another thread stored to a place of an int64 array by ``store_release``."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return vectors.load_acquire(builder, _place(context, builder, sig, args))

    return types.int64(array, place), codegen
