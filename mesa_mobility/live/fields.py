"""Fields of a command, checked."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any, NoReturn

from mesa_mobility.errors import LiveError

_MISSING = object()
_LONGEST = 60
"""Characters of a value that a message repeats."""

MOST_PEOPLE = 2**31 - 1


class Fields:
    """The fields of a JSON object, each of which is taken once.

    Args:
        text: the object.

    Raises:
        LiveError: not a JSON object, or numbers that are not finite.
    """

    def __init__(self, text: str) -> None:
        try:
            values = json.loads(text, parse_constant=_refuse_constant)
        except (ValueError, RecursionError) as error:
            reason = " ".join(str(error).split())
            raise LiveError(f"command: not JSON ({reason}), expected an object") from None
        if not isinstance(values, dict):
            raise LiveError(f"command: got {shown(values)}, expected a JSON object")
        self._values: dict[str, Any] = values

    def take(self, name: str, default: Any = _MISSING) -> Any:
        """The value of a field.

        Raises:
            LiveError: the field is missing, and has no default.
        """
        value = self._values.pop(name, default)
        if value is _MISSING:
            raise LiveError(f"{name}: missing, expected it in the command")
        return value

    def peek(self, name: str) -> Any:
        """The value of a field, which is not taken; None where it is missing."""
        return self._values.get(name)

    def number(self, name: str, default: Any = _MISSING) -> Any:
        """A finite number as a float, or the default."""
        value = self.take(name, default)
        return value if value is default else _number(name, value)

    def pair(self, name: str) -> tuple[float, float]:
        """Two finite numbers."""
        return _pair(name, self.take(name))

    def pairs(self, name: str) -> list[tuple[float, float]]:
        """A list of one or more pairs of finite numbers."""
        return self.each(name, _pair)

    def each(self, name: str, read: Callable[[str, Any], Any]) -> list[Any]:
        """A list of one or more values, each read by a function."""
        value = self.take(name)
        if not isinstance(value, list) or not value:
            _refuse(name, value, "a list of one or more values")
        return [read(name, one) for one in value]

    def text(self, name: str, default: Any = _MISSING) -> Any:
        """A text, or the default."""
        value = self.take(name, default)
        return value if value is default else text_of(name, value)

    def level(self) -> int | None:
        """The number of a level; None where there is no such field."""
        value = self.take("level", None)
        if value is not None and (not isinstance(value, int) or isinstance(value, bool)):
            _refuse("level", value, "the number of a level")
        return value

    def people(self) -> list[int]:
        """Numbers of one or more people: the field ``person``, or ``people`` for several."""
        if "person" in self._values:
            return [_whole("person", self.take("person"))]
        return list(dict.fromkeys(self.each("people", _whole)))

    def none_left(self) -> None:
        """Raise LiveError if a field has not been taken."""
        for name in self._values:
            raise LiveError(f"{shown(name)}: unknown field of this command")


def text_of(name: str, value: Any) -> str:
    """The value, which must be a text."""
    if not isinstance(value, str):
        _refuse(name, value, "a text")
    return value


def shown(value: Any) -> str:
    """A value as a message repeats it: on one line, and not all of a long one."""
    text = json.dumps(value)
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "..."


def _number(name: str, value: Any) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if math.isfinite(number):
            return number
    _refuse(name, value, "a number")


def _pair(name: str, value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        _refuse(name, value, "two numbers")
    return _number(name, value[0]), _number(name, value[1])


def _whole(name: str, value: Any) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= MOST_PEOPLE:
        _refuse(name, value, "the number of a person")
    return value


def _refuse(name: str, value: Any, expected: str) -> NoReturn:
    raise LiveError(f"{name}: got {shown(value)}, expected {expected}")


def _refuse_constant(name: str) -> NoReturn:
    raise LiveError(f"command: has {name}, expected finite numbers")
