"""Names of a model's numbers: `headway.time` is the setting `time` of the behaviour `headway`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from mesa_mobility.crowd.costs.terms import MOST_WEIGHT, CostTerm
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.annotations import Range
from mesa_mobility.plugins.parameters import Parameter
from mesa_mobility.plugins.registry import BEHAVIORS, did_you_mean, installed, load_behavior
from mesa_mobility.plugins.settings import checked, declared

WEIGHT = "weight"
"""The name of a term's weight among its settings."""

OPTIONS = "options"
"""What the numbers of movement options go by, as no behaviour is called."""

CODE, COMMAND_LINE, EXPERIMENT = "code", "command line", "experiment"
"""Sources of numbers that neither a preset nor a behaviour has."""

_WEIGHT = Parameter(WEIGHT, (float,), 1.0, Range(-MOST_WEIGHT, MOST_WEIGHT))

MOST_ACCELERATION = Parameter(
    "most_acceleration",
    (type(None), float),
    None,
    Range(0.0, unit="m/s2", above=True),
)

MOST_ACCELERATION_NAME = f"{OPTIONS}.{MOST_ACCELERATION.name}"


@dataclass(frozen=True)
class ModelParameter:
    """One number of a model.

    Attributes:
        name: the behaviour and the setting, such as "headway.time" or "headway.weight".
        value: the number, or None or a distribution where the setting takes them.
        unit: such as "s"; empty for a number without one.
        bounds: what it may be.
        source: where the value comes from: "preset default", the file of a preset, "command line",
            "code", or "behaviour" for what a file leaves as the behaviour has it.
    """

    name: str
    value: Any
    unit: str
    bounds: Range
    source: str

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.name} = {self.shown}{unit} ({self.source})"

    @property
    def shown(self) -> str:
        """The value as a text, without its unit: a number with six digits, "none" for None."""
        if isinstance(self.value, int | float):
            return f"{self.value:g}"
        return "none" if self.value is None else f"{self.value}"


def numbers_of(kind: type[Plugin]) -> dict[str, Parameter]:
    """The numbers of a behaviour by their names within it: its weight, and settings in a range."""
    weight = {WEIGHT: _WEIGHT} if issubclass(kind, CostTerm) else {}
    settings = declared(kind)
    return weight | {name: each for name, each in settings.items() if each.range is not None}


def named(behaviours: Iterable[Plugin]) -> Iterator[tuple[str, Plugin, Parameter]]:
    """Name, behaviour and declaration of each number, in the order of the behaviours.

    A term for some types of people alone has their names in brackets: `headway[child].time`.
    """
    for each in behaviours:
        types = each.for_types if isinstance(each, CostTerm) else None
        label = each.name if types is None else f"{each.name}[{','.join(types)}]"
        for name, parameter in numbers_of(type(each)).items():
            yield f"{label}.{name}", each, parameter


def as_value(name: str, parameter: Parameter | None, value: Any) -> Any:
    """A value as a number of this name takes it; a text stands for one, as with `--set`.

    Args:
        name: of the number.
        parameter: its declaration; without one the value is not checked.
        value: for it.

    Raises:
        ModelError: it is out of range, or of another kind.
    """
    if parameter is None:
        with suppress(ValueError):
            return float(value) if isinstance(value, str) else value
        return value
    try:
        if isinstance(value, str):
            value = parameter.convert(value)
        return checked(parameter, value)
    except ModelError as error:
        text = str(error).removeprefix(parameter.name).lstrip(": ")
        raise ModelError(f"{name}: {text}") from None


def number_named(name: str) -> Parameter | None:
    """The declaration of a number, or None if its behaviour is not installed.

    Behaviours of one's own need not be installed, so that one that is not is refused only if its
    name is nearly that of one that is.

    Raises:
        ModelError: a misspelt behaviour, or one without such a number.
    """
    behaviour, _, setting = name.partition(".")
    behaviour = behaviour.partition("[")[0]
    if behaviour == OPTIONS:
        known = {MOST_ACCELERATION.name: MOST_ACCELERATION}
    elif behaviour in (there := installed(BEHAVIORS)):
        known = numbers_of(load_behavior(behaviour))
    elif did_you_mean(behaviour, there):
        raise unknown(name, [f"{each}.{setting}" for each in (*there, OPTIONS)])
    else:
        return None
    if setting not in known:
        raise unknown(name, [f"{behaviour}.{each}" for each in known])
    return known[setting]


def unknown(name: str, known: Iterable[str]) -> ModelError:
    """The error of a name that no number has, with the nearest one or those of the behaviour."""
    names = dict.fromkeys(known)
    meant = did_you_mean(name, names)
    if not meant:
        behaviour = name.partition(".")[0]
        own = [each for each in names if each.partition(".")[0] == behaviour]
        labels = dict.fromkeys(each.partition(".")[0] for each in names)
        meant = f", expected one of {', '.join(own)}" if own else f", there are {', '.join(labels)}"
    return ModelError(f"unknown parameter {name!r}{meant}")


def is_number_name(name: str) -> bool:
    """Whether this names a number of a behaviour, and not an argument of a constructor."""
    return "." in name
