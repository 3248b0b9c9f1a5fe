"""Distributions given by a few parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.distributions.base import Distribution
from mesa_mobility.distributions.truncation import (
    normal_before_cut,
    normal_quantile,
    widest,
)
from mesa_mobility.errors import ModelError

_WIDEST = 0.999
"""Share of the widest deviation that is accepted: the widest is not normal, but exponential."""


@dataclass(frozen=True)
class Constant(Distribution):
    """Always the same value.

    Raises:
        ModelError: the value is not finite.
    """

    value: float

    def __post_init__(self) -> None:
        _check(self, _finite(self.value), "a finite value")

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) times the value."""
        return np.full(len(share), float(self.value))

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) times the value; nothing is drawn from the generator."""
        return np.full(n, float(self.value))


@dataclass(frozen=True)
class Uniform(Distribution):
    """Every value from ``low`` to ``high`` alike.

    Raises:
        ModelError: bounds that are not finite or in the wrong order.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        _check(self, _finite(self.low, self.high) and self.low <= self.high, "finite low <= high")

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        return self.low + (self.high - self.low) * share


@dataclass(frozen=True)
class Normal(Distribution):
    """The normal distribution, cut off at ``low`` and ``high``.

    ``mean`` and ``sd`` are those before it is cut.

    Raises:
        ModelError: not finite, a negative deviation, or bounds that leave nothing.
    """

    mean: float
    sd: float
    low: float = -math.inf
    high: float = math.inf

    def __post_init__(self) -> None:
        _check(self, _finite(self.mean, self.sd) and self.sd >= 0.0, "a finite mean and sd >= 0")
        _check(self, _ordered(self.low, self.high) and self.low < self.high, "low < high")
        if self.sd == 0.0:
            _check(self, self.low <= self.mean <= self.high, "a mean within the bounds")

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        return normal_quantile(self.mean, self.sd, self.low, self.high, share)


@dataclass(frozen=True)
class TruncatedNormal(Distribution):
    """The normal distribution within ``low`` and ``high`` that has this mean and deviation there.

    Published figures are those of people who were measured, none of whom was beyond the bounds:
    ``mean`` and ``sd`` are what is left after the cut, where those of ``Normal`` are before it.

    Raises:
        ModelError: not finite, a deviation that is not positive, a mean outside the bounds, or a
            deviation that no normal distribution has within them; the message says which has.
    """

    mean: float
    sd: float
    low: float
    high: float

    def __post_init__(self) -> None:
        _check(self, _finite(self.mean, self.sd) and self.sd > 0.0, "a finite mean and sd > 0")
        _check(
            self,
            _ordered(self.low, self.high) and self.low < self.mean < self.high,
            "low < mean < high",
        )
        most = _WIDEST * widest(self.mean, self.low, self.high)
        _check(self, self.sd <= most, f"an sd of at most {most:.4g} in these bounds")

    @classmethod
    def nearest(cls, mean: float, sd: float, low: float, high: float) -> TruncatedNormal:
        """The one with this mean whose deviation is ``sd``, or as much of it as the bounds allow.

        Few people who were measured may have a greater deviation than any normal distribution
        has between the slowest and the fastest of them. The greatest is rounded down to six
        decimals: versions of SciPy differ in the last bits, and runs must not.

        Raises:
            ModelError: as the class, but for the deviation.
        """
        if _finite(mean, low, high) and low < mean < high:
            sd = min(sd, math.floor(1e6 * _WIDEST * widest(mean, low, high)) / 1e6)
        return cls(mean, sd, low, high)

    @property
    def uncut(self) -> Normal:
        """The distribution as ``Normal`` gives it, by mean and deviation before the cut."""
        mean, sd = normal_before_cut(self.mean, self.sd, self.low, self.high)
        return Normal(mean, sd, self.low, self.high)

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        return self.uncut.quantile(share)


@dataclass(frozen=True)
class LogNormal(Distribution):
    """The log-normal distribution, cut off at ``low`` and ``high``.

    ``mu`` and ``sigma`` are mean and standard deviation of the logarithm, as IMO MSC.1/Circ.1533
    gives response times: ``LogNormal(3.44, 0.94, 0, 300)`` by day.

    Raises:
        ModelError: not finite, a deviation that is not positive, or bounds that leave nothing.
    """

    mu: float
    sigma: float
    low: float = 0.0
    high: float = math.inf

    def __post_init__(self) -> None:
        _check(self, _finite(self.mu, self.sigma) and self.sigma > 0.0, "finite mu and sigma > 0")
        _check(self, _ordered(0.0, self.low) and self.low < self.high, "0 <= low < high")

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        low = math.log(self.low) if self.low > 0.0 else -math.inf
        values = np.exp(normal_quantile(self.mu, self.sigma, low, math.log(self.high), share))
        return np.clip(values, self.low, self.high)  # for the rounding of exp


@dataclass(frozen=True)
class Weibull(Distribution):
    """The Weibull distribution: 1 - exp(-(x / scale)^shape) lie below x.

    Raises:
        ModelError: a parameter that is not finite and positive.
    """

    scale: float
    shape: float

    def __post_init__(self) -> None:
        _check_positive(self)

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        return self.scale * (-np.log1p(-share)) ** (1.0 / self.shape)


@dataclass(frozen=True)
class Gamma(Distribution):
    """The gamma distribution, with mean ``shape`` times ``scale``.

    Raises:
        ModelError: a parameter that is not finite and positive.
    """

    shape: float
    scale: float

    def __post_init__(self) -> None:
        _check_positive(self)

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        from scipy.special import gammaincinv

        values: NDArray[np.float64] = self.scale * gammaincinv(self.shape, share)
        return values


def _finite(*values: float) -> bool:
    return all(is_number(value) and math.isfinite(value) for value in values)


def _ordered(low: float, high: float) -> bool:
    return is_number(low) and is_number(high) and bool(low <= high)


def _check(of: Distribution, holds: bool, expected: str) -> None:
    if not holds:
        raise ModelError(f"distribution {of!r}: expected {expected}")


def _check_positive(of: Any) -> None:
    values = [getattr(of, each.name) for each in fields(of)]
    _check(of, _finite(*values) and min(values) > 0.0, "finite numbers above 0")
