"""Distributions given by a few parameters."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.distributions.base import Distribution
from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Constant(Distribution):
    """Always the same value.

    Raises:
        ModelError: it is not finite.
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
        return _normal(self.mean, self.sd, self.low, self.high, share)


@dataclass(frozen=True)
class Clipped(Distribution):
    """Another distribution whose values beyond ``low`` and ``high`` count as these bounds.

    Raises:
        ModelError: bounds in the wrong order, or something else than a distribution.
    """

    of: Distribution
    low: float
    high: float

    def __post_init__(self) -> None:
        _check(self, isinstance(self.of, Distribution), "a distribution")
        _check(self, _ordered(self.low, self.high), "low <= high")

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        return np.clip(self.of.quantile(share), self.low, self.high)


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
        values = np.exp(_normal(self.mu, self.sigma, low, math.log(self.high), share))
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


def _normal(
    mean: float, sd: float, low: float, high: float, share: NDArray[np.float64]
) -> NDArray[np.float64]:
    values: NDArray[np.float64]
    if sd == 0.0 or (low == -math.inf and high == math.inf):
        from scipy.special import ndtri

        values = mean + sd * ndtri(share)
        return values
    from scipy.stats import truncnorm

    values = truncnorm.ppf(share, (low - mean) / sd, (high - mean) / sd, mean, sd)
    return np.clip(values, low, high)  # for rounding


def _finite(*values: float) -> bool:
    return all(isinstance(value, Real) and math.isfinite(value) for value in values)


def _ordered(low: float, high: float) -> bool:
    return isinstance(low, Real) and isinstance(high, Real) and bool(low <= high)


def _check(of: Distribution, holds: bool, expected: str) -> None:
    if not holds:
        raise ModelError(f"distribution {of!r}: expected {expected}")


def _check_positive(of: Any) -> None:
    values = [getattr(of, each.name) for each in fields(of)]
    _check(of, _finite(*values) and min(values) > 0.0, "finite numbers above 0")
