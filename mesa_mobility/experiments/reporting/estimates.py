"""Tables of what the runs of an experiment have found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.comparing import compare
from mesa_mobility.experiments.design.points import point_key
from mesa_mobility.experiments.experiment import COMMON
from mesa_mobility.experiments.intervals import Estimate
from mesa_mobility.experiments.observed import estimate, is_time, observed
from mesa_mobility.experiments.reporting.labels import labels_of
from mesa_mobility.experiments.reporting.pictures import LEAST_RUNS, value_text
from mesa_mobility.experiments.storing.rows import BLOCKED, FAILED, STALLED, TIMED_OUT
from mesa_mobility.reports.words import words_of

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.convergence import Assessment
    from mesa_mobility.experiments.store import Store
    from mesa_mobility.reports.html import Page

MOST_ROWS = 200
"""Rows of a table; the store has the rest."""

MOST_VALUES = 6
"""Values of a parameter that are compared two by two."""

_ESTIMATED = {"mean": "mean", "p50": "median", "p95": "95th percentile"}
"""The kinds of estimates of a figure, by how they are asked for."""


def known_of(how: str, figure: str, values: NDArray[np.float64]) -> Estimate:
    """An estimate, without an interval where there are fewer than five runs."""
    found = estimate(f"{how} {figure}", values)
    return found if len(values) >= LEAST_RUNS else replace(found, low=None, high=None)


def add_estimates(
    page: Page, experiment: Any, frame: pd.DataFrame, figure: str, label: str
) -> None:
    """Add a figure at each point: estimates with intervals, and the runs that lack it."""
    names = list(experiment.design.column_types())
    rows = []
    for _, of in list(frame.groupby("point", sort=False))[:MOST_ROWS]:
        values = observed(of, figure)
        known = values[np.isfinite(values)]
        rows.append(
            [
                *(value_text(of[name].iloc[0]) for name in names),
                int((of["status"] != FAILED).sum()),
                *(str(known_of(how, figure, values[~np.isnan(values)])) for how in _ESTIMATED),
                f"{known.min():.4g} to {known.max():.4g}" if len(known) else "-",
            ]
        )
    page.table(
        f"{label}, by point of the design",
        [
            *(words_of(name, labels_of(experiment)) for name in names),
            "runs",
            *_ESTIMATED.values(),
            "least to greatest",
        ],
        rows,
        "In brackets: 95 % intervals. That of a mean is Student's t; that of a percentile lies "
        "between two of the runs, and the 95th percentile has one from about 72 runs on. Fewer "
        f"than {LEAST_RUNS} runs have none.",
    )
    if text := lacking(frame, figure, label):
        page.text(text)
    if failed := int((frame["status"] == FAILED).sum()):
        page.text(f"{failed} of {len(frame)} runs have failed, and count nowhere.")
    if frame["point"].nunique() > MOST_ROWS:
        page.text(f"The first {MOST_ROWS} of {frame['point'].nunique()} points.")


def lacking(frame: pd.DataFrame, figure: str, label: str) -> str:
    """A sentence on the runs that did not reach a figure, and why; nothing where all did.

    Args:
        frame: rows of the store.
        figure: the column.
        label: what it is called.
    """
    runs = frame[frame["status"] != FAILED]
    of = runs[np.isinf(observed(runs, figure))]
    if not len(of):
        return ""
    counts = {
        "blocked": int((of["status"] == BLOCKED).sum()),
        "stalled": int((of["status"] == STALLED).sum()),
        "timed out": int((of["status"] == TIMED_OUT).sum()),
    }
    counts["ended without it"] = len(of) - sum(counts.values())
    why = ", ".join(f"{count} {how}" for how, count in counts.items() if count)
    count_as = (
        "They count as later than all others (censored): no percentile is given that lies among "
        "them, and"
        if is_time(figure)
        else "No percentile of its points is given, and"
    )
    return (
        f"{label[:1].upper()}{label[1:]}: not reached in {len(of)} of {len(runs)} runs ({why}). "
        f"{count_as} no mean, since that of the others would be taken for the mean of all."
    )


def add_comparison(page: Page, store: Store, frame: pd.DataFrame, figures: Sequence[str]) -> None:
    """Add the comparison of designs in pairs of runs, where seeds are common."""
    experiment = store.experiment()
    labels = labels_of(experiment)
    names = [
        name
        for name in experiment.design.column_types()
        if 2 <= frame[name].nunique() <= MOST_VALUES
    ]
    if experiment.seeds != COMMON or not names:
        return
    page.section("Comparison of designs", "comparison")
    page.text(
        "Runs of one number have the same seed at all points, and are compared in pairs. The "
        "difference is the mean of the second less the first. “Detectable” is the smallest "
        "difference that so many pairs find with a probability of 90 %: where no difference was "
        "found, smaller ones may exist. All comparisons of a table together have a confidence of "
        "95 %, so that each single one has more (Bonferroni); its interval is that wide."
    )
    for name in names:
        for figure in figures:
            try:
                found = compare(store, name, figure)
            except (ModelError, ResultsError) as error:
                page.text(f"{words_of(figure, labels)}: {error}.")
                continue
            page.table(
                f"{words_of(figure, labels)}, by {words_of(name, labels)}",
                COMPARED,
                [compared(each) for each in found],
            )


COMPARED = (
    "first",
    "second",
    "difference (interval)",
    "relative",
    "effect size",
    "detectable",
    "pairs up / down",
    "p",
    "verdict",
)
"""Columns of a comparison of designs."""


def compared(each: Any) -> list[str]:
    """A row of the table of comparisons, as texts."""
    return [
        value_text(each.first),
        value_text(each.second),
        str(each.difference),
        "-" if each.relative is None else f"{each.relative:+.1%}",
        "-" if each.effect is None else f"{each.effect:.2f}",
        "-" if each.detectable is None else f"{each.detectable:.3g}",
        f"{each.greater} / {each.less}",
        f"{each.p:.2g}",
        each.verdict,
    ]


def add_convergence(page: Page, store: Store) -> None:
    """Add how well the figures of ``replications="auto"`` are known."""
    experiment = store.experiment()
    if experiment.replications != "auto":
        page.text(
            f"The number of runs was chosen beforehand: {experiment.replications} of each point. "
            "The pictures above show whether the means have settled."
        )
        return
    precision, labels = experiment.precision, labels_of(experiment)
    found = store.assessments()
    rows = []
    for index in range(min(len(experiment.design), MOST_ROWS)):
        known = found.get(point_key(experiment.point(index)))
        if known is None:
            continue
        rows.append(
            [
                *[value_text(value) for value in experiment.design[index].values()],
                known.runs,
                _ended(known, precision),
                *[_reached(name, known) for name in known.met],
            ]
        )
    met = [*precision.figures, *(["occupancy"] if precision.occupancy else [])]
    page.table(
        "Convergence",
        [
            *(words_of(name, labels) for name in experiment.design.column_types()),
            "runs",
            "ended by",
            *(_asked(name, labels) for name in met),
        ],
        rows,
        f"Figures are asked for to {precision.tolerance:.1%} at {precision.confidence:.0%} "
        f"confidence, with {precision.least} to {precision.most} runs of each point. Runs end when "
        "they happen to scatter little: where a mean has ended them, its interval here allows for "
        "that, and is the one to quote.",
    )


def _asked(name: str, labels: Mapping[str, str]) -> str:
    """A figure whose precision is asked for, such as "p95 egress_s", in words."""
    how, _, figure = name.partition(" ")
    return f"{_ESTIMATED.get(how, how)}: {words_of(figure, labels)}" if figure else name


def _ended(known: Assessment, precision: Any) -> str:
    if known.runs < precision.least:
        return "not finished"
    if known.enough:
        return "all reached"
    if known.unseen:
        return "no run has a figure"
    if known.hopeless:
        return "runs that did not reach a figure"
    return "maximum of runs" if known.runs >= precision.most else "not finished"


def _reached(name: str, known: Assessment) -> str:
    """Whether what is asked for is reached, with the interval where it is a figure."""
    said = "reached" if known.met[name] else "not reached"
    if name in known.estimates:
        return f"{known.estimates[name]}: {said}"
    return f"{said}: {known.without_curve} runs timed out" if known.without_curve else said
