"""What the runs of an experiment say of a figure, those that did not reach it included.

A run that fails says nothing of a figure and is left out. A time that a run does not come to, since
it stalls, takes longer than its limit or ends with people inside, is later than all others:
right-censored, as an infinite value.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.experiments.intervals import Estimate, mean_interval, quantile_interval
from mesa_mobility.experiments.storing.rows import (
    COMPUTING,
    FAILED,
    LASTING,
    REACHED,
    STALLED,
    TIMED_OUT,
)

if TYPE_CHECKING:
    import pandas as pd


def is_time(column: str) -> bool:
    """Whether a column has seconds until something happens.

    Its name ends so, and is neither a rate nor a time for which people are on stairs or at a lift.
    """
    lasts = column.startswith(LASTING) and column.rpartition(".")[2] not in REACHED
    return column.endswith("_s") and not column.endswith("_per_s") and not lasts


def observed(runs: pd.DataFrame, column: str) -> NDArray[np.float64]:
    """(n,) values of a column by run.

    Args:
        runs: rows of a store, with their ``status``.
        column: of numbers; all are missing where there is no such column.

    Returns:
        The values; nan where the run has failed, infinite where it has none for another reason, or
        where the column is a time of a crowd that stalled. Times to a share of the people, and of
        the first one, count as they are.
    """
    status = runs["status"].to_numpy()
    values = np.full(len(runs), np.nan)
    if column in runs:
        values = runs[column].to_numpy(dtype=np.float64, copy=True)
    lacking = np.isnan(values) | (status == TIMED_OUT)
    known = column in COMPUTING or column.rpartition(".")[2] in REACHED
    if is_time(column) and not known:
        lacking |= status == STALLED
    values[lacking] = np.inf
    values[status == FAILED] = np.nan
    return values


def warn_of_failed(store: object, statuses: Sequence[str]) -> None:
    """Warn if runs of a store have failed: an analysis leaves these runs out."""
    if failed := statuses.count(FAILED):
        said = f"{store}: {failed} of {len(statuses)} runs have failed, and are left out"
        warnings.warn(said, RuntimeWarning, stacklevel=4)


def estimate(figure: str, values: NDArray[np.float64], confidence: float = 0.95) -> Estimate:
    """Estimate and interval of a figure such as "mean egress_s" or "p95 egress_s".

    Args:
        figure: the mean or a percentile, and the column.
        values: (n,) values of the column, as ``observed`` has them. Only of a time is known that
            one not reached is late; of other columns no percentile is given where one is lacking.
        confidence: of the interval.
    """
    how, column = figure.split(" ", 1)
    if how == "mean" or (np.isinf(values).any() and not is_time(column)):
        return mean_interval(values, confidence)
    return quantile_interval(values, int(how[1:]) / 100, confidence)
