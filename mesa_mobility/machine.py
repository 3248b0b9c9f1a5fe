"""What a processor can do and Numba has no name for: memory ahead of time, and between threads."""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import sys
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_LINE = 64
"""Bytes that come from memory together."""


@intrinsic
def fetch(typingctx, array, row, size):
    """Have the first ``size`` bytes of a row of a C-contiguous array brought from memory.

    To wait for main memory takes a hundred nanoseconds; what is fetched ahead comes meanwhile.
    ``size`` is a literal number.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        kind = sig.args[0]
        held = cgutils.create_struct_proxy(kind)(context, builder, args[0])
        stride = cgutils.unpack_tuple(builder, held.strides, kind.ndim)[0]
        byte, whole = ir.IntType(8), ir.IntType(32)
        start = builder.bitcast(held.data, byte.as_pointer())
        at = builder.mul(stride, context.cast(builder, args[1], sig.args[1], types.int64))
        kinds = [byte.as_pointer(), whole, whole, whole]
        called = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(ir.VoidType(), kinds), "llvm.prefetch.p0i8"
        )
        for line in range(0, size.literal_value, _LINE):
            offset = builder.add(at, ir.Constant(ir.IntType(64), line))
            # To read, to be kept in all caches, data.
            how = [ir.Constant(whole, number) for number in (0, 3, 1)]
            builder.call(called, [builder.gep(start, [offset]), *how])
        return context.get_dummy_value()

    if not isinstance(size, types.IntegerLiteral):
        return None
    return types.void(array, row, size), codegen


def _place(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    """Pointer to a place in a one-dimensional C-contiguous array of int64."""
    held = cgutils.create_struct_proxy(sig.args[0])(context, builder, args[0])
    return builder.gep(held.data, [context.cast(builder, args[1], sig.args[1], types.int64)])


@intrinsic
def take_number(typingctx, array, place):
    """Add 1 to a place of an int64 array and return what was there: no two threads get the same."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        one = ir.Constant(ir.IntType(64), 1)
        return builder.atomic_rmw("add", _place(context, builder, sig, args), one, "seq_cst")

    return types.int64(array, place), codegen


@intrinsic
def tell(typingctx, array, place, value):
    """Write to a place of an int64 array; whoever reads it by ``told`` sees all written before."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        number = context.cast(builder, args[2], sig.args[2], types.int64)
        builder.store_atomic(number, _place(context, builder, sig, args), "release", 8)
        return context.get_dummy_value()

    return types.void(array, place, value), codegen


@intrinsic
def give_way(typingctx):
    """Let whoever else wants it have the processor: to wait for another thread takes two."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        name = "SwitchToThread" if sys.platform == "win32" else "sched_yield"
        yields = ir.FunctionType(ir.IntType(32), [])
        builder.call(cgutils.get_or_insert_function(builder.module, yields, name), [])
        return context.get_dummy_value()

    return types.void(), codegen


@intrinsic
def told(typingctx, array, place):
    """What another thread has written to a place of an int64 array by ``tell``."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.load_atomic(_place(context, builder, sig, args), "acquire", 8)

    return types.int64(array, place), codegen
