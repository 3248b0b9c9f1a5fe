"""Where the spread of a figure comes from: variance components of a nested experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.intervals import Estimate, check_confidence
from mesa_mobility.experiments.observed import observed, warn_of_failed
from mesa_mobility.experiments.storing.rows import FAILED

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store

CHANCE = "chance"
"""Source of what differs between the replications of a point."""

_DRAWS = 20_000


@dataclass(frozen=True)
class VarianceComponent:
    """One source of the variance of a figure.

    Attributes:
        source: the parameter, or "chance".
        groups: number of groups of runs with equal values of this parameter and of all parameters
            within which it is nested. For chance, the number of runs.
        variance: estimate, at least 0, in the square of the figure's unit.
        share: of the sum of all variances, with its interval.
    """

    source: str
    groups: int
    variance: float
    share: Estimate


def variance_components(
    store: Store, figure: str, levels: Sequence[str], confidence: float = 0.95
) -> list[VarianceComponent]:
    """Which share of the variance of a figure comes from which parameter, and from chance.

    Runs are nested: each value of a level belongs to one value of the level above, like people who
    were drawn anew for each map. The values of a parameter are a sample of those that it could
    have, so this is a random-effects analysis of variance. It sets the mean squares equal to their
    expectations, also where groups differ in size (S. R. Searle, G. Casella and C. E. McCulloch,
    Variance Components, 1992, chapter 5). An estimate below 0 counts as 0. Intervals of the shares
    are generalised confidence intervals (S. Weerahandi, Journal of the American Statistical
    Association 88 (1993) 899-905), for normal effects.

    Args:
        store: of the experiment; runs that have failed are left out, with a warning.
        figure: a column of numbers, which all other runs must have.
        levels: parameters from the outermost one inwards.
        confidence: of the intervals.

    Returns:
        One component for each level, then that of chance.

    Raises:
        ModelError: no levels, or a confidence out of range.
        ResultsError: no such column, runs that did not reach the figure, or a level without two
            values within one of the level above.
    """
    if isinstance(levels, str) or not levels:
        raise ModelError(f"levels is {levels!r}, expected the names of one parameter or more")
    check_confidence(confidence)
    runs = store.table([*levels, figure]).to_pandas()
    for name in (*levels, figure):
        if name not in runs:
            raise ResultsError(f"{store}: has no column {name}")
    runs = runs[runs["status"] != FAILED]
    values = observed(runs, figure)
    if lacking := int(np.isinf(values).sum()):
        raise ResultsError(
            f"{store}: {lacking} of {len(runs)} runs have no {figure}: they stalled, timed out or "
            "ended with people inside; expected a figure that all have"
        )
    warn_of_failed(store, store.table([])["status"].to_pylist())
    groups = _groups(runs, levels)
    counts = [len(np.unique(of)) for of in groups]
    for name, outer, inner in zip((*levels, CHANCE), counts[:-1], counts[1:], strict=True):
        if inner <= outer:
            raise ResultsError(
                f"{store}: {inner} groups of {name} in {outer} of the level above, expected more"
            )
    freedom = np.diff(counts)
    squares = np.diff([_square_of_means(values, of) for of in groups])
    expected = _expected(groups)
    variances = np.maximum(np.linalg.solve(expected, squares), 0.0)
    # The mean squares that other samples would have had.
    chance = np.random.default_rng(0).chisquare(freedom, (_DRAWS, len(freedom)))
    drawn = np.maximum(np.linalg.solve(expected, (squares * freedom / chance).T), 0.0).T
    half = (1 - confidence) / 2
    low, high = np.quantile(_shares(drawn), [half, 1 - half], axis=0)
    return [
        VarianceComponent(name, count, float(variance), Estimate(float(s), float(a), float(b)))
        for name, count, variance, s, a, b in zip(
            (*levels, CHANCE), counts[1:], variances, _shares(variances), low, high, strict=True
        )
    ]


def _groups(runs: pd.DataFrame, levels: Sequence[str]) -> list[NDArray[np.int64]]:
    """(n,) group of each run: all in one, then by each level, then each run its own."""
    found = [np.zeros(len(runs), dtype=np.int64)]
    for depth in range(1, len(levels) + 1):
        numbers = runs.groupby(list(levels[:depth]), dropna=False).ngroup()
        found.append(np.asarray(numbers, dtype=np.int64))
    return [*found, np.arange(len(runs))]


def _square_of_means(values: NDArray[np.float64], groups: NDArray[np.int64]) -> float:
    """Sum over the groups of their size times the square of their mean."""
    # About the mean of all, for the sake of digits.
    sums = np.bincount(groups, weights=values - values.mean())
    return float(np.sum(sums**2 / np.bincount(groups)))


def _expected(groups: Sequence[NDArray[np.int64]]) -> NDArray[np.float64]:
    """(levels, levels): expectation of each sum of squares, by the variance of each level."""

    def coefficient(level: int, of: int) -> float:
        """Of the variance ``of`` a level in the sum of squared means of another."""
        if of <= level:
            return float(len(groups[0]))
        _, first, sizes = np.unique(groups[of], return_index=True, return_counts=True)
        within = np.bincount(groups[level][first], weights=sizes.astype(np.float64) ** 2)
        return float(np.sum(within / np.bincount(groups[level])))

    numbers = range(1, len(groups))
    return np.array(
        [[coefficient(k, of) - coefficient(k - 1, of) for of in numbers] for k in numbers]
    )


def _shares(variances: NDArray[np.float64]) -> NDArray[np.float64]:
    total = variances.sum(axis=-1, keepdims=True)
    return np.divide(variances, total, out=np.zeros_like(variances), where=total > 0)
