"""Populations: which types of people a crowd is made of, and speeds by age.

Figures come from published data that ship with their source.
"""

from __future__ import annotations

import csv
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.distributions import TruncatedNormal
from mesa_mobility.distributions.base import strata
from mesa_mobility.distributions.truncation import normal_quantile
from mesa_mobility.errors import ModelError

ROUNDING = 1e-6
"""By how much shares may miss 1."""

WITHIN = 3.0
"""Standard deviations from the mean beyond which nobody is drawn: 0.3 % of a normal curve."""

OFF_CURVE = TruncatedNormal(0.0, 1.0, -WITHIN, WITHIN)
"""How many standard deviations somebody is faster than the mean of their age."""


@dataclass(frozen=True, eq=False)
class Population:
    """Which types of people a crowd is made of, and in which shares.

    Attributes:
        shares: share of each type, 0 to 1, adding up to 1. A type is given as a
            ``PedestrianType``, or as the name of a map that comes with the package. Types whose
            share is 0 are left out.
        source: where the shares come from.

    Raises:
        ModelError: no shares, one out of range, or shares that do not add up to 1.

    Examples:
        >>> from mesa_mobility.populations import Population, presets
        >>> Population({"able_bodied": 0.9, "wheelchair_manual": 0.1})
        Population(able_bodied: 0.9, wheelchair_manual: 0.1)
        >>> sorted(presets())
        ['care_home', 'every_type', 'mixed']
        >>> print(Population.of("mixed").shares["child"])
        0.22
    """

    shares: Mapping[Any, float]
    source: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.shares, Mapping):
            raise ModelError(
                f"population: got {self.shares!r}, expected a share for each type, such as "
                '{"able_bodied": 0.9, "child": 0.1}'
            )
        for kind, share in self.shares.items():
            if not (is_number(share) and 0.0 <= share <= 1.0):
                raise ModelError(
                    f"population: the share of {_name(kind)!r} is {share!r}, expected 0 to 1"
                )
        kept = {kind: float(share) for kind, share in self.shares.items() if share > 0.0}
        names = [_name(kind) for kind in kept]
        for kind, name in zip(kept, names, strict=True):
            if not isinstance(kind, str) and not hasattr(kind, "mobility_map"):
                raise ModelError(f"population: {kind!r}, expected names of types")
            if names.count(name) > 1:
                raise ModelError(f"population: two types {name!r}, expected each once")
        total = math.fsum(kept.values())
        if abs(total - 1.0) > ROUNDING:
            raise ModelError(f"population: the shares add up to {total:.6g}, expected 1")
        object.__setattr__(self, "shares", kept)

    @classmethod
    def of(cls, value: Population | Mapping[Any, float] | str) -> Population:
        """A population from what a parameter may be given as.

        Args:
            value: a population; shares by type; or a text: the name of one of ``presets()``, the
                name of a type, for everybody, or shares, ``"able_bodied: 0.9, child: 0.1"``.

        Raises:
            ModelError: none of these.
        """
        if isinstance(value, Population):
            return value
        if not isinstance(value, str):
            return cls(value)
        if ":" not in value:
            name = value.strip()
            if not name.isidentifier():
                raise ModelError(f"population {value!r}: expected {_forms()}")
            return presets()[name] if name in presets() else cls({name: 1.0})
        return cls(dict(_parts(value)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the types."""
        return tuple(_name(kind) for kind in self.shares)

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """(n,) which type each of n people is of, as its index in ``shares``, in random order.

        Each type gets its share of n, rounded up or down: the people are drawn at equal distances
        along the shares, from a random start (systematic sampling; W. G. Madow, Annals of
        Mathematical Statistics 20, 1949). If there is a single type, nothing is drawn from the
        generator.
        """
        if len(self.shares) == 1:
            return np.zeros(n, dtype=np.int64)
        bounds = np.cumsum(list(self.shares.values()))[:-1]
        at = (rng.permutation(n) + rng.random()) / max(n, 1)
        return np.searchsorted(bounds, at, side="right").astype(np.int64)

    def __repr__(self) -> str:
        return f"Population({self})"

    def __str__(self) -> str:
        return ", ".join(f"{_name(kind)}: {share:g}" for kind, share in self.shares.items())


def _name(kind: Any) -> str:
    return kind if isinstance(kind, str) else getattr(kind, "name", repr(kind))


def _parts(text: str) -> Iterator[tuple[str, float]]:
    """Types and shares of a text such as ``able_bodied: 0.9, child: 0.1``."""
    seen: set[str] = set()
    for part in text.split(","):
        name, colon, share = (each.strip() for each in part.partition(":"))
        try:
            value = float(share)
        except ValueError:
            colon = ""
            value = 0.0
        if not (name and colon) or name in seen:
            raise ModelError(f"population {text!r}: got {part.strip()!r}, expected {_forms()}")
        seen.add(name)
        yield name, value


@cache
def presets() -> Mapping[str, Population]:
    """Populations by name; their ``source`` says where the shares come from.

    ``mixed`` is the public at large, ``care_home`` the residents, staff and visitors of a care
    home, ``every_type`` has equal shares of all types that come with the package.
    """
    text = files("mesa_mobility").joinpath("data/populations.toml").read_text("utf-8")
    found = {}
    for name, each in tomllib.loads(text).items():
        total = sum(each["people"].values())
        shares = {kind: people / total for kind, people in each["people"].items()}
        found[name] = Population(shares, " ".join(each["source"].split()))
    return MappingProxyType(found)


def _forms() -> str:
    return (
        f"{', '.join(presets())}, the name of a type, or shares such as "
        "'able_bodied: 0.9, child: 0.1'"
    )


def walking_speed(
    ages: ArrayLike, rng: np.random.Generator, fastest: float = math.inf
) -> NDArray[np.float64]:
    """Free walking speed of people of these ages, m/s.

    Mean and standard deviation are those of Weidmann (1993), as RiMEA shows them in its test 7,
    linear between the ages given there; speeds are normal about the mean within three deviations
    of it (`OFF_CURVE`). How far the people given are from their mean is drawn in strata, as from
    any `Distribution`.

    Args:
        ages: (n,) years, 3 to 80.
        rng: drawn from.
        fastest: speed beyond which nobody is drawn, m/s. The speeds of the others stay as likely
            as they were, so that the mean of those ages whose curve reaches it is lower.

    Raises:
        ModelError: an age that the curve does not have, or ``fastest`` below a mean of the curve.
    """
    years = np.asarray(ages, dtype=np.float64)
    age, mean, sd = _weidmann()
    if years.ndim != 1 or not ((years >= age[0]) & (years <= age[-1])).all():
        raise ModelError(f"ages: expected a row of {age[0]:g} to {age[-1]:g} years")
    means, deviations = np.interp(years, age, mean), np.interp(years, age, sd)
    if not (fastest >= means).all():
        raise ModelError(f"fastest: {fastest} m/s, expected at least the mean, {means.max():.2f}")
    most = np.minimum((fastest - means) / deviations, WITHIN)
    uncut = OFF_CURVE.uncut
    off = normal_quantile(uncut.mean, uncut.sd, -WITHIN, most, strata(len(years), rng))
    return np.minimum(means + deviations * off, fastest)  # for rounding


@cache
def _weidmann() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Ages (years), mean speeds and their standard deviations (m/s)."""
    text = files("mesa_mobility").joinpath("data/weidmann_age_speed.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = [[float(cell) for cell in row] for row in csv.reader(lines[1:])]
    age, mean, sd = np.array(rows).T
    return age, mean, sd
