"""Cost kernels: compiled functions that the choice calls by address.

A term that gives a kernel is evaluated inside the compiled choice, at a few
nanoseconds a call; a term that does not is evaluated in NumPy batches.  Calling
by address keeps the choice itself one compiled function whatever terms are
plugged in: a new kernel compiles alone, and nothing else is compiled again.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

from llvmlite import ir
from numba import cfunc, types
from numba.core import cgutils
from numba.extending import intrinsic

_F = types.float64
_PARAMETERS = types.CPointer(_F)

OPTION_SIGNATURE = _F(_F, _F, _F, _F, _F, _F, _F, _F, _F, _PARAMETERS)
PAIR_SIGNATURE = _F(_F, _F, _F, _F, _F, _F, _F, _F, _F, _PARAMETERS)


class CostKernel:
    """A function compiled when it is first needed, known by its address."""

    def __init__(self, function: Callable[..., float], signature: Any) -> None:
        self.function = function
        self._signature = signature

    @cached_property
    def _compiled(self) -> Any:
        # As in NumPy, a division by zero gives inf or nan, which the choice refuses.
        compile_ = partial(cfunc, self._signature, error_model="numpy")
        try:
            return compile_(cache=True)(self.function)
        except RuntimeError:  # written where there is no file to keep a cache beside
            return compile_()(self.function)

    @property
    def address(self) -> int:
        """Address of the machine code."""
        return int(self._compiled.address)


class OptionKernel(CostKernel):
    """Cost of one movement option."""


class PairKernel(CostKernel):
    """Cost of one movement option with respect to one neighbour."""


def option_kernel(function: Callable[..., float]) -> OptionKernel:
    """Make a kernel of one movement option.

    The function takes ``(x, y, heading, displacement, duration, speed, target_x, target_y,
    preferred_speed, parameters)`` - mobility point and target in metres, heading in radians,
    duration in seconds, speeds in m/s - and returns a float.  ``parameters[i]`` are the numbers
    of the term's ``parameters()``.  It must be compilable by Numba (``math``, no Python objects).
    """
    return OptionKernel(function, OPTION_SIGNATURE)


def pair_kernel(function: Callable[..., float]) -> PairKernel:
    """Make a kernel of one movement option and one neighbour; the choice sums over neighbours.

    The function takes ``(x, y, heading, duration, speed, neighbour_x, neighbour_y,
    neighbour_vx, neighbour_vy, parameters)``, the neighbour's position in metres and velocity in
    m/s at the moment of the decision.
    """
    return PairKernel(function, PAIR_SIGNATURE)


@intrinsic
def call_kernel(typingctx, address, a, b, c, d, e, f, g, h, i, parameters):  # type: ignore[no-untyped-def]
    """Call the kernel at ``address`` with nine floats and a float array of parameters."""
    signature = types.float64(address, a, b, c, d, e, f, g, h, i, parameters)

    def codegen(context, builder, sig, args):  # type: ignore[no-untyped-def]
        double = ir.DoubleType()
        pointer = double.as_pointer()
        kernel_type = ir.FunctionType(double, [double] * 9 + [pointer])
        kernel = builder.inttoptr(args[0], kernel_type.as_pointer())
        floats = [
            context.cast(builder, value, kind, types.float64)
            for value, kind in zip(args[1:10], sig.args[1:10], strict=True)
        ]
        array = cgutils.create_struct_proxy(sig.args[10])(context, builder, args[10])
        return builder.call(kernel, [*floats, array.data])

    return signature, codegen
