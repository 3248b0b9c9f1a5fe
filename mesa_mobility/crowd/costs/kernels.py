"""Cost kernels: compiled functions that the search calls by address.

A kernel is written for one option, or for one option and one neighbour. It is compiled together
with a loop around it, over all options of a pedestrian or all neighbours of an option. So calls
cost nothing, and simple kernels handle several options at once.

Since kernels are called by address, the search is compiled once, whatever terms are plugged in. A
new kernel is compiled alone.
"""

from __future__ import annotations

import re
from collections import namedtuple
from collections.abc import Callable, Sequence
from functools import cached_property
from types import FunctionType
from typing import Any, ClassVar, Self

from numba import njit, types
from numba.core.errors import NumbaError

from mesa_mobility.compiled.cache import kept_cfunc
from mesa_mobility.crowd.costs.kernel_arguments import (
    NUMBERS,
    Reads,
    arguments_of,
    check_fields_read,
    reads_of,
)
from mesa_mobility.crowd.costs.kernel_loops import (
    BOUND_LOOP,
    OPTION,
    OPTION_LOOP,
    PAIR_LOOP,
    PAIRS_LOOP,
    WALL_LOOP,
    me_of,
    numbers_of,
    other_of,
    rows_of,
)
from mesa_mobility.crowd.costs.layout import KERNEL_FIELDS
from mesa_mobility.crowd.costs.records import RECORDS
from mesa_mobility.errors import ModelError

_F = types.float64
FLOATS = types.CPointer(_F)
_N = types.int64
INTS = types.CPointer(_N)
_ROWS = (FLOATS, _N)
"""An array of several rows: its first number, and the length of a row."""

_PERSON = (FLOATS, INTS, FLOATS)
"""The pedestrian, the rows of their fields, and the numbers of the term."""


class CostKernel:
    """A function that is compiled with a loop around it when its address is first needed.

    Attributes:
        function: the function itself. In Python it takes records, and the term as ``p``.
        arguments: names of the records that it takes, in its order.
        numbers: names of the term's attributes that it reads by ``p``.
        fields: names of the fields of people that are laid out for it.
        of_others: names of those among them that it reads of neighbours.
        kinds: the class of each record; those of people also have the fields that it asks for.
    """

    records: ClassVar[tuple[str, ...]]
    loop: ClassVar[str]
    signature: ClassVar[Any]

    def __init__(self, function: Callable[..., float], fields: Sequence[str] = ()) -> None:
        if isinstance(fields, str) or len(set(fields)) != len(fields):
            raise ModelError(f"kernel {function.__name__}: fields {fields!r}, expected their names")
        self.function = function
        self.arguments = arguments_of(function, self.records)
        self.declared = tuple(fields)
        self.kinds: dict[str, Any] = dict(RECORDS)
        for name in ("me", "other"):
            own = RECORDS[name]._fields
            at_hand = next((field for field in fields if field in own), None)
            if at_hand is not None:
                raise ModelError(
                    f"kernel {function.__name__}: fields {fields!r}, expected none that people "
                    f"have in any model, such as {name}.{at_hand}"
                )
            if fields:
                self.kinds[name] = namedtuple(RECORDS[name].__name__, [*own, *fields])
        check_fields_read(function, self.arguments, self.declared)
        self.numbers = self._reads(NUMBERS).fields
        me, other = self._reads("me"), self._reads("other")
        known = (*KERNEL_FIELDS, *self.declared)
        self.of_others = tuple(name for name in known if name in other.fields or other.whole)
        self.fields = tuple(
            name
            for name in known
            if name in self.of_others
            or name in self.declared
            or (name != "core" and (name in me.fields or me.whole))
        )

    def _reads(self, name: str) -> Reads:
        return reads_of(self.function, name) if name in self.arguments else Reads((), False)

    def value(self, **records: Any) -> float:
        """What the function gives in Python.

        Args:
            records: all that it may ask for, by name; the term as ``p``.
        """
        return self.function(*(records[name] for name in self.arguments))

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """Itself: its machine code stays where it is."""
        return self

    @cached_property
    def _compiled(self) -> Any:
        return self._compile(self.loop, self.signature, "loop")

    def _compile(self, source: str, signature: Any, suffix: str) -> Any:
        try:
            # As in NumPy, a division by zero gives inf or nan, which the search refuses.
            return kept_cfunc(self._loop(source, suffix), signature, error_model="numpy")
        except NumbaError as error:
            unknown = re.search(r"Unknown attribute '(\w+)' of type (\w+)\(", str(error))
            if unknown is None:
                raise
            field, record = unknown.groups()
            raise ModelError(
                f"kernel {self.function.__name__}: no field {field!r} of {record.lower()}"
            ) from None

    def _loop(self, source: str, suffix: str) -> FunctionType:
        """A loop as if written in the function's own file, with which it is cached."""
        code = self.function.__code__
        name = f"{self.function.__name__}_{suffix}"
        space = {
            "each": njit(error_model="numpy")(self.function),
            "Numbers": namedtuple("Numbers", self.numbers),
            "__name__": self.function.__module__,
            **{kind.__name__: kind for kind in self.kinds.values()},
        }
        text = source.format(
            name=name,
            arguments=", ".join(self.arguments),
            option=OPTION,
            me=me_of(self.fields, self.declared),
            other=other_of(self.fields, self.declared, self.of_others),
            rows=rows_of(self.fields),
            p=numbers_of(self.numbers),
        )
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

    records = ("option", "me", NUMBERS)
    loop = OPTION_LOOP
    signature = types.void(_N, *_ROWS, *_PERSON, _F, FLOATS)


class BoundKernel(CostKernel):
    """Lower bound of the cost of a group of movement options."""

    records = ("options", "me", NUMBERS)
    loop = BOUND_LOOP
    signature = types.void(_N, *_ROWS, *_ROWS, *_PERSON, _F, FLOATS)


class PairKernel(CostKernel):
    """Cost of one movement option with respect to one neighbour.

    Two loops are compiled: over all neighbours of one option, and over a few neighbours and many
    options.
    """

    records = ("option", "me", "other", NUMBERS)
    loop = PAIR_LOOP
    signature = types.void(_N, *_ROWS, *_ROWS, *_PERSON, FLOATS)
    all_pairs: ClassVar[Any] = types.void(_N, INTS, _N, *_ROWS, *_ROWS, *_PERSON, _F, FLOATS)

    @cached_property
    def _compiled_pairs(self) -> Any:
        return self._compile(PAIRS_LOOP, self.all_pairs, "pairs")

    @property
    def pairs_address(self) -> int:
        """Address of the machine code of the loop over some neighbours and many options."""
        return int(self._compiled_pairs.address)


class WallKernel(CostKernel):
    """Cost of one movement option with respect to one wall."""

    records = ("option", "me", "wall", NUMBERS)
    loop = WALL_LOOP
    signature = types.float64(_N, *_ROWS, *_ROWS, *_PERSON)
