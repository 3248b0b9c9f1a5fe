"""What an estimate says, and its table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.identification import ASSUMED
from mesa_mobility.estimation.measures import Measures

COLUMNS = ("term", "weight", "error", "95 %", "without: -2 log L", "p", "")


@dataclass(frozen=True, eq=False)
class Estimate:
    """Weights that make observed choices most likely; p terms, of which some may be fixed.

    Attributes:
        terms: names of the terms.
        weights: (p,) in units in which the sum of costs is a negative log-likelihood.
        free: (p,) whether a weight was estimated.
        errors: (p,) standard errors: the greater of the two below; 0 of fixed weights.
        by_person: (p,) standard errors, clustered by person.
        by_time: (p,) standard errors of a bootstrap of blocks of time within runs.
        intervals: (p, 2) 95 % intervals.
        likelihood_ratios: (p,) twice the log-likelihood that the choices lose without a term, the
            others estimated anew; not a number of fixed terms.
        p_values: (p,) that a term adds nothing, from the ratio adjusted for dependent choices.
        assumed: (p,) share of a term's spread that rests on what head tracks do not show: facing,
            and 5 cm of sway.
        log_likelihood: of all matched choices, nats, with ends as densities in 1/m2.
        measures: how well the choices are told.
    """

    terms: tuple[str, ...]
    weights: NDArray[np.float64]
    free: NDArray[np.bool_]
    errors: NDArray[np.float64]
    by_person: NDArray[np.float64]
    by_time: NDArray[np.float64]
    intervals: NDArray[np.float64]
    likelihood_ratios: NDArray[np.float64]
    p_values: NDArray[np.float64]
    assumed: NDArray[np.float64]
    log_likelihood: float
    measures: Measures

    def __getitem__(self, name: str) -> float:
        """The weight of a term."""
        if name not in self.terms:
            raise ModelError(f"estimate: no term {name!r}, there are {', '.join(self.terms)}")
        return float(self.weights[self.terms.index(name)])

    def __str__(self) -> str:
        return text_of(self)


def cells(estimate: Estimate) -> list[tuple[str, ...]]:
    """A row for each term: its name, weight, error, interval, likelihood ratio, p-value and a note
    where the weight is fixed or rests on what head tracks do not show."""
    rows: list[tuple[str, ...]] = []
    for k, name in enumerate(estimate.terms):
        low, high = estimate.intervals[k]
        ratio, p = estimate.likelihood_ratios[k], estimate.p_values[k]
        notes = [] if estimate.free[k] else ["fixed"]
        if estimate.assumed[k] > ASSUMED:
            notes.append("facing or sway assumed")
        rows.append(
            (
                name,
                f"{estimate.weights[k]:.2f}",
                f"{estimate.errors[k]:.2f}" if estimate.free[k] else "",
                f"{low:.2f} to {high:.2f}" if estimate.free[k] else "",
                "" if np.isnan(ratio) else f"{ratio:.1f}",
                "" if np.isnan(p) else f"{p:.2g}",
                ", ".join(notes),
            )
        )
    return rows


def text_of(estimate: Estimate) -> str:
    """The table, with how well the choices are told below it."""
    rows = [COLUMNS, *cells(estimate)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(COLUMNS))]
    lines = [
        "  ".join(
            cell.ljust(width) if k in (0, len(COLUMNS) - 1) else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    of = estimate.measures
    lines.append(
        f"{of.nats:.3f} nats a choice ({of.uniform:.3f} if all options were as likely), "
        f"energy score {of.energy:.3f} m, {of.choices} choices, {of.matched} of them with an "
        "option near enough"
    )
    return "\n".join(lines)
