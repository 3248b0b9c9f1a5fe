"""The figures by which crowds are compared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.stats import wasserstein_distance

from mesa_mobility.results.distances.functional import (
    projection_coefficient,
    relative_difference,
    secant_cosine,
)
from mesa_mobility.results.distances.samples import (
    densities,
    distance_headways,
    dwell_times,
    lane_orders,
    speeds,
)
from mesa_mobility.results.distances.seen import Seen
from mesa_mobility.results.measures.motion import (
    accelerations,
    speed_jumps,
)

FloatArray = NDArray[np.float64]
Statistic = Callable[[FloatArray], float]

DENSITY_BIN = 0.25
"""Bins of individual density as the reference tables have them, persons/m2."""
DENSEST = 6.0
LEAST_IN_BIN = 20


@dataclass(frozen=True)
class Figure:
    """A figure of a crowd, and how far two crowds are apart in it.

    Attributes:
        name: of the figure.
        unit: of its values and of its distance.
        needs: attributes of a ``View`` that must be given.
        measure: the figure of a run: (n,) a sample, or a curve at points that all runs have.
        statistic: name of the one number that a table shows of it, and what computes it.
        curve: whether ``measure`` gives a curve.
    """

    name: str
    unit: str
    needs: tuple[str, ...]
    measure: Callable[[Seen], FloatArray]
    statistic: tuple[str, Statistic]
    curve: bool = False

    def number(self, values: FloatArray) -> float:
        """The one number that a table shows of a sample or curve."""
        return self.statistic[1](values)

    def pooled(self, runs: Sequence[FloatArray]) -> FloatArray:
        """One figure of several runs: samples together, the mean of curves."""
        if not self.curve:
            return np.concatenate(runs) if runs else np.empty(0)
        return nanmean(self.table(runs))

    def table(self, runs: Sequence[FloatArray]) -> FloatArray:
        """(runs, n) curves of one length."""
        longest = max((len(run) for run in runs), default=0)
        filled = np.full((len(runs), longest), np.nan)
        for row, run in zip(filled, runs, strict=True):
            row[: len(run)] = run
        return filled

    def distance(self, simulated: FloatArray, measured: FloatArray) -> float:
        """How far two figures are apart, in ``unit``.

        Curves: root of the mean square of their difference where both are known. Samples: the
        Wasserstein distance, by how much values have to be shifted on average to make one sample
        of the other. Not a number if there is nothing to compare.
        """
        if self.curve:
            one, other = self.table([simulated, measured])
            both = np.isfinite(one) & np.isfinite(other)
            return float(np.sqrt(np.mean((one - other)[both] ** 2))) if both.any() else np.nan
        if not len(simulated) or not len(measured):
            return np.nan
        return float(wasserstein_distance(simulated, measured))


@dataclass(frozen=True)
class Agreement:
    """A number that says how alike two curves are, not a figure of one crowd.

    Attributes:
        name: of the number.
        compare: computes it from a measured and a simulated curve.
        perfect: its value for equal curves.
    """

    name: str
    compare: Callable[[FloatArray, FloatArray], FloatArray]
    perfect: float
    needs: ClassVar[tuple[str, ...]] = ("line",)

    def measure(self, run: Seen) -> FloatArray:
        """The curve of a run: seconds at which people left, in order."""
        return run.passing_times

    def number(self, simulated: FloatArray, measured: FloatArray) -> float:
        """The number; only people that both runs have count, in the order in which they left."""
        n = min(len(simulated), len(measured))
        if n < 2:
            return np.nan
        return float(self.compare(measured[:n], simulated[:n]))


def nanmean(table: FloatArray) -> FloatArray:
    """(n,) mean over rows of the values that are known; not a number where none is."""
    known = np.isfinite(table)
    with np.errstate(invalid="ignore"):
        return np.where(known, table, 0.0).sum(axis=0) / known.sum(axis=0)


def n_t(run: Seen) -> FloatArray:
    """(seconds,) people who have crossed the line by each second."""
    seconds = np.arange(int(run.duration + 1e-9) + 1)
    return np.searchsorted(run.passing_times, seconds + 1e-9, side="right").astype(np.float64)


def speed_by_density(run: Seen) -> FloatArray:
    """(24,) median speed in bins of individual density of 0.25 persons/m2 that hold 20 or more."""
    number = np.floor(run.moving["density"].to_numpy() / DENSITY_BIN).astype(np.int64)
    speed = run.moving["speed"].to_numpy()
    bins = round(DENSEST / DENSITY_BIN)
    found = np.full(bins, np.nan)
    for k in range(bins):
        here = speed[number == k]
        if len(here) >= LEAST_IN_BIN:
            found[k] = np.median(here)
    return found


def _sd(values: FloatArray) -> float:
    return float(values.std()) if len(values) else np.nan


def _percentile(p: float) -> Statistic:
    def number(values: FloatArray) -> float:
        return float(np.percentile(values, p)) if len(values) else np.nan

    return number


def _mean(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else np.nan


def _last(curve: FloatArray) -> float:
    return float(curve[-1]) if len(curve) else np.nan


MOTION = ("direction", "area")
FLOW = ("line",)
FIELD = ("direction", "area", "floor")
SD, P99, MEDIAN, MEAN = (
    ("sd", _sd),
    ("p99", _percentile(99)),
    ("median", _percentile(50)),
    ("mean", _mean),
)

FIGURES = (
    Figure("n_t", "persons", FLOW, n_t, ("last", _last), curve=True),
    Figure("time_headway", "s", FLOW, lambda run: np.diff(run.passing_times), MEAN),
    Figure("speed", "m/s", ("area",), lambda run: speeds(run.tracks, run.view), MEAN),
    Figure("density", "1/m2", MOTION, lambda run: densities(run.moments, run.view), MEAN),
    Figure("speed_density", "m/s", FIELD, speed_by_density, MEAN, curve=True),
    Figure("density_profile", "1/m2", FIELD, lambda run: run.profiles[0], MEAN, curve=True),
    Figure("speed_profile", "m/s", FIELD, lambda run: run.profiles[1], MEAN, curve=True),
    Figure("dwell_time", "s", ("area",), lambda run: dwell_times(run.tracks, run.view), MEDIAN),
    Figure("distance_headway", "m", MOTION, lambda run: distance_headways(run.moments), MEDIAN),
    Figure("lane_order", "1", MOTION, lambda run: lane_orders(run.moments), MEAN),
    Figure("direction_change", "deg", MOTION, lambda run: np.degrees(run.steps.turns), SD),
    Figure("lateral_step", "m", MOTION, lambda run: run.steps.across, SD),
    Figure("speed_change", "m/s", MOTION, lambda run: run.steps.speed_changes, SD),
    Figure(
        "acceleration",
        "m/s2",
        ("area",),
        lambda run: accelerations(run.tracks, selection=run.selection),
        P99,
    ),
    Figure(
        "speed_jump",
        "m/s",
        ("area",),
        lambda run: speed_jumps(run.tracks, selection=run.selection),
        P99,
    ),
)
"""Figures of one crowd."""

AGREEMENTS = (
    Agreement("erd", relative_difference, 0.0),
    Agreement("epc", projection_coefficient, 1.0),
    Agreement("sc", secant_cosine, 1.0),
)
"""Numbers of two evacuation curves: the time at which each person left, in order."""
