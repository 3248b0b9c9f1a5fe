"""Settings of behaviours: declared once, in an annotation, and checked whenever they are set.

A parameter of a constructor that has a ``Range`` or ``ListOf`` in its annotation is a setting, and
so is an attribute that a class annotates with one. An attribute of the same name takes what the
annotation allows, in the constructor and later on.
"""

from __future__ import annotations

import difflib
import inspect
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache, wraps
from numbers import Integral
from typing import Any, TypeVar, cast
from weakref import WeakKeyDictionary

import numpy as np

from mesa_mobility._numbers import is_number
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.parameters import (
    Parameter,
    descriptions,
    evaluated,
    parameter_of,
    parameters,
)
from mesa_mobility.plugins.registry import did_you_mean

Method = TypeVar("Method", bound=Callable[..., Any])

_DECLARED: WeakKeyDictionary[type, dict[str, Parameter]] = WeakKeyDictionary()

_BEING_MADE: set[int] = set()
"""Identities of the objects that take on their attributes just now."""

_MISSPELT = 0.85
"""How alike two names are of which one is a misspelling: "prefered_speed" is 0.97 of
"preferred_speed", "exit" 0.89 of "exits"."""

_LONGEST = 60
"""Characters of a value that a message repeats."""


def declared(kind: type) -> Mapping[str, Parameter]:
    """The settings of a class and those above it, in the order of its constructor.

    A parameter that a class below repeats without a range keeps the range.
    """
    if kind not in _DECLARED:
        found: dict[str, Parameter] = {}
        for each in reversed(kind.__mro__):
            for parameter in _own(each):
                above = found.get(parameter.name)
                if parameter.range is not None or parameter.entries is not None:
                    found[parameter.name] = parameter
                elif above is not None:
                    found[parameter.name] = replace(above, default=parameter.default)
        # A constructor without ranges may set its attributes to anything.
        order = list(_constructor(kind))
        _DECLARED[kind] = dict(
            sorted(found.items(), key=lambda item: [*order, item[0]].index(item[0]))
        )
    return _DECLARED[kind]


def _own(kind: type) -> Iterator[Parameter]:
    """What the body and the constructor of one class declare."""
    names = getattr(sys.modules.get(kind.__module__), "__dict__", {})
    for name, annotation in annotations_of(kind).items():
        default = vars(kind).get(name, inspect.Parameter.empty)
        yield parameter_of(name, evaluated(annotation, names), default)
    if "__init__" in vars(kind):
        yield from _constructor(kind).values()


def annotations_of(kind: type) -> Mapping[str, Any]:
    """The annotations in the body of one class, without those of the classes above."""
    return inspect.get_annotations(kind)


def _constructor(kind: type) -> dict[str, Parameter]:
    try:
        return parameters(kind)
    except (TypeError, ValueError):  # classes of extension modules have no signature
        return {}


def checked(parameter: Parameter, value: Any) -> Any:
    """A value as the setting takes it: a plain number, or a list of its own.

    Raises:
        ModelError: the value is out of range, or of another type.
    """
    if value is None and type(None) in parameter.kinds:
        return None
    if isinstance(value, Distribution) and Distribution in parameter.kinds:
        return value
    if parameter.entries is not None:
        return _entries(parameter, value)
    whole = float not in parameter.kinds
    number = _number(value, whole)
    if number is None or parameter.range is None or number not in parameter.range:
        kinds = ["a distribution"] * (Distribution in parameter.kinds)
        kinds += ["None"] * (type(None) in parameter.kinds)
        kinds += ["a whole number, " * whole + str(parameter.range)]
        raise ModelError(f"{parameter.name} {_shown(value)}, expected {', or '.join(kinds)}")
    return number


def _number(value: Any, whole: bool) -> float | None:
    """A number as Python's own, or None."""
    if not is_number(value) or (whole and not isinstance(value, Integral)):
        return None
    return int(value) if whole else float(value)


def _entries(parameter: Parameter, value: Any) -> list[Any] | tuple[Any, ...]:
    assert parameter.entries is not None
    kind = parameter.entries.kind
    expected = _listed(kind)
    if kind is str and isinstance(value, str):
        expected += f" such as [{value!r}]"
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        raise ModelError(f"{parameter.name} {_shown(value)}, expected {expected}")
    entries = list(value)
    for each in entries:
        if not isinstance(each, kind):
            raise ModelError(f"{parameter.name} has {_shown(each)}, expected {expected}")
    return tuple(entries) if parameter.entries.once else entries


def _listed(kind: type) -> str:
    return "a list of names" if kind is str else f"a list of {kind.__name__} objects"


def _shown(value: Any) -> str:
    """A value on one line, and not all of a long one."""
    text = repr(value.item() if isinstance(value, np.generic) else value)
    return " ".join(text.split())[:_LONGEST]


def check_fields(made: Any, what: str) -> None:
    """Check the settings of a frozen dataclass, from its ``__post_init__``.

    Raises:
        ModelError: one is out of range, or of another type.
    """
    for name, parameter in declared(type(made)).items():
        try:
            object.__setattr__(made, name, checked(parameter, getattr(made, name)))
        except ModelError as error:
            raise ModelError(f"{what}: {error}") from None


def making(method: Method) -> Method:
    """The method, during which its object may take on new attributes.

    Behaviours, which have ``check_settings``, refuse unknown names by a ModelError; models leave
    them to Python, as Mesa's do.
    """

    @wraps(method)
    def made(self: Any, *args: Any, **keywords: Any) -> Any:
        if id(self) in _BEING_MADE:
            return method(self, *args, **keywords)
        has_settings = hasattr(self, "check_settings")
        _BEING_MADE.add(id(self))
        try:
            result = method(self, *args, **keywords)
        except TypeError:
            if has_settings:
                _refuse_unknown(type(self), method, keywords)
            raise
        finally:
            _BEING_MADE.discard(id(self))
        if has_settings:
            self.check_settings()
        return result

    return cast("Method", made)


def _refuse_unknown(kind: type, method: Callable[..., Any], given: Iterable[str]) -> None:
    """Raise ModelError where a constructor was given a name that it does not take."""
    known = inspect.signature(method).parameters
    if any(each.kind is each.VAR_KEYWORD for each in known.values()):
        return
    for name in given:
        if name not in known:
            meant = did_you_mean(name, dict.fromkeys(list(known)[1:]))
            raise ModelError(f"{kind.__name__}: no setting {name!r}{meant}") from None


def being_made(thing: object) -> bool:
    """Whether an object is within a method that is ``making`` it."""
    return id(thing) in _BEING_MADE


def has_attribute(thing: object, name: str) -> bool:
    """Whether an object, its class or the annotations of the latter have an attribute."""
    kind = type(thing)
    return (
        name in vars(thing)
        or hasattr(kind, name)
        or any(name in annotations_of(each) for each in kind.__mro__)
    )


@lru_cache(maxsize=1024)
def near_miss(name: str, known: tuple[str, ...]) -> str | None:
    """The known name of which another one is a misspelling, or None.

    Much stricter than a suggestion: agents and models have attributes of their users' own.
    """
    return next(iter(difflib.get_close_matches(name, known, n=1, cutoff=_MISSPELT)), None)


def settings_text(kind: type) -> list[tuple[str, str, str, str]]:
    """Name, default, range and description of each setting of a class."""
    explained: dict[str, str] = {}
    for each in reversed(kind.__mro__):
        explained |= descriptions(each)
    rows = []
    for name, parameter in declared(kind).items():
        default = "" if parameter.default is inspect.Parameter.empty else _shown(parameter.default)
        takes = str(parameter.range)
        if parameter.entries is not None:
            takes = _listed(parameter.entries.kind)
        rows.append((name, default, takes, explained.get(name, "")))
    return rows
