"""Single values: flags, texts and numbers; and the sizes that declarations name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import ChainMap
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn, Protocol

import numpy as np

from mesa_mobility.errors import ContentError

Sizes = Mapping[str, Any]
"""Numbers by name, and the texts that a ``Text`` may be."""

Size = int | str
"""A number, or the name of one."""

MOST = 2**53
"""Whole numbers beyond are no counts of anything."""


class Limits(Protocol):
    """What ranges of numbers have in common."""

    @property
    def low(self) -> float:
        """Least number."""

    @property
    def high(self) -> float:
        """Greatest number."""

    @property
    def infinite(self) -> bool:
        """Whether numbers may be infinite."""

    @property
    def missing(self) -> bool:
        """Whether numbers may be nan."""


class Kind(ABC):
    """What a value may be."""

    @abstractmethod
    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Raise ContentError, of one line that begins with ``where``, unless the value fits."""


@dataclass(frozen=True)
class Anything(Kind):
    """Any value: its reader checks it."""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Nothing is refused."""


@dataclass(frozen=True)
class Flag(Kind):
    """True or false."""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but true and false."""
        if not isinstance(value, bool | np.bool_):
            refuse(where, value, "true or false")


@dataclass(frozen=True)
class Text(Kind):
    """A text, one of those that ``sizes`` has by the name ``among`` if there is one."""

    among: str = ""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such texts."""
        if not isinstance(value, str):
            refuse(where, value, "a text")
        known: Collection[str] = sizes[self.among] if self.among else (value,)
        if value not in known:
            refuse(where, value, f"one of {', '.join(sorted(known)) or 'none'}")


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number from ``low`` to ``high``, and below a size."""

    low: int = 0
    high: int = MOST
    below: Size = ""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such numbers."""
        high = self.high if self.below == "" else size_of(self.below, sizes) - 1
        is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
        if not is_whole or not self.low <= value <= high:
            refuse(where, value, f"a whole number, {self.low} to {high}")


@dataclass(frozen=True)
class Real(Kind):
    """A number from ``low`` to ``high``, or one that is ``infinite``, or ``missing`` (nan)."""

    low: float = -1e9
    high: float = 1e9
    infinite: bool = False
    missing: bool = False

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such numbers."""
        real = isinstance(value, int | float | np.integer | np.floating)
        if isinstance(value, int) and abs(value) > MOST:  # more than a float can be, perhaps
            real = False
        if not real or isinstance(value, bool) or not in_range(np.float64(value), self):
            refuse(where, value, f"a number, {range_text(self)}")


def check_shape(
    found: tuple[int, ...], wanted: tuple[Size | None, ...], where: str, sizes: Sizes
) -> None:
    """Raise ContentError unless a shape is as wanted; names that are new get their sizes."""
    fits = len(found) == len(wanted)
    for got, size in zip(found, wanted, strict=False):
        if isinstance(size, str) and size not in sizes and size.isidentifier():
            assert isinstance(sizes, ChainMap)
            sizes.maps[0][size] = got
        fits = fits and (size is None or got == size_of(size, sizes))
    if not fits:
        names = ", ".join("any" if s is None else str(size_of(s, sizes)) for s in wanted)
        raise ContentError(f"{where}: shape {found}, expected ({names})")


def size_of(size: Size, sizes: Sizes) -> int:
    """The number that a size stands for."""
    if isinstance(size, int):
        return size
    name, _, more = size.partition("+")
    found: int = sizes[name] + int(more or 0)
    return found


def in_range(values: Any, limits: Limits) -> Any:
    """Which of some numbers are within limits."""
    fits = (values >= limits.low) & (values <= limits.high)
    if values.dtype.kind == "f":
        if not limits.infinite:
            fits &= np.isfinite(values) | np.isnan(values)
        else:
            fits |= np.isinf(values)
        if limits.missing:
            fits |= np.isnan(values)
    return fits


def range_text(limits: Limits) -> str:
    """Limits as a message says them."""
    more = [text for text, there in (("inf", limits.infinite), ("nan", limits.missing)) if there]
    return " or ".join([f"finite, {limits.low:g} to {limits.high:g}", *more])


def refuse(where: str, value: Any, expected: str) -> NoReturn:
    """Raise ContentError: what was found where, and what was expected."""
    text = " ".join(f"{value!r:.60}".split())
    raise ContentError(f"{where}: got {text}, expected {expected}")
