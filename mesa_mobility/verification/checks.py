"""Verdicts: measured figures against their criteria."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any


@dataclass(frozen=True)
class Check:
    """One figure and its criterion.

    Attributes:
        figure: name of the figure.
        value: measured value; None if nothing could be measured.
        wanted: the criterion, as text.
        met: whether the criterion is met.
        gates: whether the verdict depends on the check; otherwise the figure is only reported.
    """

    figure: str
    value: float | None
    wanted: str
    met: bool
    gates: bool = True


@dataclass(frozen=True)
class Verdict:
    """Result of a test.

    Attributes:
        checks: figures with a bound.
        figures: further figures, reported without one.
    """

    checks: tuple[Check, ...]
    figures: dict[str, Any] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether every check that gates is met; a verdict without one has not passed."""
        gating = [check for check in self.checks if check.gates]
        return bool(gating) and all(check.met for check in gating)

    @property
    def measured(self) -> dict[str, Any]:
        """All figures by name."""
        return {**{check.figure: check.value for check in self.checks}, **self.figures}


def within(
    figure: str, value: float | None, low: float, high: float, *, gates: bool = True
) -> Check:
    """low <= value <= high."""
    met = value is not None and low <= value <= high
    return Check(figure, value, f"{low:.4g} to {high:.4g}", met, gates)


def at_most(figure: str, value: float | None, high: float, *, gates: bool = True) -> Check:
    """value <= high."""
    met = value is not None and value <= high
    return Check(figure, value, f"at most {high:.4g}", met, gates)


def at_least(figure: str, value: float | None, low: float, *, gates: bool = True) -> Check:
    """value >= low."""
    met = value is not None and value >= low
    return Check(figure, value, f"at least {low:.4g}", met, gates)


def less_than(figure: str, value: float | None, high: float, *, gates: bool = True) -> Check:
    """value < high."""
    met = value is not None and value < high
    return Check(figure, value, f"less than {high:.4g}", met, gates)


def more_than(figure: str, value: float | None, low: float, *, gates: bool = True) -> Check:
    """value > low."""
    met = value is not None and value > low
    return Check(figure, value, f"more than {low:.4g}", met, gates)


def exactly(figure: str, value: float | None, wanted: float, *, gates: bool = True) -> Check:
    """value == wanted: for counts."""
    return Check(figure, value, f"{wanted:.4g}", value == wanted, gates)


def rising(
    figure: str, values: Sequence[float | None], *, strictly: bool = True, gates: bool = True
) -> Check:
    """Each value above the one before; the figure is the least step."""
    return _steps(figure, values, +1.0, strictly=strictly, gates=gates)


def falling(
    figure: str, values: Sequence[float | None], *, strictly: bool = True, gates: bool = True
) -> Check:
    """Each value below the one before; the figure is the least step down."""
    return _steps(figure, values, -1.0, strictly=strictly, gates=gates)


def _steps(
    figure: str, values: Sequence[float | None], sign: float, *, strictly: bool, gates: bool
) -> Check:
    numbers = [value for value in values if value is not None and math.isfinite(value)]
    wanted = "more than 0" if strictly else "at least 0"
    if len(numbers) < len(values) or len(numbers) < 2:
        return Check(figure, None, wanted, False, gates)
    least = min(sign * (b - a) for a, b in pairwise(numbers))
    return Check(figure, least, wanted, least > 0.0 if strictly else least >= 0.0, gates)
