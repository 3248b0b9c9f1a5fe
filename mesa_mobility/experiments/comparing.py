"""Comparison of designs: the points of an experiment, run by run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.design.points import point_key
from mesa_mobility.experiments.intervals import Estimate, check_confidence, mean_interval
from mesa_mobility.experiments.observed import observed, warn_of_failed
from mesa_mobility.experiments.storing.rows import FAILED

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store

FloatArray = NDArray[np.float64]

POWER = 0.9

_LARGEST = 1e6
"""Noncentrality beyond which nothing is looked for."""


@dataclass(frozen=True)
class Comparison:
    """Two designs, compared in pairs of runs.

    Attributes:
        first: value of the parameter in the first design.
        second: value in the second design.
        difference: mean of second - first over the pairs, with its interval. It is not given where
            a run of a pair has not reached the figure.
        relative: that mean as a share of the mean of the first design; None where either is not
            known.
        effect: standardised effect size, the mean over the standard deviation of the differences
            (Cohen's d_z); None where they do not differ, or the mean is not known.
        detectable: the smallest difference of the means, in either direction, that so many pairs
            find with the power asked for; None where the deviation is not known.
        correlation: of the pairs; with common seeds the greater, the more they help. None where
            either design has no variance.
        greater: number of pairs in which the second design has the greater value; one that has not
            reached a time is the greater one.
        less: number in which it has the smaller one.
        p: probability of differences as great as these if the designs were equal, in a paired t
            test; where runs have not reached the figure, in a sign test.
        different: whether p times the number of comparisons is at most 1 - confidence.
    """

    first: Any
    second: Any
    difference: Estimate
    relative: float | None
    effect: float | None
    detectable: float | None
    correlation: float | None
    greater: int
    less: int
    p: float
    different: bool

    @property
    def verdict(self) -> str:
        """Whether they are different, in words."""
        return "different" if self.different else "no difference found"

    def __str__(self) -> str:
        """What was found, on one line."""
        return f"{self.second} - {self.first}: {self.difference}, {self.verdict} (p = {self.p:.2g})"


def compare(
    store: Store, by: str, figure: str, *, confidence: float = 0.95, power: float = POWER
) -> list[Comparison]:
    """Compare designs: a figure at each two values of a parameter, in pairs of runs.

    A pair are the runs of one number at two points that differ in nothing but the parameter. With
    ``Experiment(seeds="common")`` both have the same seed, so that differences scatter less than
    with independent seeds (common random numbers: A. M. Law, Simulation Modeling and Analysis,
    5th ed., 2015, sections 10.2 and 11.2). The test is Student's for pairs; of m comparisons each
    has the confidence 1 - (1 - confidence) / m (Bonferroni). Failed runs are left out with their
    pairs, with a warning.

    Args:
        store: of the experiment.
        by: the parameter.
        figure: a column of numbers, such as "egress_s".
        confidence: that no equal designs are called different, over all comparisons together.
        power: probability with which ``detectable`` is found.

    Returns:
        One comparison for each two values, in order of the values.

    Raises:
        ModelError: a confidence or a power that is not between 0 and 1.
        ResultsError: no such parameter or column, a parameter of one value, or two values with
            fewer than two pairs.
    """
    check_confidence(confidence)
    if not (isinstance(power, int | float) and 1.0 - confidence < power < 1.0):
        raise ModelError(f"power is {power!r}, expected a number between 1 - confidence and 1")
    table = _by_value(store, by, figure)
    texts = any(isinstance(each, str) for each in table.columns)
    values = sorted(table.columns, key=str if texts else None)
    if len(values) < 2:
        raise ResultsError(f"{store}: runs at {len(values)} values of {by}, expected two or more")
    pairs = list(combinations(values, 2))
    level = 1.0 - (1.0 - confidence) / len(pairs)
    found = []
    for first, second in pairs:
        known = table[[first, second]].dropna().to_numpy()
        if len(known) < 2:
            raise ResultsError(
                f"{store}: {len(known)} pairs of runs at {by} {first} and {second}, expected two "
                "or more"
            )
        found.append(compare_pairs(first, second, known, confidence=level, power=power))
    return found


def smallest_difference(
    deviation: float, pairs: int, *, confidence: float = 0.95, power: float = POWER
) -> float:
    """The smallest difference of two means that a paired t test finds with a power.

    It solves P(|T| > t) = power for the noncentral T with pairs - 1 degrees of freedom and the
    noncentrality difference * sqrt(pairs) / deviation, with the quantile t of the test.

    Args:
        deviation: standard deviation of the differences.
        pairs: their number, 2 or more.
        confidence: of the test.
        power: above 1 - confidence.

    Returns:
        The difference, in the unit of the deviation; infinite where no difference is large enough
        to be computed.
    """
    from scipy.optimize import brentq
    from scipy.stats import nct, t

    bound = float(t.ppf((1.0 + confidence) / 2.0, pairs - 1))

    def missing(shift: float) -> float:
        """What the power lacks at a noncentrality."""
        # Of the other tail nothing is left where the power is more than a few percent.
        return float(nct.sf(bound, pairs - 1, shift)) - power

    high = bound + 5.0
    while not missing(high) >= 0.0:
        high *= 2.0
        if high > _LARGEST:
            return math.inf
    shift = float(brentq(missing, 0.0, high))
    return shift * deviation / math.sqrt(pairs)


def _by_value(store: Store, by: str, figure: str) -> pd.DataFrame:
    """The figure of each pair, a row for each, a column for each value of the parameter."""
    names = list(store.experiment().column_types())
    if by not in names:
        raise ResultsError(f"{store}: no parameter {by!r}, expected one of {', '.join(names)}")
    experiment = store.experiment()
    runs = store.table(["point", *names, "replication", figure]).to_pandas()
    # Points that are no longer asked for may differ in parameters that are no longer there.
    asked = {point_key(experiment.point(k)) for k in range(len(experiment.design))}
    runs = runs[runs["point"].isin(asked)]
    if figure not in runs:
        raise ResultsError(f"{store}: has no column {figure}")
    if runs[figure].dtype.kind not in "fi":
        raise ResultsError(f"{store}: column {figure} has no numbers")
    warn_of_failed(store, runs["status"].tolist())
    runs = runs.assign(_value=observed(runs, figure))
    runs = runs[runs["status"] != FAILED]
    others = [name for name in names if name != by]
    # A column without values has no type of its own, and would drop every run.
    runs[others] = runs[others].astype(object).where(runs[others].notna(), "")
    return runs.pivot(index=[*others, "replication"], columns=by, values="_value")


def compare_pairs(
    first: Any,
    second: Any,
    known: FloatArray,
    *,
    confidence: float = 0.95,
    power: float = POWER,
) -> Comparison:
    """One comparison of two designs.

    Args:
        first: what the first design is called.
        second: what the second one is called.
        known: (n, 2) figures of both designs in each pair of runs; infinite where a run has not
            reached the figure. There must be two pairs or more.
        confidence: of the test and of the interval.
        power: probability with which ``detectable`` is found.
    """
    before, after = known.T
    greater, less = int((after > before).sum()), int((after < before).sum())
    reached = bool(np.isfinite(known).all())
    if not reached:
        # Two runs that both have not reached it differ by an unknown amount.
        lacking = np.where(np.isfinite(known).all(axis=1), 0.0, np.inf)
        p = _sign_test(greater, less)
        none = mean_interval(lacking, confidence)
        return Comparison(
            first, second, none, None, None, None, None, greater, less, p, p <= 1 - confidence
        )
    differences = after - before
    mean, deviation = float(differences.mean()), float(differences.std(ddof=1))
    p = _t_test(mean, deviation, len(known))
    base = float(before.mean())
    varied = bool(before.std() and after.std())
    return Comparison(
        first,
        second,
        mean_interval(differences, confidence),
        mean / base if base else None,
        mean / deviation if deviation else None,
        smallest_difference(deviation, len(known), confidence=confidence, power=power),
        float(np.corrcoef(before, after)[0, 1]) if varied else None,
        greater,
        less,
        p,
        p <= 1 - confidence,
    )


def _t_test(mean: float, deviation: float, pairs: int) -> float:
    """Probability of a mean difference as great as this, if the true one is 0."""
    from scipy.special import stdtr

    if not deviation:
        return 0.0 if mean else 1.0
    return 2.0 * float(stdtr(pairs - 1, -abs(mean) * math.sqrt(pairs) / deviation))


def _sign_test(greater: int, less: int) -> float:
    """Probability of signs as unequal as these, if both are equally probable."""
    from scipy.stats import binomtest

    return float(binomtest(greater, greater + less).pvalue) if greater + less else 1.0
