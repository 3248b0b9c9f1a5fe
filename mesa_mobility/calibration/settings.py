"""What a calibration is asked for: free numbers, distances, seeds, and how it searches."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.design.points import check_whole


@dataclass(frozen=True)
class Free:
    """A number that a calibration may change.

    Attributes:
        name: such as "headway.time" or "headway.weight".
        low: least value; by default that of the setting's range.
        high: greatest value; by default that of the setting's range, if it has one.
        start: the value at first; by default that of the preset.
        log: whether to search along the logarithm, for numbers whose size is unknown.

    Raises:
        ModelError: ``low`` not below ``high``, a start outside, or a logarithm of 0 or less.
    """

    name: str
    low: float | None = None
    high: float | None = None
    start: float | None = None
    log: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or "." not in self.name:
            raise ModelError(f"free: name {self.name!r:.60}, expected such as 'headway.time'")
        for what in ("low", "high", "start"):
            value = getattr(self, what)
            if value is not None and not (is_number(value) and math.isfinite(value)):
                raise ModelError(f"free: {what} of {self.name} is {value!r:.60}, expected a number")
        low, high, start = self.low, self.high, self.start
        if low is not None and high is not None:
            if low >= high:
                raise ModelError(f"free: {self.name} from {low} to {high}, expected a range")
            if start is not None and not low <= start <= high:
                raise ModelError(f"free: {self.name} starts at {start}, not in {low} to {high}")
            if self.log and low <= 0.0:
                raise ModelError(
                    f"free: {self.name} from {low} on has no logarithm, expected low > 0"
                )

    def place(self, value: float) -> float:
        """Where a value is between the bounds, 0 to 1."""
        low, high = self.bounds
        if self.log:
            low, high, value = math.log(low), math.log(high), math.log(value)
        return (value - low) / (high - low)

    def value(self, place: float) -> float:
        """The value at a place between the bounds, 0 to 1."""
        low, high = self.bounds
        share = min(max(float(place), 0.0), 1.0)
        if self.log:
            return min(max(low * (high / low) ** share, low), high)
        return min(max(low + share * (high - low), low), high)

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and greatest value of a number that has both."""
        assert self.low is not None
        assert self.high is not None
        return float(self.low), float(self.high)


@dataclass(frozen=True)
class Distance:
    """How far what was simulated is from what was measured.

    Attributes:
        function: called with both; gives a number, 0 or more. A function or class of a module, or a
            ``functools.partial`` of one.
        weight: factor in the sum that is made small, more than 0.
        name: for results; by default that of the function.

    Raises:
        ModelError: one of them is something else.
    """

    function: Callable[[Any, Any], float]
    weight: float = 1.0
    name: str = ""

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise ModelError(f"distances: got {self.function!r:.60}, expected a function")
        if not self.name:
            inner = getattr(self.function, "func", self.function)
            object.__setattr__(self, "name", getattr(inner, "__name__", type(inner).__name__))
        if not (is_number(self.weight) and 0.0 < self.weight < math.inf):
            raise ModelError(
                f"distances: weight of {self.name} is {self.weight!r:.60}, expected more than 0"
            )


@dataclass(frozen=True)
class HeldOut:
    """Measured data that a calibration does not see, and is judged by.

    Attributes:
        data: as for other scenarios.
    """

    data: Any


@dataclass(frozen=True)
class Seeds:
    """How many seeds each set of numbers is run with.

    All sets of one generation have the same seeds, so that they differ by their numbers alone. The
    next generation has new ones.

    Attributes:
        each: seeds of each set of numbers in a generation.
        held_out: seeds that judge what was found; the search has none of them.
        first: all seeds follow from this one.

    Raises:
        ModelError: a number that is out of range.
    """

    each: int = 1
    held_out: int = 5
    first: int = 0

    def __post_init__(self) -> None:
        check_whole("seeds: each", self.each, 1, math.inf, "1 or more")
        check_whole("seeds: held_out", self.held_out, 1, math.inf, "1 or more")
        check_whole("seeds: first", self.first, 0, math.inf, "0 or more")


@dataclass(frozen=True)
class Search:
    """How a calibration searches.

    Attributes:
        evaluations: sets of numbers that are tried, rounded up to whole generations. A calibration
            may be gone on with more of them.
        candidates: sets of numbers in a generation; by default 4 + 3 ln(n), of n free numbers.
        spread: standard deviation of the first candidates, as a share of each number's range.
        preset: where the search starts, and what holds of all that is not free: a name, a file, or
            a ``Preset``.
        max_seconds: simulated seconds at most, of models that are run by the calibration.
        time_limit: seconds of real time that a run may take; then its numbers count as bad.

    Raises:
        ModelError: a number that is out of range.
    """

    evaluations: int = 150
    candidates: int | None = None
    spread: float = 0.2
    preset: str | Path | Preset = "default"
    max_seconds: float | None = field(default=None)
    time_limit: float | None = field(default=None)

    def __post_init__(self) -> None:
        check_whole("search: evaluations", self.evaluations, 1, 10**6, "1 or more")
        if self.candidates is not None:
            check_whole("search: candidates", self.candidates, 4, 10**6, "4 or more")
        if not (is_number(self.spread) and 0.0 < self.spread <= 1.0):
            raise ModelError(
                f"search: spread is {self.spread!r:.60}, expected more than 0, at most 1"
            )
        for what in ("max_seconds", "time_limit"):
            value = getattr(self, what)
            if value is not None and not (is_number(value) and 0.0 < value < math.inf):
                raise ModelError(f"search: {what} is {value!r:.60}, expected seconds, or None")
