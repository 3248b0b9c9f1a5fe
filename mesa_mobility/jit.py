"""How the functions of the hot path are compiled.

Without counting references to arrays: they neither make nor keep any. The crowd's state alone is
some 30 arrays, and to count references to them all at each call of a function of a few
nanoseconds took longer than what the function does.  A division by zero gives inf or nan, as
in NumPy: the test for it would keep a loop from running several items at once.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

called = partial(njit, cache=True, error_model="numpy", _nrt=False)
"""For functions that Python calls."""

lean = partial(called, no_cpython_wrapper=True, no_cfunc_wrapper=True)
"""For functions that only compiled ones call: a call from Python would crash it."""

_LINE = 64
"""Bytes that come from memory together."""


@intrinsic
def fetch(typingctx, array, row, size):  # type: ignore[no-untyped-def]
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
