"""Confidence intervals of what repeated runs tell."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.results.measures.times import quantile_of_times


@dataclass(frozen=True)
class Estimate:
    """An estimate and its confidence interval; None where there are too few values for it.

    Attributes:
        value: the estimate, or None where it is not given.
        low: lower end of the interval.
        high: upper end of the interval; either is infinite where it lies among the runs that have
            not reached the figure.
        runs: number of runs from which the estimate is made.
        not_reached: number of these runs that have no value.
        beyond: the greatest value reached, where the estimate lies among those not reached.
    """

    value: float | None
    low: float | None = None
    high: float | None = None
    runs: int = 0
    not_reached: int = 0
    beyond: float | None = None

    @property
    def half_width(self) -> float | None:
        """The greater distance of an end of the interval from the estimate."""
        if self.value is None or self.low is None or self.high is None:
            return None
        return max(self.value - self.low, self.high - self.value)

    @property
    def hopeless(self) -> bool:
        """Whether there is no estimate, and more runs will not give one."""
        return self.value is None and (self.beyond is None or self.low == math.inf)

    def __str__(self) -> str:
        """The estimate and its interval, or why it is not given."""
        lacking = f"in {self.not_reached} of {self.runs}"
        if self.beyond is not None:
            return f"> {self.beyond:.4g}, not reached {lacking}"
        if self.value is None:
            return f"not given: {self.not_reached} of {self.runs} have none" if self.runs else "-"
        text = f"{self.value:.4g}"
        if self.low is not None and self.high is not None:
            high = f"{self.high:.4g}" if math.isfinite(self.high) else "not reached"
            text += f" ({self.low:.4g} to {high})"
        return f"{text}, not reached {lacking}" if self.not_reached else text


def mean_interval(values: ArrayLike, confidence: float = 0.95) -> Estimate:
    """Mean of independent values, with the interval of Student's t.

    Args:
        values: (n,) values; nan are left out, infinite ones have not been reached.
        confidence: between 0 and 1.

    Returns:
        The estimate; without an interval where there are fewer than two values. No mean is given
        where some value has not been reached: that of the others would be too small.

    Raises:
        ModelError: a confidence out of range.
    """
    check_confidence(confidence)
    known = _known(values)
    runs, not_reached = len(known), int(np.isinf(known).sum())
    if not_reached or not runs:
        return Estimate(None, runs=runs, not_reached=not_reached)
    if runs == 1:
        return Estimate(float(known[0]), runs=1)
    from scipy.special import stdtrit

    mean = float(known.mean())
    error = float(known.std(ddof=1)) / math.sqrt(runs)
    half = float(stdtrit(runs - 1, (1 + confidence) / 2)) * error
    return Estimate(mean, mean - half, mean + half, runs)


def quantile_interval(values: ArrayLike, q: float, confidence: float = 0.95) -> Estimate:
    """Quantile of independent values, with an interval between two of them.

    How many of n values lie below the quantile is binomial, whatever their distribution. The
    interval reaches from one value in order to another such that the quantile lies between them
    with at least the confidence asked for. Source: W. J. Conover, Practical Nonparametric
    Statistics, 3rd ed., 1999, section 3.2.

    Args:
        values: (n,) values; nan are left out, infinite ones have not been reached and are later
            than all others (right-censored).
        q: between 0 and 1.
        confidence: between 0 and 1.

    Returns:
        The estimate; without an interval where no pair of values has the confidence. No quantile
        is given that lies among those not reached.

    Raises:
        ModelError: a quantile or a confidence out of range.
    """
    check_confidence(confidence)
    if not 0 < q < 1:
        raise ModelError(f"quantile {q!r}, expected a number between 0 and 1")
    known = np.sort(_known(values))
    runs, reached = len(known), int(np.isfinite(known).sum())
    if not runs:
        return Estimate(None)
    from scipy.stats import binom

    value = quantile_of_times(known, q)
    beyond = float(known[reached - 1]) if value is None and reached else None
    half = (1 - confidence) / 2
    low, high = int(binom.ppf(half, runs, q)), int(binom.ppf(1 - half, runs, q)) + 1
    found = Estimate(value, None, None, runs, runs - reached, beyond)
    if low < 1 or high > runs:
        return found
    return replace(found, low=float(known[low - 1]), high=float(known[high - 1]))


def runs_for_quantile(q: float, confidence: float) -> int:
    """Values that ``quantile_interval`` needs: the quantile lies beyond all of them too rarely."""
    return math.ceil(math.log((1 - confidence) / 2) / math.log(max(q, 1 - q)))


def check_confidence(confidence: float) -> None:
    """Raise ModelError unless a confidence is between 0 and 1."""
    if not (isinstance(confidence, int | float) and 0 < confidence < 1):
        raise ModelError(f"confidence is {confidence!r}, expected a number between 0 and 1")


def _known(values: ArrayLike) -> NDArray[np.float64]:
    numbers = np.asarray(values, dtype=np.float64)
    return numbers[~np.isnan(numbers)]
