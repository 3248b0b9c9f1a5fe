"""What the members of a file are: a declaration for each, and one checker for all.

Checkpoints, maps and pose banks hold arrays and numbers that compiled code trusts.  Each reader
declares them here, by name: type, shape, range, and what a number refers to.  Behaviours declare
their saved state in the same words (``Plugin.saved``).

Sizes have names.  ``Array("i8", ("people", 2), below="rows")`` has a row for each of the people,
and numbers of rows.  A name of a shape that is not known yet stands for the size that is found
first; ``"people+1"`` is one more.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import ChainMap
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ContentError, MobilityError

__all__ = [
    "Anything", "Array", "Each", "Either", "Flag", "Kind", "Maybe", "Members", "Object", "Real",
    "Records", "Several", "Sizes", "Text", "Whole", "check", "check_shape",
]  # fmt: skip

Sizes = Mapping[str, Any]
"""Numbers by name, and the texts that a ``Text`` may be."""

Size = int | str
"""A number, or the name of one."""

MOST = 2**53
"""Whole numbers beyond are no counts of anything."""


class Kind(ABC):
    """What a value may be."""

    @abstractmethod
    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Raise ContentError, of one line that begins with ``where``, unless the value fits."""


def check(
    value: Any,
    kind: Kind,
    where: str,
    sizes: Sizes | None = None,
    error: type[MobilityError] = ContentError,
) -> None:
    """Raise an error of one line unless a value is of a kind.

    Args:
        value: anything.
        kind: what it must be.
        where: what the value is called, for the error.
        sizes: what names of sizes stand for.
        error: what is raised.
    """
    try:
        kind.check(value, where, ChainMap({}, dict(sizes or {})))
    except ContentError as fault:
        raise error(str(fault)) from None


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
            _refuse(where, value, "true or false")


@dataclass(frozen=True)
class Text(Kind):
    """A text, one of those that ``sizes`` has by the name ``among`` if there is one."""

    among: str = ""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such texts."""
        if not isinstance(value, str):
            _refuse(where, value, "a text")
        known: Collection[str] = sizes[self.among] if self.among else (value,)
        if value not in known:
            _refuse(where, value, f"one of {', '.join(sorted(known)) or 'none'}")


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number from ``low`` to ``high``, and below a size."""

    low: int = 0
    high: int = MOST
    below: Size = ""

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such numbers."""
        high = self.high if self.below == "" else _size(self.below, sizes) - 1
        is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
        if not is_whole or not self.low <= value <= high:
            _refuse(where, value, f"a whole number, {self.low} to {high}")


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
        if not real or isinstance(value, bool) or not _in_range(np.float64(value), self):
            _refuse(where, value, f"a number, {_range(self)}")


@dataclass(frozen=True)
class Array(Kind):
    """An array of exactly this type and shape.

    Attributes:
        dtype: type of the numbers.
        shape: number, name or None (any) for each axis; None for any shape.
        low: least number.
        high: greatest number.
        below: size that whole numbers are below, instead of ``high``.
        infinite: whether numbers may be infinite.
        missing: whether numbers may be nan.
        rising: whether each number is greater than the one before.
    """

    dtype: str
    shape: tuple[Size | None, ...] | None = (None,)
    low: float = -math.inf
    high: float = math.inf
    below: Size = ""
    infinite: bool = False
    missing: bool = False
    rising: bool = False

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such arrays."""
        wanted = np.dtype(self.dtype)
        if not isinstance(value, np.ndarray) or value.dtype != wanted:
            found = value.dtype if isinstance(value, np.ndarray) else value
            _refuse(where, found, f"an array of {wanted}")
        if self.shape is not None:
            check_shape(value.shape, self.shape, where, sizes)
        self.check_numbers(value, where, sizes)

    def check_numbers(self, values: NDArray[Any], where: str, sizes: Sizes) -> None:
        """Refuse numbers out of range."""
        if values.dtype.kind in "biuf" and values.size:
            limits = self
            if self.below != "":
                high = _size(self.below, sizes) - 1
                limits = Array(self.dtype, low=self.low, high=high)
            # In pieces: large arrays must not need room for several copies.
            flat = values.reshape(-1) if values.flags.c_contiguous else values.ravel()
            for start in range(0, flat.size, _PIECE):
                fits = _in_range(flat[start : start + _PIECE], limits)
                if not fits.all():
                    at = start + int(np.argmin(fits))
                    index = ", ".join(map(str, np.unravel_index(at, values.shape)))
                    _refuse(f"{where}[{index}]", flat[at].item(), f"a number, {_range(limits)}")
        if self.rising and len(values) and not (values[1:] > values[:-1]).all():
            raise ContentError(f"{where}: goes back, expected rising numbers")


@dataclass(frozen=True)
class Records(Kind):
    """An array of records.

    Attributes:
        dtype: type of the records.
        fields: what each of their fields is, without its first axis.
        shape: as of ``Array``.
    """

    dtype: np.dtype[Any]
    fields: Mapping[str, Array]
    shape: tuple[Size | None, ...]

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such arrays."""
        if not isinstance(value, np.ndarray) or value.dtype != self.dtype:
            _refuse(where, getattr(value, "dtype", value), f"records of {self.fields.keys()}")
        check_shape(value.shape, self.shape, where, sizes)
        for name, kind in self.fields.items():
            kind.check_numbers(value[name], f"{where}, {name}", sizes)


@dataclass(frozen=True)
class Maybe(Kind):
    """None, or a value of a kind."""

    kind: Kind

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but these."""
        if value is not None:
            self.kind.check(value, where, sizes)


@dataclass(frozen=True)
class Either(Kind):
    """A value of one of two kinds."""

    one: Kind
    other: Kind

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but these; the error is that of the other kind."""
        try:
            self.one.check(value, where, sizes)
        except ContentError:
            self.other.check(value, where, sizes)


@dataclass(frozen=True)
class Object(Kind):
    """An object of a class."""

    kind: type

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all others."""
        if not isinstance(value, self.kind):
            _refuse(where, value, f"a {self.kind.__name__}")


@dataclass(frozen=True)
class Several(Kind):
    """A list, tuple, set or frozenset, or the keys of a dictionary, of values of one kind.

    Attributes:
        kind: of each.
        of: class of the collection.
        length: how many there are.
        values: for a dictionary, what its values are.
    """

    kind: Kind
    of: type[Any] = list
    length: Size | None = None
    values: Kind = Anything()

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such collections."""
        if not isinstance(value, self.of):
            _refuse(where, value, f"a {self.of.__name__}")
        if self.length is not None:
            check_shape((len(value),), (self.length,), where, sizes)
        for k, each in enumerate(value):
            self.kind.check(each, f"{where}[{k}]", sizes)
            if isinstance(value, dict):
                self.values.check(value[each], f"{where}[{each!r:.40}]", sizes)


class Each(Kind):
    """A tuple or list with one value of each kind, in order, whose arrays share sizes."""

    def __init__(self, *kinds: Kind, of: type[Any] = tuple) -> None:
        self.kinds, self.of = kinds, of

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all others."""
        if not isinstance(value, self.of) or len(value) != len(self.kinds):
            _refuse(where, value, f"a {self.of.__name__} of {len(self.kinds)}")
        own = ChainMap({}, dict(sizes))
        for k, (each, kind) in enumerate(zip(value, self.kinds, strict=True)):
            kind.check(each, f"{where}[{k}]", own)


@dataclass(frozen=True)
class Members(Kind):
    """A dictionary with exactly these members, whose arrays share sizes."""

    kinds: Mapping[str, Kind]

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse others: members that are missing or unknown, or of another kind."""
        if not isinstance(value, Mapping):
            _refuse(where, value, "members by name")
        for what, names in (
            ("missing", self.kinds.keys() - value.keys()),
            ("unknown", value.keys() - self.kinds.keys()),
        ):
            if names:
                known = ", ".join(self.kinds) or "none"
                text = ", ".join(sorted(f"{name!r:.40}" for name in names))
                raise ContentError(f"{where}: {what} {text}, expected the members {known}")
        own = ChainMap({}, dict(sizes))
        for name, kind in self.kinds.items():
            kind.check(value[name], f"{where}, {name}", own)


def check_shape(
    found: tuple[int, ...], wanted: tuple[Size | None, ...], where: str, sizes: Sizes
) -> None:
    """Raise ContentError unless a shape is as wanted; names that are new get their sizes."""
    fits = len(found) == len(wanted)
    for got, size in zip(found, wanted, strict=False):
        if isinstance(size, str) and size not in sizes and size.isidentifier():
            assert isinstance(sizes, ChainMap)
            sizes.maps[0][size] = got
        fits = fits and (size is None or got == _size(size, sizes))
    if not fits:
        names = ", ".join("any" if s is None else str(_size(s, sizes)) for s in wanted)
        raise ContentError(f"{where}: shape {found}, expected ({names})")


_PIECE = 1 << 20


def _size(size: Size, sizes: Sizes) -> int:
    if isinstance(size, int):
        return size
    name, _, more = size.partition("+")
    found: int = sizes[name] + int(more or 0)
    return found


def _in_range(values: Any, limits: Real | Array) -> Any:
    fits = (values >= limits.low) & (values <= limits.high)
    if values.dtype.kind == "f":
        if not limits.infinite:
            fits &= np.isfinite(values) | np.isnan(values)
        else:
            fits |= np.isinf(values)
        if limits.missing:
            fits |= np.isnan(values)
    return fits


def _range(limits: Real | Array) -> str:
    more = [text for text, there in (("inf", limits.infinite), ("nan", limits.missing)) if there]
    return " or ".join([f"finite, {limits.low:g} to {limits.high:g}", *more])


def _refuse(where: str, value: Any, expected: str) -> NoReturn:
    text = " ".join(f"{value!r:.60}".split())
    raise ContentError(f"{where}: got {text}, expected {expected}")
