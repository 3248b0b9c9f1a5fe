"""The report of an experiment: one HTML page with everything in it."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.design.points import point_key
from mesa_mobility.experiments.observed import estimate, is_time, observed
from mesa_mobility.experiments.reporting.pictures import picture_of, value_text
from mesa_mobility.experiments.storing.rows import (
    BLOCKED,
    FAILED,
    SERIES,
    STALLED,
    STATUSES,
    TIMED_OUT,
)
from mesa_mobility.experiments.storing.shards import RUN_COLUMNS
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.versions import add_versions

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.convergence import Assessment
    from mesa_mobility.experiments.store import Store

_MOST_ROWS = 200
"""Rows of a table; the store has the rest."""

_SHOWN = ("egress_s", "flow_per_s", "mean_speed_mps")
"""Figures that are shown where runs have them; else the first that they have."""

_ESTIMATED = {
    "mean": "mean and 95 % interval",
    "p50": "median and interval",
    "p95": "95th percentile and interval",
}
"""What is given of each figure, by how it is asked for."""

_MOST_SETS = 20
"""Sets of inputs that are shown."""


def write_report(store: Store, path: str | os.PathLike[str] | None = None) -> Path:
    """Write what an experiment has found as one HTML page, which needs no other file.

    Args:
        store: of the experiment.
        path: of the page; by default ``report.html`` in the store, which must be local then.

    Returns:
        The path.

    Raises:
        ResultsError: the store has no runs, or the page cannot be written.
    """
    if path is None and not store.folder.local:
        raise ResultsError(f"{store}: is not on this machine, expected a path for the report")
    target = Path(store.folder.path("report.html") if path is None else path)
    frame = store.frame(series=True)
    if not len(frame):
        raise ResultsError(f"{store}: has no runs yet")
    experiment, definition = store.experiment(), store.definition()
    shown = _figures_of(frame, set(experiment.column_types()))
    page = Page(experiment.name or f"Experiment with {definition['experiment']['model']}")
    status = store.status()
    page.table(
        "Runs",
        ["what", "runs"],
        [
            ["asked for", _count(status["asked"])],
            ["missing", _count(status["missing"])],
            *[[name.replace("_", " "), status[name]] for name in STATUSES],
        ],
    )
    _design(page, store, frame)
    for figure in shown:
        page.picture(figure, picture_of(frame, figure, list(experiment.design.column_types())))
    _estimates(page, store, frame, shown)
    if experiment.replications == "auto":
        _convergence(page, store)
    _failures(page, frame)
    for text, runs in store.warnings().items():
        page.text(f"Warning of {runs} of {len(frame)} runs: {text}.")
    _inputs(page, frame)
    _repeat(page, definition)
    page.write(target)
    return target


def _figures_of(frame: pd.DataFrame, parameters: set[str]) -> list[str]:
    known = [name for name in _SHOWN if name in frame and frame[name].notna().any()]
    if known:
        return known
    others = [str(n) for n in frame if n not in {*RUN_COLUMNS, *SERIES, *parameters}]
    numbers = [name for name in others if frame[name].dtype == np.float64]
    return [name for name in numbers if frame[name].notna().any()][:3]


def _design(page: Page, store: Store, frame: pd.DataFrame) -> None:
    experiment = store.experiment()
    rows: list[list[Any]] = [
        ["model", experiment.model],
        ["design", experiment.design.kind],
        ["points", len(experiment.design)],
        ["replications", experiment.replications],
        ["seed", experiment.seed],
        ["seeds of points", experiment.seeds],
    ]
    for name, value in experiment.fixed.items():
        rows.append([name, value])
    for name in experiment.design.column_types():
        values = sorted(frame[name].dropna().unique().tolist())
        listed = ", ".join(value_text(value) for value in values[:12])
        if len(values) > 12:
            listed = f"{value_text(values[0])} to {value_text(values[-1])}"
        rows.append([name, listed])
    for name, unit in (("max_seconds", "simulated s"), ("time_limit", "s")):
        if getattr(experiment, name) is not None:
            rows.append([name, f"{getattr(experiment, name):g} {unit}"])
    page.table("Design", ["what", "value"], rows)


def _estimates(page: Page, store: Store, frame: pd.DataFrame, shown: list[str]) -> None:
    experiment = store.experiment()
    names = list(experiment.design.column_types())
    columns = [*names, "runs"]
    for figure in shown:
        columns += [f"{figure}, {what}" for what in _ESTIMATED.values()]
    rows = []
    for _, of in list(frame.groupby("point", sort=False))[:_MOST_ROWS]:
        row: list[Any] = [value_text(of[name].iloc[0]) for name in names]
        row.append(int((of["status"] != FAILED).sum()))
        for figure in shown:
            values = observed(of, figure)
            row += [str(estimate(f"{how} {figure}", values)) for how in _ESTIMATED]
        rows.append(row)
    page.table(
        "Results by point",
        columns,
        rows,
        "Means have intervals of Student's t. Percentiles have intervals between two of the runs, "
        "which need about 72 runs for the 95th percentile; where there are fewer, none is given.",
    )
    for figure in shown:
        if text := _lacking(frame, figure):
            page.text(text)
    if failed := int((frame["status"] == FAILED).sum()):
        page.text(f"{failed} of {len(frame)} runs have failed, and count nowhere.")
    if frame["point"].nunique() > _MOST_ROWS:
        page.text(f"The first {_MOST_ROWS} of {frame['point'].nunique()} points.")


def _lacking(frame: pd.DataFrame, figure: str) -> str:
    """A sentence on the runs that did not reach a figure, and why; nothing where all did."""
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
        "They count as later than all others: no percentile is given that lies among them, and"
        if is_time(figure)
        else "No percentile of its points is given, and"
    )
    return (
        f"{figure}: not reached in {len(of)} of {len(runs)} runs ({why}). {count_as} no mean, "
        "since that of the others would be taken for the mean of all."
    )


def _convergence(page: Page, store: Store) -> None:
    experiment = store.experiment()
    precision = experiment.precision
    found = store.assessments()
    rows = []
    for index in range(min(len(experiment.design), _MOST_ROWS)):
        known = found.get(point_key(experiment.point(index)))
        if known is None:
            continue
        point = experiment.design[index]
        if known.runs < precision.least:
            end = "not finished"
        elif known.enough:
            end = "all reached"
        elif known.unseen:
            end = "no run has a figure"
        elif known.hopeless:
            end = "runs that did not reach a figure"
        else:
            end = "maximum of runs" if known.runs >= precision.most else "not finished"
        rows.append(
            [
                *[value_text(value) for value in point.values()],
                known.runs,
                end,
                *[_reached(name, known) for name in known.met],
            ]
        )
    met = [*precision.figures, *(["occupancy"] if precision.occupancy else [])]
    page.table(
        "Convergence",
        [*experiment.design.column_types(), "runs", "ended by", *met],
        rows,
        f"Figures are asked for to {precision.tolerance:.1%} at {precision.confidence:.0%} "
        f"confidence, with {precision.least} to {precision.most} runs of each point. Runs end when "
        "they happen to scatter little: where a mean has ended them, its interval here allows for "
        "that, and is the one to quote.",
    )


def _reached(name: str, known: Assessment) -> str:
    """Whether what is asked for is reached, with the interval where it is a figure."""
    said = "reached" if known.met[name] else "not reached"
    if name in known.estimates:
        return f"{known.estimates[name]}: {said}"
    return f"{said}: {known.without_curve} runs timed out" if known.without_curve else said


def _failures(page: Page, frame: pd.DataFrame) -> None:
    failed = frame[frame["error"].notna()]
    if not len(failed):
        page.text("No run failed, and none took longer than its limit.")
        return
    errors = Counter(zip(failed["status"], failed["error"], strict=True))
    first: dict[str, str] = {}
    for run, seed, error in zip(failed["run"], failed["seed"], failed["error"], strict=True):
        first.setdefault(error, f"{run} (seed {seed})")
    page.table(
        "Failures",
        ["runs", "status", "error", "first run"],
        [
            [count, status.replace("_", " "), error, first[error]]
            for (status, error), count in errors.most_common(_MOST_ROWS)
        ],
    )


def _inputs(page: Page, frame: pd.DataFrame) -> None:
    """What runs used: once what all have in common, then each set of what differs."""
    known = frame["inputs"].dropna() if "inputs" in frame else ()
    sets = {text: json.loads(text) for text in dict.fromkeys(known)}
    counts = Counter(known)
    if not sets:
        return
    every = [dict.items(each) for each in sets.values()]
    common = set(every[0]).intersection(*every[1:])
    rows = [[len(known), *each] for each in sorted(common)]
    for text, count in counts.most_common(_MOST_SETS):
        rows += [[count, *each] for each in sorted(set(sets[text].items()) - common)]
    note = "Of each set of inputs once, with the number of runs that used it."
    if (more := len(sets) - _MOST_SETS) > 0:
        note += f" {more} further sets differ from run to run; the column inputs has them."
    if lacking := len(frame) - len(known):
        note += f" {lacking} runs ended before their inputs were known, or are of another version."
    page.table("Inputs of the runs", ["runs", "input", "which"], rows, note)


def _repeat(page: Page, definition: dict[str, Any]) -> None:
    session = definition["sessions"][-1]
    add_versions(
        page, session["versions"], session["inputs"], session["machine"], "Of the last session."
    )
    page.table(
        "Sessions",
        ["began", "executor", "mesa-mobility"],
        [
            [each["began"], each["executor"], each["versions"].get("mesa-mobility", "-")]
            for each in definition["sessions"]
        ],
    )
    page.json("The experiment, to be run again from a .json file", definition["experiment"])


def _count(value: int | None) -> str:
    return "as many as it takes" if value is None else str(value)
