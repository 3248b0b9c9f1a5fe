"""Cost kernels: compiled functions that the search calls by address.

A kernel is written for one option, or for one option and one neighbour. It is compiled together
with a loop around it, over all options of a pedestrian or all neighbours of an option. So calls
cost nothing, and simple kernels handle several options at once.

Since kernels are called by address, the search is compiled once, whatever terms are plugged in. A
new kernel is compiled alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from types import FunctionType
from typing import Any, ClassVar, Self

from numba import njit, types

from mesa_mobility.compiled.cache import kept_cfunc
from mesa_mobility.crowd.costs.kernel_functions import (
    BOUND,
    OPTION,
    PAIR,
    PAIR_BOUND,
    WALL,
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
