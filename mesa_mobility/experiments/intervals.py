"""Confidence intervals of what repeated runs tell."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Estimate:
    """An estimate and its confidence interval; None where there are too few values for it.

    Attributes:
        value: the estimate.
        low: lower end of the interval.
        high: upper end of the interval.
    """

    value: float | None
    low: float | None = None
    high: float | None = None

    @property
    def half_width(self) -> float | None:
        """The greater distance of an end of the interval from the estimate."""
        if self.value is None or self.low is None or self.high is None:
            return None
        return max(self.value - self.low, self.high - self.value)


def mean_interval(values: ArrayLike, confidence: float = 0.95) -> Estimate:
    """Mean of independent values, with the interval of Student's t.

    Args:
        values: (n,) values; those that are not finite are left out.
        confidence: between 0 and 1.

    Returns:
        The estimate; without an interval where there are fewer than two values.

    Raises:
        ModelError: a confidence out of range.
    """
    check_confidence(confidence)
    known = _finite(values)
    if len(known) < 2:
        return Estimate(float(known[0]) if len(known) else None)
    from scipy.special import stdtrit

    mean = float(known.mean())
    error = float(known.std(ddof=1)) / math.sqrt(len(known))
    half = float(stdtrit(len(known) - 1, (1 + confidence) / 2)) * error
    return Estimate(mean, mean - half, mean + half)


def quantile_interval(values: ArrayLike, q: float, confidence: float = 0.95) -> Estimate:
    """Quantile of independent values, with an interval between two of them.

    How many of n values lie below the quantile is binomial, whatever their distribution. The
    interval reaches from one value in order to another such that the quantile lies between them
    with at least the confidence asked for. Source: W. J. Conover, Practical Nonparametric
    Statistics, 3rd ed., 1999, section 3.2.

    Args:
        values: (n,) values; those that are not finite are left out.
        q: between 0 and 1.
        confidence: between 0 and 1.

    Returns:
        The estimate; without an interval where no pair of values has the confidence.

    Raises:
        ModelError: a quantile or a confidence out of range.
    """
    check_confidence(confidence)
    if not 0 < q < 1:
        raise ModelError(f"quantile {q!r}, expected a number between 0 and 1")
    known = np.sort(_finite(values))
    if not len(known):
        return Estimate(None)
    from scipy.stats import binom

    value = float(np.quantile(known, q))
    n, half = len(known), (1 - confidence) / 2
    low, high = int(binom.ppf(half, n, q)), int(binom.ppf(1 - half, n, q)) + 1
    if low < 1 or high > n:
        return Estimate(value)
    return Estimate(value, float(known[low - 1]), float(known[high - 1]))


def runs_for_quantile(q: float, confidence: float) -> int:
    """Values that ``quantile_interval`` needs: the quantile lies beyond all of them too rarely."""
    return math.ceil(math.log((1 - confidence) / 2) / math.log(max(q, 1 - q)))


def check_confidence(confidence: float) -> None:
    """Raise ModelError unless a confidence is between 0 and 1."""
    if not (isinstance(confidence, int | float) and 0 < confidence < 1):
        raise ModelError(f"confidence is {confidence!r}, expected a number between 0 and 1")


def _finite(values: ArrayLike) -> NDArray[np.float64]:
    numbers = np.asarray(values, dtype=np.float64)
    return numbers[np.isfinite(numbers)]
