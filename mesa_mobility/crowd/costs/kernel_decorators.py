"""Decorators that make cost kernels of functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Literal, overload

from mesa_mobility.crowd.costs.kernel_functions import (
    BoundFunction,
    BoundFunctionWithVelocity,
    OptionFunction,
    OptionFunctionWithVelocity,
    PairBoundFunction,
    PairFunction,
    WallFunction,
)
from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    OptionKernel,
    PairBoundKernel,
    PairKernel,
    WallKernel,
)


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
