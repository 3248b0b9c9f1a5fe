"""Distributions that speeds and times are drawn from, built or read from a text.

A crowd is drawn in strata: its members share out the distribution among them, so that even a
small crowd has the spread of the distribution. Runs differ in which people are fast, not in how
many. SciPy is loaded when the first one is drawn.
"""

from __future__ import annotations

import inspect
import math
import os
import re
from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ModelError

__all__ = [
    "Clipped",
    "Constant",
    "Distribution",
    "Empirical",
    "Gamma",
    "LogNormal",
    "Normal",
    "Uniform",
    "Weibull",
    "parse",
]


class Distribution(ABC):
    """A distribution of numbers: seconds, or m/s.

    Examples:
        >>> import numpy as np
        >>> from mesa_mobility.distributions import Normal, Uniform, parse
        >>> rng = np.random.default_rng(1)
        >>> np.sort(Uniform(0.0, 4.0).draw(4, rng)).astype(int)  # one from each quarter
        array([0, 1, 2, 3])
        >>> parse("normal(1.34, 0.26)") == Normal(1.34, 0.26)
        True
    """

    @abstractmethod
    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares of the distribution lie, each in (0, 1)."""

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) draws, one from each of n equal parts of the distribution, in random order.

        One draw alone has the distribution itself. For draws that are independent of one another,
        as many single ones.
        """
        return self.quantile(strata(n, rng))


EXTREMES = (2.0**-54, 1.0 - 2.0**-53)
"""Least and greatest share of a distribution that is drawn."""


def strata(n: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """(n,) shares in (0, 1), one at random in each nth part, in random order.

    Latin hypercube sampling in one dimension (McKay, Beckman and Conover 1979, Technometrics 21:
    239-245).
    """
    share = (rng.permutation(n) + rng.random(n)) / max(n, 1)
    # 0 and 1, which rounding can give, have no quantile.
    return np.clip(share, *EXTREMES)


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


class Empirical(Distribution):
    """Values that were measured, each as likely as the others.

    Args:
        values: (k,) numbers.

    Raises:
        ModelError: none, or not finite.
    """

    def __init__(self, values: ArrayLike) -> None:
        try:
            self.values = np.array(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise ModelError("empirical: expected numbers") from None
        if self.values.ndim != 1 or not self.values.size or not np.isfinite(self.values).all():
            raise ModelError(
                f"empirical: shape {self.values.shape}, expected a row of finite numbers"
            )

    @classmethod
    def from_csv(cls, path: str | os.PathLike[str], column: str | int = 0) -> Empirical:
        """The values in a column of a CSV file with a header line; lines with # are left out.

        Args:
            path: the file.
            column: name of the column, or its number from 0 on.

        Raises:
            ModelError: the file cannot be read, has no such column, or other things than numbers.
        """
        import csv

        try:
            with Path(path).open(encoding="utf-8", newline="") as file:
                lines = csv.reader(line for line in file if line.strip() and line[0] != "#")
                header, *rows = ([cell.strip() for cell in row] for row in lines)
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise ModelError(f"{path}: cannot be read as CSV ({error})") from None
        except ValueError:
            raise ModelError(f"{path}: is empty, expected a header and a line of values") from None
        known = isinstance(column, int) or column in header
        at = column if isinstance(column, int) else header.index(column) if known else 0
        if not known or not 0 <= at < len(header):
            raise ModelError(f"{path}: no column {column!r}, expected one of {', '.join(header)}")
        try:
            return cls([float(row[at]) for row in rows])
        except (ValueError, IndexError):
            raise ModelError(f"{path}: column {column!r}, expected a number in each line") from None

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        at = (share * len(self.values)).astype(np.int64)
        return np.sort(self.values)[np.minimum(at, len(self.values) - 1)]

    def __repr__(self) -> str:
        return f"Empirical({len(self.values)} values)"


_BY_NAME: dict[str, type[Any]] = {
    kind.__name__.lower(): kind for kind in (Constant, Uniform, Normal, LogNormal, Weibull, Gamma)
}

FORMS = "a number, " + ", ".join(
    f"{name}({', '.join(each.name for each in fields(kind))})" for name, kind in _BY_NAME.items()
)
"""The texts that ``parse`` reads."""


def parse(text: str) -> Distribution:
    """The distribution that a text stands for, such as ``lognormal(3.44, 0.94)`` or ``12.5``.

    Names and the order of their numbers are those of the classes here; a number alone is a
    constant.

    Raises:
        ModelError: the text is none of these, or its numbers are out of range.
    """
    found = re.fullmatch(r"\s*(?:([A-Za-z]+)\s*\()?([^()]*?)(\))?\s*", text)
    kind = _BY_NAME.get((found[1] or "constant").lower()) if found else None
    if found is None or kind is None or bool(found[1]) != bool(found[3]):
        raise ModelError(f"distribution {text!r}: expected {FORMS}")
    try:
        numbers = [float(part) for part in found[2].split(",")]
        inspect.signature(kind).bind(*numbers)
    except (TypeError, ValueError):
        raise ModelError(f"distribution {text!r}: expected {FORMS}") from None
    made: Distribution = kind(*numbers)
    return made


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
