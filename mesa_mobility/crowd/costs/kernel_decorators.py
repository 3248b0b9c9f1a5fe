"""Decorators that make cost kernels of functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import overload

from mesa_mobility.crowd.costs.kernels import (
    BoundKernel,
    CostKernel,
    OptionKernel,
    PairKernel,
    WallKernel,
)
from mesa_mobility.errors import ModelError

Function = Callable[..., float]


@overload
def option_kernel(function: Function) -> CostKernel: ...


@overload
def option_kernel(*, fields: Sequence[str]) -> Callable[[Function], CostKernel]: ...


def option_kernel(
    function: Function | None = None, *, fields: Sequence[str] = ()
) -> CostKernel | Callable[[Function], CostKernel]:
    """Make a kernel of a movement option.

    The function asks for what it sees by the names of its arguments, any of these in any order, and
    returns the cost, a float:

    - ``option``: an :class:`Option`; or ``options``, a group of them (:class:`Options`), for a
      lower bound of an option kernel, the ``bound`` of a term. The option kernel must not fall
      below it for any option of the group;
    - ``me``: the pedestrian (:class:`Me`);
    - ``wall``: a wall near (:class:`Wall`). The cost of an option is then that of its worst wall, 0
      if there are none, and must not be negative. A wall or a closed exit is near if its distance
      from the pedestrian is at most the reach of their options, their core radius and a centimetre
      together;
    - ``p``: the term. ``p.width`` is its attribute ``width``, a number.

    It must be compilable by Numba (``math``, no Python objects).

    Args:
        function: the function.
        fields: names of fields that the model declares for its people, or ``pace``: the share of
            their speed at which the ground lets people walk, or ``tread``: depth of the
            treads beneath them, metres, 0 off stairs. ``me`` then has them, too, as floats.

    Raises:
        ModelError: an argument or a field that there is not, or fields that are no list of
            different names.

    Examples:
        >>> from mesa_mobility import Me, Option, option_kernel
        >>> @option_kernel
        ... def slower(option: Option, me: Me) -> float:
        ...     return max(me.preferred_speed - option.speed, 0.0)
        >>> slower.arguments
        ('option', 'me')
    """
    if function is None:
        return partial(option_kernel, fields=fields)
    code = function.__code__
    names = code.co_varnames[: code.co_argcount]
    if "other" in names:
        raise ModelError(f"kernel {function.__name__}: takes other, which is for a pair_kernel")
    if "options" in names:
        return BoundKernel(function, fields)
    return (WallKernel if "wall" in names else OptionKernel)(function, fields)


@overload
def pair_kernel(function: Function) -> CostKernel: ...


@overload
def pair_kernel(*, fields: Sequence[str]) -> Callable[[Function], CostKernel]: ...


def pair_kernel(
    function: Function | None = None, *, fields: Sequence[str] = ()
) -> CostKernel | Callable[[Function], CostKernel]:
    """Make a kernel of a movement option beside another person; the search sums over neighbours.

    The function asks for any of ``option``, ``me``, ``other`` (:class:`Other`, a neighbour) and
    ``p``, as for ``option_kernel``. Its cost must not be negative.

    Args:
        function: the function.
        fields: names as for ``option_kernel``. ``me`` and ``other`` then have these fields, too,
            as floats.

    Raises:
        ModelError: as for ``option_kernel``.
    """
    return partial(pair_kernel, fields=fields) if function is None else PairKernel(function, fields)
