"""Calls of cost kernels by address, from within the compiled search."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from mesa_mobility.crowd.costs.kernels import (
    FLOATS,
    INTS,
    BoundKernel,
    OptionKernel,
    PairBoundKernel,
    PairKernel,
    WallKernel,
)


def _caller(signature: Any) -> Any:
    """Calls what is at an address; numbers as such, arrays by their data.

    Plain Numba has no such call, so there is no twin of it (see ``compiled/twins.py``).
    """

    def typing(address: Any, *given: Any) -> Any:
        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            wanted = [context.get_value_type(kind) for kind in signature.args]
            gives = signature.return_type != types.void
            result_type = ir.DoubleType() if gives else ir.VoidType()
            called = ir.FunctionType(result_type, wanted)
            function = builder.inttoptr(args[0], called.as_pointer())
            passed = []
            for value, kind, want in zip(args[1:], sig.args[1:], signature.args, strict=True):
                if want in (FLOATS, INTS):
                    array = cgutils.create_struct_proxy(kind)(context, builder, value)
                    passed.append(array.data)
                else:
                    passed.append(context.cast(builder, value, kind, want))
            result = builder.call(function, passed)
            return result if gives else context.get_dummy_value()

        return signature.return_type(address, *given), codegen

    return typing


@intrinsic
def call_option_loop(  # type: ignore[no-untyped-def]
    typingctx,
    address,
    n,
    x,
    y,
    ux,
    uy,
    duration,
    speed,
    sx,
    sy,
    tx,
    ty,
    preferred,
    own_vx,
    own_vy,
    mine,
    at,
    p,
    weight,
    out,
):
    """Add the weighted cost of n options to ``out``; arguments after the address as the loop's."""
    return _caller(OptionKernel.signature)(
        address,
        n,
        x,
        y,
        ux,
        uy,
        duration,
        speed,
        sx,
        sy,
        tx,
        ty,
        preferred,
        own_vx,
        own_vy,
        mine,
        at,
        p,
        weight,
        out,
    )


@intrinsic
def call_pair_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, mine, theirs, width, at, p, out,
):  # fmt: skip
    """Write the cost of one option for each of n neighbours; arguments as the loop's."""
    return _caller(PairKernel.signature)(
        address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead,
        mine, theirs, width, at, p, out,
    )  # fmt: skip


@intrinsic
def call_pairs_loop(  # type: ignore[no-untyped-def]
    typingctx, address, m, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, mine, theirs, width, at, p, weight, out,
):  # fmt: skip
    """Add the weighted costs of n options for each of m neighbours; arguments as the loop's."""
    return _caller(PairKernel.all_pairs)(
        address, m, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney,
        lead, mine, theirs, width, at, p, weight, out,
    )  # fmt: skip


@intrinsic
def call_bound_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty,
    preferred, own_vx, own_vy, p, weight, out,
):  # fmt: skip
    """Add the weighted bounds of n groups to ``out``; arguments after the address as the loop's."""
    return _caller(BoundKernel.signature)(
        address, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty,
        preferred, own_vx, own_vy, p, weight, out,
    )  # fmt: skip


@intrinsic
def call_wall_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, core, walls, p
):
    """Cost of one option for the worst of n walls; arguments after the address as the loop's."""
    return _caller(WallKernel.signature)(
        address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, core, walls, p
    )


@intrinsic
def call_pair_bound_loop(  # type: ignore[no-untyped-def]
    typingctx, address, m, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx,
    ty, nx, ny, nvx, nvy, nex, ney, lead, p, weight, out,
):  # fmt: skip
    """Add the weighted bounds of n groups for each of m neighbours; arguments as the loop's."""
    return _caller(PairBoundKernel.signature)(
        address, m, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, nx,
        ny, nvx, nvy, nex, ney, lead, p, weight, out,
    )  # fmt: skip
