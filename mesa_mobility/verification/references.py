"""Figures measured in published experiments; `data/README.md` says from which and how."""

from __future__ import annotations

import csv
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

BOTTLENECK_FIT = (2.233, -0.155)
"""Slope and intercept of flow (1/s) against width (m), pooled over eight studies, 0.7 to 3 m."""

BOTTLENECK_TOLERANCE = 0.7
"""Two standard deviations of single runs about the fit, 1/s."""

STAIR_SPEEDS = {
    False: ((0.33, -1.02, 1.39), (-0.11, 0.29), (-0.08, 0.67), (-0.06, 0.14)),
    True: ((0.18, -0.55, 1.02), (-0.14, 0.35), (0.01, 0.48), (-0.02, 0.10)),
}
"""Down and up: fast speed on stairs, its standard deviation, slow speed and its standard deviation,
m/s, each a polynomial of the density (Corbetta, read from a program that uses it)."""

STAIR_DENSITIES = (0.6, 1.5)
"""Persons/m2 between which that program compares speeds."""


def table(name: str) -> list[dict[str, str]]:
    """Rows of a reference table, as text by column."""
    text = files("mesa_mobility.verification").joinpath("data", f"{name}.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


@cache
def columns(name: str) -> dict[str, FloatArray]:
    """The columns of a reference table that hold numbers."""
    rows = table(name)
    found = {}
    for key in rows[0]:
        try:
            found[key] = np.array([float(row[key]) for row in rows])
        except ValueError:
            continue
    return found


def corridor_band(density: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
    """p10, p50 and p90 of the speed along a corridor, m/s, at individual densities (1/m2)."""
    bins = columns("fd_corridor_individual_bins")
    at, wanted = bins["indiv_voronoi_density_1_m2"], np.asarray(density, dtype=np.float64)
    low, middle, high = (
        np.interp(wanted, at, bins[f"v_along_1p5s_{p}"]) for p in ("p10", "p50", "p90")
    )
    return low, middle, high


def stair_band(density: ArrayLike, *, up: bool) -> tuple[FloatArray, FloatArray]:
    """Least and greatest speed on stairs, m/s, at densities of 0.6 to 1.5 persons/m2 (Corbetta).

    They are the slow speed less its standard deviation, and the fast speed and its standard
    deviation. Above 1.5 persons/m2 the fast speed rises again.
    """
    at = np.asarray(density, dtype=np.float64)
    fast, fast_sd, slow, slow_sd = (np.polyval(each, at) for each in STAIR_SPEEDS[up])
    return slow - slow_sd, fast + fast_sd


def bottleneck_fit(width: float) -> float:
    """Flow through a bottleneck of this width (m), persons a second: a fit to measured flows."""
    return BOTTLENECK_FIT[0] * width + BOTTLENECK_FIT[1]


def bottleneck_envelope(width: float) -> tuple[float, float]:
    """Least and greatest flow measured at openings of this width (m), persons a second."""
    bins = columns("bottleneck_flow_envelope")
    return (
        float(np.interp(width, bins["width_m"], bins["flow_min"])),
        float(np.interp(width, bins["width_m"], bins["flow_max"])),
    )


def published(experiment: str) -> dict[str, FloatArray]:
    """Area-averaged fundamental diagram of one of the sets of `fd_juelich_published`."""
    rows = [row for row in table("fd_juelich_published") if row["set"].startswith(experiment)]
    if not rows:
        raise KeyError(experiment)
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0] if key != "set"}


def speed_by_age(ages: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean walking speed and its standard deviation, m/s, at ages in years (Weidmann 1993)."""
    text = files("mesa_mobility").joinpath("data", "weidmann_age_speed.csv").read_text("utf-8")
    lines = [line for line in text.splitlines() if line[:1].isdigit()]
    age, mean, sd = np.array([[float(cell) for cell in line.split(",")] for line in lines]).T
    return np.interp(ages, age, mean), np.interp(ages, age, sd)
