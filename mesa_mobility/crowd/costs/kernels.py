"""Cost kernels: compiled functions that the search calls by address.

A kernel is written for one option, or for one option and one neighbour. It is compiled together
with a loop around it, over all options of a pedestrian or all neighbours of an option. So calls
cost nothing, and simple kernels handle several options at once.

Since kernels are called by address, the search is compiled once, whatever terms are plugged in. A
new kernel is compiled alone.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from types import FunctionType
from typing import Any, ClassVar, Self, overload

from numba import njit, types

from mesa_mobility.compiled.cache import kept_cfunc

_F = types.float64
FLOATS = types.CPointer(_F)
_N = types.int64

_OPTION_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, preferred, own_vx, own_vy, p,
    weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], facing_x[k], facing_y[k], duration[k], speed[k], sx, sy, tx, ty, preferred,
            {own}p
        )
"""

_BOUND_LOOP = """
def {name}(
    n, x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest, sx, sy, tx, ty,
    preferred, own_vx, own_vy, p, weight, out
):
    for k in range(n):
        out[k] += weight * each(
            x[k], y[k], radius[k], facing_x[k], facing_y[k], turn[k], duration[k], slowest[k],
            fastest[k], sx, sy, tx, ty, preferred, {own}p
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

_PAIR_BOUND_LOOP = """
def {name}(
    m, n, x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest, sx, sy, tx, ty, nx,
    ny, nvx, nvy, nex, ney, lead, p, weight, out
):
    for a in range(m):
        ax, ay, avx, avy, aex, aey, alead = nx[a], ny[a], nvx[a], nvy[a], nex[a], ney[a], lead[a]
        for k in range(n):
            out[k] += weight * each(
                x[k], y[k], radius[k], facing_x[k], facing_y[k], turn[k], duration[k], slowest[k],
                fastest[k], sx, sy, tx, ty, ax, ay, avx, avy, aex, aey, alead, p
            )
"""

_WALL_LOOP = """
def {name}(
    n, x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, core, walls, p
):
    worst = 0.0
    for k in range(n):
        cost = each(
            x, y, facing_x, facing_y, duration, speed, sx, sy, tx, ty, walls[5 * k],
            walls[5 * k + 1], walls[5 * k + 2], walls[5 * k + 3], core, p
        )
        # A cost that is not a number stays the worst.
        worst = cost if worst == worst and not cost <= worst else worst
    return worst
"""


class CostKernel:
    """A function that is compiled with a loop around it when its address is first needed."""

    loop: ClassVar[str]
    signature: ClassVar[Any]

    def __init__(self, function: Callable[..., float], *, own_velocity: bool = False) -> None:
        self.function = function
        self._own = "own_vx, own_vy, " if own_velocity else ""

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
        source = "\n" * (code.co_firstlineno - 1) + source.format(name=name, own=self._own).lstrip(
            "\n"
        )
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
    signature = types.void(_N, *[FLOATS] * 6, *[_F] * 7, FLOATS, _F, FLOATS)


class BoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options."""

    loop = _BOUND_LOOP
    signature = types.void(_N, *[FLOATS] * 9, *[_F] * 7, FLOATS, _F, FLOATS)


class PairKernel(CostKernel):
    """Cost of one movement option with respect to one neighbour.

    Two loops are compiled: over all neighbours of one option, and over a few neighbours and many
    options.
    """

    loop = _PAIR_LOOP
    signature = types.void(_N, *[_F] * 10, *[FLOATS] * 9)
    all_pairs: ClassVar[Any] = types.void(
        _N, _N, *[FLOATS] * 6, *[_F] * 4, *[FLOATS] * 8, _F, FLOATS
    )

    @cached_property
    def _compiled_pairs(self) -> Any:
        return self._compile(_PAIRS_LOOP, self.all_pairs, "pairs")

    @property
    def pairs_address(self) -> int:
        """Address of the machine code of the loop over some neighbours and many options."""
        return int(self._compiled_pairs.address)


class PairBoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options with respect to one neighbour."""

    loop = _PAIR_BOUND_LOOP
    signature = types.void(_N, _N, *[FLOATS] * 9, *[_F] * 4, *[FLOATS] * 8, _F, FLOATS)


class WallKernel(CostKernel):
    """Cost of one movement option with respect to one wall."""

    loop = _WALL_LOOP
    signature = types.float64(_N, *[_F] * 11, FLOATS, FLOATS)


@overload
def option_kernel(function: Callable[..., float]) -> OptionKernel: ...


@overload
def option_kernel(*, own_velocity: bool) -> Callable[[Callable[..., float]], OptionKernel]: ...


def option_kernel(
    function: Callable[..., float] | None = None, *, own_velocity: bool = False
) -> OptionKernel | Callable[[Callable[..., float]], OptionKernel]:
    """Make a kernel of one movement option.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, preferred_speed, parameters)`` - mobility point, position of the pedestrian and
    target in metres, the unit vector of facing at the mobility point, duration in seconds, speeds
    in m/s; speed times duration is the displacement - and returns a float.  ``parameters[i]`` are
    the numbers of the term's ``parameters()``.  It must be compilable by Numba (``math``, no
    Python objects).

    Args:
        function: the function.
        own_velocity: whether it also takes ``own_vx, own_vy`` before ``parameters``: the mean
            velocity of the movement that has just ended, m/s.
    """
    if function is None:
        return partial(OptionKernel, own_velocity=own_velocity)
    return OptionKernel(function, own_velocity=own_velocity)


@overload
def bound_kernel(function: Callable[..., float]) -> BoundKernel: ...


@overload
def bound_kernel(*, own_velocity: bool) -> Callable[[Callable[..., float]], BoundKernel]: ...


def bound_kernel(
    function: Callable[..., float] | None = None, *, own_velocity: bool = False
) -> BoundKernel | Callable[[Callable[..., float]], BoundKernel]:
    """Make a lower bound of an option kernel over a group of similar options.

    The function takes ``(x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest,
    start_x, start_y, target_x, target_y, preferred_speed, parameters)`` and returns a number that
    the option kernel does not fall below for any option that ends within ``radius`` metres of
    (x, y), faces within ``turn`` radians of the unit vector there, takes ``duration`` seconds and
    has a speed from ``slowest`` to ``fastest``.

    Args:
        function: the function.
        own_velocity: as for ``option_kernel``.
    """
    if function is None:
        return partial(BoundKernel, own_velocity=own_velocity)
    return BoundKernel(function, own_velocity=own_velocity)


def pair_kernel(function: Callable[..., float]) -> PairKernel:
    """Make a kernel of one movement option and one neighbour; the search sums over neighbours.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, neighbour_x, neighbour_y, neighbour_vx, neighbour_vy, neighbour_ex, neighbour_ey,
    lead, parameters)``.  After the arguments of an option kernel come the neighbour's position in
    metres and velocity in m/s at the moment of the decision, the unit vector from it to its target
    (0, 0 at the target), and the metres by which its route is shorter than the pedestrian's.
    """
    return PairKernel(function)


def pair_bound_kernel(function: Callable[..., float]) -> PairBoundKernel:
    """Make a lower bound of a pair kernel over a group of similar options, for one neighbour.

    The function takes ``(x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest,
    start_x, start_y, target_x, target_y, neighbour_x, neighbour_y, neighbour_vx, neighbour_vy,
    neighbour_ex, neighbour_ey, lead, parameters)``: the group as for ``bound_kernel``, the
    neighbour as for ``pair_kernel``.
    """
    return PairBoundKernel(function)


def wall_kernel(function: Callable[..., float]) -> WallKernel:
    """Make a kernel of one movement option and one wall; the worst wall counts.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, wall_x1, wall_y1, wall_x2, wall_y2, core, parameters)``.  After the arguments of an
    option kernel but the preferred speed come the ends of the wall and the core radius of the
    pedestrian, metres.  Walls, closed exits among them, are those no farther from where the
    pedestrian is now than the farthest that its options lead, its core radius and a centimetre.
    The cost of an option is that of its worst wall, 0 if there are none.  It must not be negative,
    as with pair kernels.
    """
    return WallKernel(function)
