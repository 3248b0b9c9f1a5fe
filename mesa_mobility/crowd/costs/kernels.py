"""Cost kernels: compiled functions that the search calls by address.

A kernel is written for one option, or for one option and one neighbour. It is compiled together
with a loop around it, over all options of a pedestrian or all neighbours of an option. So calls
cost nothing, and simple kernels handle several options at once.

Since kernels are called by address, the search is compiled once, whatever terms are plugged in. A
new kernel is compiled alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property, partial
from types import FunctionType
from typing import Any, ClassVar, Literal, Self, overload

from numba import njit, types

from mesa_mobility.compiled.cache import kept_cfunc
from mesa_mobility.crowd.costs.kernel_functions import (
    BOUND,
    OPTION,
    PAIR,
    PAIR_BOUND,
    WALL,
    BoundFunction,
    BoundFunctionWithVelocity,
    OptionFunction,
    OptionFunctionWithVelocity,
    PairBoundFunction,
    PairFunction,
    WallFunction,
    check_arguments,
)
from mesa_mobility.crowd.costs.kernel_loops import (
    BOUND_LOOP,
    OPTION_LOOP,
    PAIR_BOUND_LOOP,
    PAIR_LOOP,
    PAIRS_LOOP,
    WALL_LOOP,
)
from mesa_mobility.errors import ModelError

_F = types.float64
FLOATS = types.CPointer(_F)
_N = types.int64
INTS = types.CPointer(_N)


class CostKernel:
    """A function that is compiled with a loop around it when its address is first needed."""

    arguments: ClassVar[str]
    loop: ClassVar[str]
    signature: ClassVar[Any]

    def __init__(
        self,
        function: Callable[..., float],
        *,
        own_velocity: bool = False,
        fields: Sequence[str] = (),
    ) -> None:
        if isinstance(fields, str) or len(set(fields)) != len(fields):
            raise ModelError(f"kernel {function.__name__}: fields {fields!r}, expected their names")
        self.function = function
        self.fields = tuple(fields)
        self.own_velocity = own_velocity
        self._own = "own_vx, own_vy, " if own_velocity else ""
        check_arguments(function, self._asked())

    def _asked(self) -> str:
        """Names of the arguments that the function takes."""
        own = ["own_vx", "own_vy"] if self.own_velocity else []
        return ", ".join([self.arguments, *own, *self.fields, "parameters"])

    def _taken(self, neighbour: str) -> str:
        """The values of fields in a call: the person's own, then its neighbour's, if any."""
        own = [f"mine[at[{k}]], " for k in range(len(self.fields))]
        theirs = [
            f"theirs[at[{k}] * width + {neighbour}], "
            for k in range(len(self.fields) * bool(neighbour))
        ]
        return "".join(own + theirs)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Itself: its machine code stays where it is."""
        return self

    @cached_property
    def _compiled(self) -> Any:
        return self._compile(self.loop, self.signature, "loop")

    def _compile(self, source: str, signature: Any, suffix: str, neighbour: str = "") -> Any:
        # As in NumPy, a division by zero gives inf or nan, which the search refuses.
        loop = self._loop(source, suffix, neighbour)
        return kept_cfunc(loop, signature, error_model="numpy")

    def _loop(self, source: str, suffix: str, neighbour: str) -> FunctionType:
        """A loop as if written in the function's own file, with which it is cached."""
        code = self.function.__code__
        name = f"{self.function.__name__}_{suffix}"
        space = {
            "each": njit(error_model="numpy")(self.function),
            "__name__": self.function.__module__,
        }
        text = source.format(name=name, own=self._own, taken=self._taken(neighbour))
        source = "\n" * (code.co_firstlineno - 1) + text.lstrip("\n")
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

    arguments = OPTION
    loop = OPTION_LOOP
    signature = types.void(_N, *[FLOATS] * 6, *[_F] * 7, FLOATS, INTS, FLOATS, _F, FLOATS)


class BoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options."""

    arguments = BOUND
    loop = BOUND_LOOP
    signature = types.void(_N, *[FLOATS] * 9, *[_F] * 7, FLOATS, _F, FLOATS)


class PairKernel(CostKernel):
    """Cost of one movement option with respect to one neighbour.

    Two loops are compiled: over all neighbours of one option, and over a few neighbours and many
    options.
    """

    arguments = PAIR
    loop = PAIR_LOOP
    signature = types.void(_N, *[_F] * 10, *[FLOATS] * 9, _N, INTS, FLOATS, FLOATS)
    all_pairs: ClassVar[Any] = types.void(
        _N, _N, *[FLOATS] * 6, *[_F] * 4, *[FLOATS] * 9, _N, INTS, FLOATS, _F, FLOATS
    )

    def _asked(self) -> str:
        fields = [*self.fields, *(f"neighbour_{name}" for name in self.fields)]
        return ", ".join([self.arguments, *fields, "parameters"])

    @cached_property
    def _compiled(self) -> Any:
        return self._compile(self.loop, self.signature, "loop", neighbour="k")

    @cached_property
    def _compiled_pairs(self) -> Any:
        return self._compile(PAIRS_LOOP, self.all_pairs, "pairs", neighbour="a")

    @property
    def pairs_address(self) -> int:
        """Address of the machine code of the loop over some neighbours and many options."""
        return int(self._compiled_pairs.address)


class PairBoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options with respect to one neighbour."""

    arguments = PAIR_BOUND
    loop = PAIR_BOUND_LOOP
    signature = types.void(_N, _N, *[FLOATS] * 9, *[_F] * 4, *[FLOATS] * 8, _F, FLOATS)


class WallKernel(CostKernel):
    """Cost of one movement option with respect to one wall."""

    arguments = WALL
    loop = WALL_LOOP
    signature = types.float64(_N, *[_F] * 11, FLOATS, FLOATS)


@overload
def option_kernel(function: OptionFunction) -> OptionKernel: ...


@overload
def option_kernel(
    *, own_velocity: Literal[True]
) -> Callable[[OptionFunctionWithVelocity], OptionKernel]: ...


@overload
def option_kernel(
    *, own_velocity: bool = False, fields: Sequence[str]
) -> Callable[[Callable[..., float]], OptionKernel]: ...


def option_kernel(
    function: Callable[..., float] | None = None,
    *,
    own_velocity: bool = False,
    fields: Sequence[str] = (),
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
        fields: names of the pedestrian's fields that it takes, before ``parameters``, as floats:
            those that the model declares, or "type" (index), "group" (number, 0 for none),
            "heading" (radians) and "core" (metres). Such a kernel has no bound.

    Raises:
        ModelError: fields that are no list of different names, or another number of arguments.
    """
    if function is None:
        return partial(OptionKernel, own_velocity=own_velocity, fields=fields)
    return OptionKernel(function, own_velocity=own_velocity, fields=fields)


@overload
def bound_kernel(function: BoundFunction) -> BoundKernel: ...


@overload
def bound_kernel(
    *, own_velocity: Literal[True]
) -> Callable[[BoundFunctionWithVelocity], BoundKernel]: ...


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

    Raises:
        ModelError: another number of arguments, as in the other kernels.
    """
    if function is None:
        return partial(BoundKernel, own_velocity=own_velocity)
    return BoundKernel(function, own_velocity=own_velocity)


@overload
def pair_kernel(function: PairFunction) -> PairKernel: ...


@overload
def pair_kernel(*, fields: Sequence[str]) -> Callable[[Callable[..., float]], PairKernel]: ...


def pair_kernel(
    function: Callable[..., float] | None = None, *, fields: Sequence[str] = ()
) -> PairKernel | Callable[[Callable[..., float]], PairKernel]:
    """Make a kernel of one movement option and one neighbour; the search sums over neighbours.

    The function takes ``(x, y, facing_x, facing_y, duration, speed, start_x, start_y, target_x,
    target_y, neighbour_x, neighbour_y, neighbour_vx, neighbour_vy, neighbour_ex, neighbour_ey,
    lead, parameters)``.  After the arguments of an option kernel come the neighbour's position in
    metres and velocity in m/s at the moment of the decision, the unit vector from it to its target
    (0, 0 at the target), and the metres by which its route is shorter than the pedestrian's.

    Args:
        function: the function.
        fields: as for ``option_kernel``; the function takes the pedestrian's own values and then
            the neighbour's: ``..., lead, infected, neighbour_infected, parameters`` for
            ``fields=("infected",)``.

    Raises:
        ModelError: fields that are no list of different names, or another number of arguments.
    """
    if function is None:
        return partial(PairKernel, fields=fields)
    return PairKernel(function, fields=fields)


def pair_bound_kernel(function: PairBoundFunction) -> PairBoundKernel:
    """Make a lower bound of a pair kernel over a group of similar options, for one neighbour.

    The function takes ``(x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest,
    start_x, start_y, target_x, target_y, neighbour_x, neighbour_y, neighbour_vx, neighbour_vy,
    neighbour_ex, neighbour_ey, lead, parameters)``: the group as for ``bound_kernel``, the
    neighbour as for ``pair_kernel``.
    """
    return PairBoundKernel(function)


def wall_kernel(function: WallFunction) -> WallKernel:
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
