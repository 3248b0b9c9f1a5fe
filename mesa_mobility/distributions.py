"""Distributions that speeds and times are drawn from, built or read from a text.

Draws come from NumPy's generator; only bounded ones need SciPy's truncated distributions, which
are loaded when the first is drawn.
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


class Distribution(ABC):
    """A distribution of numbers: seconds, or m/s."""

    @abstractmethod
    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""


@dataclass(frozen=True)
class Constant(Distribution):
    """Always the same value.

    Raises:
        ModelError: it is not finite.
    """

    value: float

    def __post_init__(self) -> None:
        _check(self, _finite(self.value), "a finite value")

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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return rng.uniform(self.low, self.high, n)


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return _normal(self.mean, self.sd, self.low, self.high, n, rng)


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return np.clip(self.of.draw(n, rng), self.low, self.high)


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        low = math.log(self.low) if self.low > 0.0 else -math.inf
        drawn = np.exp(_normal(self.mu, self.sigma, low, math.log(self.high), n, rng))
        return np.clip(drawn, self.low, self.high)  # for the rounding of exp


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return self.scale * rng.weibull(self.shape, n)


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return rng.gamma(self.shape, self.scale, n)


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

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) independent draws."""
        return rng.choice(self.values, n)

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
    mean: float, sd: float, low: float, high: float, n: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    if sd == 0.0 or (low == -math.inf and high == math.inf):
        return rng.normal(mean, sd, n)
    from scipy.stats import truncnorm

    bounds = (low - mean) / sd, (high - mean) / sd
    drawn: NDArray[np.float64] = truncnorm.rvs(*bounds, mean, sd, size=n, random_state=rng)
    return np.clip(drawn, low, high)  # for rounding


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
