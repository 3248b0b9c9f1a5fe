"""How many runs are enough: intervals of figures, and convergence of the occupancy curve."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments.design.points import check_whole
from mesa_mobility.experiments.intervals import Estimate, check_confidence, runs_for_quantile
from mesa_mobility.experiments.observed import estimate
from mesa_mobility.results.distances.functional import (
    projection_coefficient,
    relative_difference,
    secant_cosine,
)

_FIGURE = re.compile(r"(?P<how>mean|p[1-9]\d?) (?P<column>\w+(\..+\.\w+)?)")
_GROWTH = 1.25
"""Factor by which replications grow: few looks at the data keep the intervals honest."""


@dataclass(frozen=True)
class OccupancyConvergence:
    """Functional convergence of the mean occupancy curve, measured run by run.

    With each run the mean curve changes. Three measures compare it with the mean curve before:
    the Euclidean relative difference, the Euclidean projection coefficient and the secant cosine,
    which are 0, 1 and 1 for equal curves. Source: E. Ronchi, P. A. Reneke and R. D. Peacock, A
    method for the analysis of behavioural uncertainty in evacuation modelling, Fire Technology 50
    (2014).

    Args:
        tolerance: largest difference of each measure from its value for equal curves.
        consecutive: number of runs, the last ones, for which that must hold.

    Raises:
        ModelError: a value out of range.
    """

    tolerance: float = 0.01
    consecutive: int = 10

    def __post_init__(self) -> None:
        if not (isinstance(self.tolerance, int | float) and 0 < self.tolerance < 1):
            raise ModelError(f"tolerance is {self.tolerance!r}, expected a number between 0 and 1")
        check_whole("consecutive", self.consecutive, 1, math.inf, "1 or more")


@dataclass(frozen=True)
class Precision:
    """What ``replications="auto"`` goes on for: figures known to a tolerance.

    Args:
        figures: such as "mean egress_s" or "p95 egress_s": the mean or a percentile of a column of
            the store over the replications of a point.
        tolerance: greatest half-width of each confidence interval, as a share of the figure.
        confidence: of the intervals.
        least: replications of each point at least.
        most: replications of each point at most.
        occupancy: convergence of the occupancy curve that is asked for as well, or None.

    Raises:
        ModelError: a value out of range, a figure that is none, nothing asked for, or a percentile
            that takes more runs than there may be.
    """

    figures: tuple[str, ...] = ("mean egress_s", "p95 egress_s")
    tolerance: float = 0.05
    confidence: float = 0.95
    least: int = 20
    most: int = 1000
    occupancy: OccupancyConvergence | None = field(default_factory=OccupancyConvergence)

    def __post_init__(self) -> None:
        if not isinstance(self.figures, list | tuple):
            raise ModelError(f"figures is {self.figures!r}, expected a list")
        object.__setattr__(self, "figures", tuple(self.figures))
        if not self.figures and self.occupancy is None:
            raise ModelError("figures: got none, and no occupancy; expected one of them or more")
        for figure in self.figures:
            check_figure(figure)
        if not (isinstance(self.tolerance, int | float) and 0 < self.tolerance < 1):
            raise ModelError(f"tolerance is {self.tolerance!r}, expected a number between 0 and 1")
        check_confidence(self.confidence)
        check_whole("least", self.least, 2, math.inf, "2 or more")
        check_whole("most", self.most, self.least, math.inf, f"{self.least} (least) or more")
        for figure in self.figures:
            how = figure.split(" ", 1)[0]
            if (
                how != "mean"
                and (needed := runs_for_quantile(int(how[1:]) / 100, self.confidence)) > self.most
            ):
                raise ModelError(
                    f"most is {self.most}, but an interval of {how} at {self.confidence:.4g} takes "
                    f"{needed} runs"
                )

    @property
    def columns(self) -> list[str]:
        """Columns of the store that the figures are of."""
        return list(dict.fromkeys(figure.split(" ", 1)[1] for figure in self.figures))

    def next_count(self, count: int) -> int:
        """Replications to have after ``count``."""
        return self.least if count < self.least else min(math.ceil(count * _GROWTH), self.most)

    def last_look(self, count: int) -> int:
        """The greatest number of replications, up to ``count``, at which precision is assessed.

        Precision is assessed only at the numbers that ``next_count`` gives.  At any other number,
        the result would depend on where runs were interrupted.  A ``count`` below ``least`` is
        returned as it is.
        """
        if count < self.least:
            return count
        look = self.least
        while look < (following := self.next_count(look)) <= count:
            look = following
        return look

    def look_before(self, count: int) -> int:
        """The number of replications that was looked at before ``count`` of them, or 0."""
        return self.last_look(count - 1) if count > self.least else 0

    def definition(self) -> dict[str, Any]:
        """What a file says of it."""
        curve = self.occupancy
        return {
            "figures": list(self.figures),
            "tolerance": self.tolerance,
            "confidence": self.confidence,
            "least": self.least,
            "most": self.most,
            "occupancy": False
            if curve is None
            else {"tolerance": curve.tolerance, "consecutive": curve.consecutive},
        }


@dataclass(frozen=True)
class Assessment:
    """What is known of a point after so many runs.

    Attributes:
        runs: replications that count: the first ones, without a gap, up to a number at which
            results are looked at.
        estimates: estimate and interval of each figure.
        met: whether each figure is known well enough; "occupancy" stands for the curve.
        without_curve: runs that have not failed and have no curve of their own.
    """

    runs: int
    estimates: dict[str, Estimate]
    met: dict[str, bool]
    without_curve: int = 0

    @property
    def enough(self) -> bool:
        """Whether everything asked for is known well enough."""
        return all(self.met.values())

    @property
    def hopeless(self) -> bool:
        """Whether no run has some figure, or more runs make nothing known that is not."""
        lost = {name for name, known in self.estimates.items() if known.hopeless}
        if self.without_curve:
            lost.add("occupancy")
        unknown = {name for name, met in self.met.items() if not met}
        return self.unseen or (bool(unknown) and unknown <= lost)

    @property
    def unseen(self) -> bool:
        """Whether no run has some figure, as where all of them fail."""
        return any(known.runs == known.not_reached for known in self.estimates.values())


def check_figure(figure: Any) -> None:
    """Raise ModelError unless ``figure`` reads like "mean egress_s" or "p95 door.east.last_s".

    Percentiles are p1 to p99. Whether the column exists is not checked.
    """
    if not (isinstance(figure, str) and _FIGURE.fullmatch(figure)):
        raise ModelError(
            f'figure {figure!r}: expected one such as "mean egress_s" or "p95 egress_s"'
        )


def assess(
    precision: Precision,
    runs: int,
    values: Mapping[str, NDArray[np.float64]],
    curves: Sequence[Sequence[int] | None],
) -> Assessment:
    """What the runs of a point tell.

    The interval of a mean that becomes known with the last runs, and not with the first ones, is
    the one asked for: the mean plus and minus the tolerance. Its own one is too narrow, since runs
    end when they happen to scatter little. Sources: Y. S. Chow and H. Robbins, On the asymptotic
    theory of fixed-width sequential confidence intervals for the mean, Annals of Mathematical
    Statistics 36 (1965) 457-462; A. Nadas for tolerances that are a share of the mean, ibid. 40
    (1969) 667-671.

    Args:
        precision: what is asked for.
        runs: replications, failed ones included.
        values: by column, (runs,) values in the order of replications, as ``observed`` has them.
        curves: people inside each second, by run in the same order, without those that failed; None
            for a run that has none since it took too long. The mean curve of the others would be
            that of the quick ones, so it is not known then.
    """
    estimates, met = {}, {}
    before = precision.look_before(runs)
    for figure in precision.figures:
        column = values.get(figure.split(" ", 1)[1], np.empty(0))
        found = estimate(figure, column, precision.confidence)
        met[figure] = _is_known(precision, found)
        if met[figure] and before and figure.startswith("mean "):
            sooner = estimate(figure, column[:before], precision.confidence)
            if not _is_known(precision, sooner):
                assert found.value is not None
                half = precision.tolerance * abs(found.value)
                found = replace(found, low=found.value - half, high=found.value + half)
        estimates[figure] = found
    known = [curve for curve in curves if curve is not None]
    without = len(curves) - len(known)
    if precision.occupancy is not None:
        met["occupancy"] = not without and converged(precision.occupancy, known)
    return Assessment(runs, estimates, met, without)


def _is_known(precision: Precision, found: Estimate) -> bool:
    half, value = found.half_width, found.value
    return half is not None and value is not None and half <= precision.tolerance * abs(value)


def converged(asked: OccupancyConvergence, curves: Sequence[Sequence[int]]) -> bool:
    """Whether the mean curve has converged with the last of the runs."""
    if len(curves) < asked.consecutive + 1:
        return False
    steps = functional_changes(mean_curves(curves)[-asked.consecutive - 1 :])
    return bool(np.all(np.abs(steps - [0.0, 1.0, 1.0]) <= asked.tolerance))


def mean_curves(curves: Sequence[Sequence[int]]) -> NDArray[np.float64]:
    """(n, seconds): the mean curve of the first run, of the first two, and so on.

    Shorter curves go on with their last value.
    """
    seconds = max((len(curve) for curve in curves), default=0)
    filled = np.array(
        [[*curve, *[curve[-1]] * (seconds - len(curve))] for curve in curves], dtype=np.float64
    )
    return np.cumsum(filled, axis=0) / np.arange(1, len(filled) + 1)[:, None]


def functional_changes(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n - 1, 3): relative difference, projection coefficient and secant cosine of each step.

    The secant goes over a twentieth of the curve.

    Args:
        means: (n, seconds) curves, each of which is compared with the one before.
    """
    before, after = means[:-1], means[1:]
    changes = np.column_stack(
        [
            relative_difference(before, after),
            projection_coefficient(after, before),
            secant_cosine(before, after),
        ]
    )
    # Curves without anybody, or without any change, are equal if they differ in nothing.
    equal = np.all(before == after, axis=1)
    changes[equal] = [0.0, 1.0, 1.0]
    return np.nan_to_num(changes, nan=np.inf)
