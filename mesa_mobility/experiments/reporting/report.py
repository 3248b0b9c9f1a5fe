"""The report of an experiment: one HTML page with everything in it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.intervals import Estimate
from mesa_mobility.experiments.observed import observed
from mesa_mobility.experiments.reporting.basis import add_basis
from mesa_mobility.experiments.reporting.estimates import (
    add_comparison,
    add_convergence,
    add_estimates,
    known_of,
)
from mesa_mobility.experiments.reporting.evidence import add_failures, add_inputs, add_repeating
from mesa_mobility.experiments.reporting.labels import labels_of
from mesa_mobility.experiments.reporting.maps import add_maps
from mesa_mobility.experiments.reporting.pictures import picture_of, spread_of, value_text
from mesa_mobility.experiments.reporting.places import add_doors, add_types
from mesa_mobility.experiments.storing.rows import DONE, SERIES, STATUSES
from mesa_mobility.experiments.storing.shards import RUN_COLUMNS
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.evidence import add_definitions
from mesa_mobility.reports.run.texts import count
from mesa_mobility.reports.words import with_value, words_of

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store

_SHOWN = ("egress_s", "t95_s", "flow_per_s", "mean_speed_mps")
"""Figures that are shown where runs have them; else the first that they have."""

_MOST_COLUMNS = 3
"""Points of the design that the summary lists one by one."""


def write_report(store: Store, path: str | os.PathLike[str] | None = None) -> Path:
    """Write what an experiment has found as one HTML page, which needs no other file.

    Args:
        store: of the experiment; ``Experiment.report`` says which figures are shown.
        path: of the page; by default ``report.html`` in the store, which must be local then.

    Returns:
        The path.

    Raises:
        ResultsError: the store has no runs, or not the figures asked for, or the page cannot be
            written.
    """
    if path is None and not store.folder.local:
        raise ResultsError(f"{store}: is not on this machine, expected a path for the report")
    target = Path(store.folder.path("report.html") if path is None else path)
    frame = store.frame(series=True)
    if not len(frame):
        raise ResultsError(f"{store}: has no runs yet")
    experiment, definition = store.experiment(), store.definition()
    names, labels = list(experiment.design.column_types()), labels_of(experiment)
    shown = _figures_of(store, frame, set(experiment.column_types()))
    page = Page(
        experiment.name or f"Experiment with the model {definition['experiment']['model']}",
        f"{len(frame)} simulated runs with mesa-mobility "
        f"{definition['sessions'][-1]['versions'].get('mesa-mobility', '')}. Written "
        f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC.",
    )
    _summary(page, store, frame, shown)
    add_basis(page, store, frame)
    page.section("Results", "results")
    for figure in shown:
        label = words_of(figure, labels)
        page.subsection(label[:1].upper() + label[1:])
        page.picture(
            f"{label}: a small point for each run, just beside the value of its parameter; large "
            "points are means, with 95 % intervals from five runs on",
            picture_of(frame, figure, names, labels),
        )
        add_estimates(page, experiment, frame, figure, label)
    add_comparison(page, store, frame, shown)
    add_doors(page, experiment, frame)
    add_types(page, experiment, frame)
    add_maps(page, store, frame, shown)
    page.section("Spread over the seeds and convergence", "convergence")
    for figure in shown:
        label = words_of(figure, labels)
        page.picture(
            f"{label}: each run (left), and how the mean and its 95 % interval settle as runs are "
            "added (right)",
            spread_of(frame, figure, names, labels),
        )
    add_convergence(page, store)
    add_failures(page, store, frame)
    add_definitions(page)
    add_inputs(page, frame)
    add_repeating(page, definition)
    page.signatures()
    page.write(target)
    return target


def _figures_of(store: Store, frame: pd.DataFrame, parameters: set[str]) -> list[str]:
    """The figures asked for, or else those that runs usually have.

    Raises:
        ResultsError: the runs have no such column of numbers.
    """
    asked = store.experiment().report.figures
    for name in asked:
        if name not in frame or frame[name].dtype.kind not in "fi":
            raise ResultsError(f"{store}: report: the runs have no column of numbers {name!r}")
    if asked:
        return list(asked)
    # Those that no run has reached are shown, too.
    known = [n for n in _SHOWN if n in frame and not np.isnan(observed(frame, n)).all()]
    if known:
        return known
    others = [str(n) for n in frame if n not in {*RUN_COLUMNS, *SERIES, *parameters}]
    numbers = [name for name in others if frame[name].dtype == np.float64]
    return [name for name in numbers if frame[name].notna().any()][:3]


def _summary(page: Page, store: Store, frame: pd.DataFrame, shown: list[str]) -> None:
    status, experiment = store.status(), store.experiment()
    page.section("Summary", "summary")
    labels = labels_of(experiment)
    left = frame["left_inside"] if "left_inside" in frame else np.zeros(len(frame))
    inside = int(((frame["status"] == DONE) & (left > 0)).sum())
    points = [of for _, of in frame.groupby("point", sort=False)]
    names = [n for n in experiment.design.column_types() if frame[n].nunique() > 1]
    rows, few = [], len(points) <= _MOST_COLUMNS
    for figure in shown:
        every = [observed(of, figure) for of in points]
        means = [known_of("mean", figure, own[~np.isnan(own)]) for own in every]
        said = [str(each) for each in means]
        rows.append([words_of(figure, labels), *(said if few else [_range_of(means)])])
    columns = ["least to greatest mean of a point"]
    if few:
        columns = [
            ", ".join(with_value(words_of(n, labels), value_text(of[n].iloc[0])) for n in names)
            or "mean"
            for of in points
        ]
    page.table(
        "Means of the main figures over the runs of each point of the design",
        ["figure", *columns],
        rows,
        "In brackets: 95 % intervals." if few else "",
    )
    page.table(
        "Runs",
        ["what", "runs"],
        [
            ["asked for", _count(status["asked"])],
            ["missing", _count(status["missing"])],
            *[[name.replace("_", " "), status[name]] for name in STATUSES],
            *([["done, but with people inside at the end", inside]] if inside else []),
        ],
        "“Done”: everybody had left, or the run ended at its longest time. “Stalled”: nobody made "
        "progress any more, with people inside. “Blocked”: the run ended at its longest time, with "
        "people inside who block each other. “Timed out”: it took longer to compute than allowed. "
        "Times that a run did not reach count as later than all others (censored). “Failed”: an "
        "error ended it; it counts nowhere.",
    )
    if status["missing"]:
        page.notice(f"{status['missing']} runs that were asked for are missing.")


def _range_of(means: Sequence[Estimate]) -> str:
    """The least and the greatest of the means of many points."""
    known = [each.value for each in means if each.value is not None]
    if not known:
        return "no point has a mean"
    said = f"{min(known):.4g} to {max(known):.4g}" if len(known) > 1 else f"{known[0]:.4g}"
    said += f" ({count(len(known), 'point')})"
    lacking = len(means) - len(known)
    return f"{said}; no mean of {count(lacking, 'point')}" if lacking else said


def _count(value: int | None) -> str:
    return "as many as it takes" if value is None else str(value)
