"""Cost kernels: compiled functions that the search calls by address.

A kernel is written for one option, or for one option and one neighbour. It is compiled together
with a loop around it, over all options of a pedestrian or all neighbours of an option. So calls
cost nothing, and simple kernels handle several options at once.

Since kernels are called by address, the search is compiled once, whatever terms are plugged in. A
new kernel is compiled alone.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from types import FunctionType
from typing import Any, ClassVar, Self

from llvmlite import ir
from numba import njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from mesa_mobility.compiled.cache import kept_cfunc

_F = types.float64
_A = types.CPointer(_F)
_N = types.int64

_OPTION_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, preferred, p, weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], facing_x[k], facing_y[k], duration[k], speed[k], sx, sy, tx, ty, preferred,
            p
        )
"""

_BOUND_LOOP = """
def {name}(
    n, x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest, sx, sy, tx, ty,
    preferred, p, weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], radius[k], facing_x[k], facing_y[k], turn[k], duration[k], slowest[k],
            fastest[k], sx, sy, tx, ty, preferred, p
        )
"""

_PAIR_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead,
    p, out
):
    for k in range(n):
        out[k] = each(
            x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx[k], ny[k], nvx[k], nvy[k],
            nex[k], ney[k], lead[k], p
        )
"""

_PAIRS_LOOP = """
def {name}(
    m, n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney,
    lead, p, weight, out
):
    for a in range(m):
        ax, ay, avx, avy, aex, aey, alead = nx[a], ny[a], nvx[a], nvy[a], nex[a], ney[a], lead[a]
        for k in range(n):
            out[k] += weight * each(
                x[k], y[k], facing_x[k], facing_y[k], duration[k], speed[k], sx, sy, tx, ty, ax, ay,
                avx, avy, aex, aey, alead, p
            )
"""


class CostKernel:
    """A function that is compiled with a loop around it when its address is first needed."""

    loop: ClassVar[str]
    signature: ClassVar[Any]

    def __init__(self, function: Callable[..., float]) -> None:
        self.function = function

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Itself: its machine code stays where it is."""
        return self

    @cached_property
    def _compiled(self) -> Any:
        return self._compile(self.loop, self.signature, "loop")

    def _compile(self, source: str, signature: Any, suffix: str) -> Any:
        # As in NumPy, a division by zero gives inf or nan, which the search refuses.
        return kept_cfunc(self._loop(source, suffix), signature, error_model="numpy")

    def _loop(self, source: str, suffix: str) -> FunctionType:
        """A loop as if written in the function's own file, with which it is cached."""
        code = self.function.__code__
        name = f"{self.function.__name__}_{suffix}"
        space = {
            "each": njit(error_model="numpy")(self.function),
            "__name__": self.function.__module__,
        }
        source = "\n" * (code.co_firstlineno - 1) + source.format(name=name).lstrip("\n")
        exec(compile(source, code.co_filename, "exec"), space)
        loop = space[name]
        assert isinstance(loop, FunctionType)
        loop.__qualname__ = f"{self.function.__qualname__}_{suffix}"
        return loop

    @property
    def address(self) -> int:
        """Address of the machine code."""
        return int(self._compiled.address)


class OptionKernel(CostKernel):
    """Cost of one movement option."""

    loop = _OPTION_LOOP
    signature = types.void(_N, *[_A] * 6, *[_F] * 5, _A, _F, _A)


class BoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options."""

    loop = _BOUND_LOOP
    signature = types.void(_N, *[_A] * 9, *[_F] * 5, _A, _F, _A)


class PairKernel(CostKernel):
    """Cost of one movement option with respect to one neighbour.

    Two loops are compiled: over all neighbours of one option, and over a few neighbours and many
    options.
    """

    loop = _PAIR_LOOP
    signature = types.void(_N, *[_F] * 10, *[_A] * 9)
    all_pairs: ClassVar[Any] = types.void(_N, _N, *[_A] * 6, *[_F] * 4, *[_A] * 8, _F, _A)

    @cached_property
    def _compiled_pairs(self) -> Any:
        return self._compile(_PAIRS_LOOP, self.all_pairs, "pairs")

    @property
    def pairs_address(self) -> int:
        """Address of the machine code of the loop over some neighbours and many options."""
        return int(self._compiled_pairs.address)


def option_kernel(function: Callable[..., float]) -> OptionKernel:
    """Make a kernel of one movement option.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, preferred_speed, parameters)`` - mobility point, position of the pedestrian and
    target in metres, the unit vector of facing at the mobility point, duration in seconds, speeds
    in m/s; speed times duration is the displacement - and returns a float.  ``parameters[i]`` are
    the numbers of the term's ``parameters()``.  It must be compilable by Numba (``math``, no
    Python objects).
    """
    return OptionKernel(function)


def bound_kernel(function: Callable[..., float]) -> BoundKernel:
    """Make a lower bound of an option kernel over a group of similar options.

    The function takes ``(x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest,
    start_x, start_y, target_x, target_y, preferred_speed, parameters)`` and returns a number that
    the option kernel does not fall below for any option that ends within ``radius`` metres of
    (x, y), faces within ``turn`` radians of the unit vector there, takes ``duration`` seconds and
    has a speed from ``slowest`` to ``fastest``.
    """
    return BoundKernel(function)


def pair_kernel(function: Callable[..., float]) -> PairKernel:
    """Make a kernel of one movement option and one neighbour; the search sums over neighbours.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, neighbour_x, neighbour_y, neighbour_vx, neighbour_vy, neighbour_ex, neighbour_ey,
    lead, parameters)``.  After the arguments of an option kernel come the neighbour's position in
    metres and velocity in m/s at the moment of the decision, the unit vector from it to its target
    (0, 0 at the target), and the metres by which its route is shorter than the pedestrian's.
    """
    return PairKernel(function)


def _caller(signature: Any) -> Any:
    """Calls what is at an address; numbers as such, float arrays by their data.

    Plain Numba has no such call, so there is no twin of it (see ``compiled/twins.py``).
    """

    def typing(address: Any, *given: Any) -> Any:
        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            wanted = [context.get_value_type(kind) for kind in signature.args]
            called = ir.FunctionType(ir.VoidType(), wanted)
            function = builder.inttoptr(args[0], called.as_pointer())
            passed = []
            for value, kind, want in zip(args[1:], sig.args[1:], signature.args, strict=True):
                if want == _A:
                    array = cgutils.create_struct_proxy(kind)(context, builder, value)
                    passed.append(array.data)
                else:
                    passed.append(context.cast(builder, value, kind, want))
            builder.call(function, passed)
            return context.get_dummy_value()

        return signature.return_type(address, *given), codegen

    return typing


@intrinsic
def call_option_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p, weight, out
):
    """Add the weighted cost of n options to ``out``; arguments after the address as the loop's."""
    return _caller(OptionKernel.signature)(
        address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p, weight, out
    )


@intrinsic
def call_pair_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, p, out,
):  # fmt: skip
    """Write the cost of one option for each of n neighbours; arguments as the loop's."""
    return _caller(PairKernel.signature)(
        address, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead,
        p, out,
    )  # fmt: skip


@intrinsic
def call_pairs_loop(  # type: ignore[no-untyped-def]
    typingctx, address, m, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, p, weight, out,
):  # fmt: skip
    """Add the weighted costs of n options for each of m neighbours; arguments as the loop's."""
    return _caller(PairKernel.all_pairs)(
        address, m, n, x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney,
        lead, p, weight, out,
    )  # fmt: skip


@intrinsic
def call_bound_loop(  # type: ignore[no-untyped-def]
    typingctx, address, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty,
    preferred, p, weight, out,
):  # fmt: skip
    """Add the weighted bounds of n groups to ``out``; arguments after the address as the loop's."""
    return _caller(BoundKernel.signature)(
        address, n, x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty,
        preferred, p, weight, out,
    )  # fmt: skip
