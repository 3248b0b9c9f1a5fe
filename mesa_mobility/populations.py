"""Walking speeds of populations, from published data that ship with their source."""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.distributions import Normal
from mesa_mobility.errors import ModelError

_WITHIN = 3.0
"""Standard deviations from the mean beyond which nobody is drawn: 0.3 % of a normal curve."""


def walking_speed(ages: ArrayLike, rng: np.random.Generator) -> NDArray[np.float64]:
    """Free walking speed of people of these ages, m/s.

    Mean and standard deviation are those of Weidmann (1993), as RiMEA shows them in its test 7,
    linear between the ages given there; speeds are normal about the mean, cut off at three
    deviations.

    Args:
        ages: (n,) years, 3 to 80.
        rng: drawn from.

    Raises:
        ModelError: an age that the curve does not have.
    """
    years = np.asarray(ages, dtype=np.float64)
    age, mean, sd = _weidmann()
    if years.ndim != 1 or not ((years >= age[0]) & (years <= age[-1])).all():
        raise ModelError(f"ages: expected a row of {age[0]:g} to {age[-1]:g} years")
    standard = Normal(0.0, 1.0, -_WITHIN, _WITHIN).draw(len(years), rng)
    return np.interp(years, age, mean) + standard * np.interp(years, age, sd)


@cache
def _weidmann() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Ages (years), mean speeds and their standard deviations (m/s)."""
    text = files("mesa_mobility").joinpath("data/weidmann_age_speed.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = [[float(cell) for cell in row] for row in csv.reader(lines[1:])]
    age, mean, sd = np.array(rows).T
    return age, mean, sd
