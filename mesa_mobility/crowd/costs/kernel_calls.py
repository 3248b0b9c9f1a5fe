"""Calls of cost kernels by address, from within the compiled search.

Each takes the address and a tuple of what the loop takes. Plain Numba has no such call, so there
are no twins of them (see ``compiled/twins.py``).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from mesa_mobility.crowd.costs.kernels import BoundKernel, OptionKernel, PairKernel, WallKernel

_NUMBER_BYTES = 8


def _passed(context: Any, builder: Any, kind: Any, value: Any) -> Iterator[tuple[Any, Any]]:
    """Kinds and values as a loop takes them: of an array its data, and the length of a row."""
    if not isinstance(kind, types.Array):
        yield kind, value
        return
    array = context.make_array(kind)(context, builder, value)
    yield None, array.data
    if kind.ndim > 1:
        stride = builder.extract_value(array.strides, 0)
        yield None, builder.sdiv(stride, ir.Constant(stride.type, _NUMBER_BYTES))


def _caller(signature: Any) -> Any:
    @intrinsic
    def call(typingctx, address, given):  # type: ignore[no-untyped-def]
        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            wanted = [context.get_value_type(kind) for kind in signature.args]
            gives = signature.return_type != types.void
            result_type = ir.DoubleType() if gives else ir.VoidType()
            called = ir.FunctionType(result_type, wanted)
            function = builder.inttoptr(args[0], called.as_pointer())
            values = [
                each
                for k, kind in enumerate(sig.args[1])
                for each in _passed(context, builder, kind, builder.extract_value(args[1], k))
            ]
            passed = [
                value if kind is None else context.cast(builder, value, kind, want)
                for (kind, value), want in zip(values, signature.args, strict=True)
            ]
            result = builder.call(function, passed)
            return result if gives else context.get_dummy_value()

        return signature.return_type(address, given), codegen

    return call


call_option_loop = _caller(OptionKernel.signature)
"""Add the weighted costs of n options to ``out``: ``(n, ends, own, at, numbers, weight, out)``."""

call_bound_loop = _caller(BoundKernel.signature)
"""Add the weighted bounds of n groups to ``out``: ``(n, ends, groups, own, at, numbers, weight,
out)``."""

call_pair_loop = _caller(PairKernel.signature)
"""Write the cost of one option for each of n neighbours: ``(n, ends, others, own, at, numbers,
out)``."""

call_pairs_loop = _caller(PairKernel.all_pairs)
"""Add the weighted costs of n options for each of m neighbours to ``out``: ``(m, which, n, ends,
others, own, at, numbers, weight, out)``; ``which`` are the columns of the neighbours."""

call_wall_loop = _caller(WallKernel.signature)
"""Cost of one option for the worst of n walls: ``(n, ends, walls, own, at, numbers)``."""
