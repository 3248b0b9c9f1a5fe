"""Walking speeds of populations, from published data that ship with their source."""

from __future__ import annotations

import csv
import math
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.distributions import strata
from mesa_mobility.errors import ModelError

WITHIN = 3.0
"""Standard deviations from the mean beyond which nobody is drawn: 0.3 % of a normal curve."""


def walking_speed(
    ages: ArrayLike, rng: np.random.Generator, fastest: float = math.inf
) -> NDArray[np.float64]:
    """Free walking speed of people of these ages, m/s.

    Mean and standard deviation are those of Weidmann (1993), as RiMEA shows them in its test 7,
    linear between the ages given there; speeds are normal about the mean, cut off at three
    deviations and at what bodies can do. How far the people given are from their mean is drawn in
    strata, as from any `Distribution`.

    Args:
        ages: (n,) years, 3 to 80.
        rng: drawn from.
        fastest: speed beyond which nobody is drawn, m/s.

    Raises:
        ModelError: an age that the curve does not have, or ``fastest`` below a mean of the curve.
    """
    years = np.asarray(ages, dtype=np.float64)
    age, mean, sd = _weidmann()
    if years.ndim != 1 or not ((years >= age[0]) & (years <= age[-1])).all():
        raise ModelError(f"ages: expected a row of {age[0]:g} to {age[-1]:g} years")
    from scipy.stats import truncnorm  # takes a second to load

    means, deviations = np.interp(years, age, mean), np.interp(years, age, sd)
    if not (fastest >= means).all():
        raise ModelError(f"fastest: {fastest} m/s, expected at least the mean, {means.max():.2f}")
    most = np.minimum((fastest - means) / deviations, WITHIN)
    off = truncnorm.ppf(strata(len(years), rng), -WITHIN, most)
    return np.minimum(means + deviations * off, fastest)  # for rounding


@cache
def _weidmann() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Ages (years), mean speeds and their standard deviations (m/s)."""
    text = files("mesa_mobility").joinpath("data/weidmann_age_speed.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = [[float(cell) for cell in row] for row in csv.reader(lines[1:])]
    age, mean, sd = np.array(rows).T
    return age, mean, sd
