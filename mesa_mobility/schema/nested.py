"""Values that consist of others, and objects."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from mesa_mobility.errors import ContentError
from mesa_mobility.schema.numbers import Anything, Kind, Size, Sizes, check_shape, refuse

ANYTHING = Anything()


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
            refuse(where, value, f"a {self.kind.__name__}")


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
    values: Kind = ANYTHING

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Refuse all but such collections."""
        if not isinstance(value, self.of):
            refuse(where, value, f"a {self.of.__name__}")
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
            refuse(where, value, f"a {self.of.__name__} of {len(self.kinds)}")
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
            refuse(where, value, "members by name")
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
