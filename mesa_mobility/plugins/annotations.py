"""Annotations of the parameters of models and of the settings of behaviours."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Range:
    """The range of a number: ``people: Annotated[int, Range(1, 500)] = 60``.

    Of a model's parameter it is the range of a slider. The field beside the slider takes other
    values as well; the model may refuse them. Of a behaviour's setting it is what the behaviour
    accepts: ``time: Annotated[float, Range(0, unit="s", above=True)] = 1.2``.

    Attributes:
        low: least value.
        high: greatest value; None for any, and then there is no slider.
        unit: of the number, such as "m", "s" or "m/s".
        above: whether a setting must be more than ``low``.
        below: whether a setting must be less than ``high``.
        endless: whether a setting may also be ``math.inf``.

    Raises:
        ModelError: a bound that is not finite, or ``low`` not below ``high``.
    """

    low: float
    high: float | None = None
    unit: str = ""
    above: bool = False
    below: bool = False
    endless: bool = False

    def __post_init__(self) -> None:
        high = self.low + 1.0 if self.high is None else self.high
        if not (math.isfinite(self.low) and math.isfinite(high) and self.low < high):
            raise ModelError(f"Range: got {self.low} to {self.high}, expected a low and a high end")

    def __contains__(self, value: float) -> bool:
        if not math.isfinite(value):
            return value == math.inf and self.endless
        if value < self.low or (self.above and value == self.low):
            return False
        return self.high is None or value < self.high or (value == self.high and not self.below)

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        low, high = f"{self.low:g}", f"{self.high:g}{unit}" if self.high is not None else ""
        if self.high is None:
            text = f"more than {low}{unit}" if self.above else f"{low}{unit} or more"
        elif self.above or self.below:
            text = f"more than {low}" if self.above else f"{low} or more"
            text += f" and less than {high}" if self.below else f" and at most {high}"
        else:
            text = f"{low} to {high}"
        return f"{text}, or inf" if self.endless else text


@dataclass(frozen=True)
class ListOf:
    """A setting that is a list: ``exits: Annotated[Iterable[str], ListOf(str)] = ()``.

    The behaviour keeps a list of its own.

    Attributes:
        kind: class of the entries.
        once: whether the list is set when the behaviour is made, and never again, as a tuple.
    """

    kind: type
    once: bool = False


@dataclass(frozen=True, init=False)
class Files:
    """The files that a page offers: ``plan: Annotated[Path | None, Files("*.csv")] = None``.

    Args:
        patterns: shell patterns of the file names.
    """

    patterns: tuple[str, ...]

    def __init__(self, *patterns: str) -> None:
        object.__setattr__(self, "patterns", patterns)
