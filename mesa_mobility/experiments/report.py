"""The report of an experiment: one HTML page with everything in it."""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.intervals import Estimate, mean_interval, quantile_interval
from mesa_mobility.experiments.points import point_key
from mesa_mobility.experiments.storing.rows import DONE, SERIES, STATUSES
from mesa_mobility.experiments.storing.shards import RUN_COLUMNS
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.reports.versions import add_versions

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from mesa_mobility.experiments.convergence import Assessment
    from mesa_mobility.experiments.store import Store

_MOST_ROWS = 200
"""Rows of a table; the store has the rest."""

_SHOWN = ("egress_s", "flow_per_s", "mean_speed_mps")
"""Figures that are shown where runs have them; else the first that they have."""


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
        [["asked for", _count(status["asked"])], ["missing", _count(status["missing"])],
         *[[name.replace("_", " "), status[name]] for name in STATUSES]],
    )  # fmt: skip
    _design(page, store, frame)
    for figure in shown:
        page.picture(figure, _picture(frame, figure, list(experiment.design.column_types())))
    _estimates(page, store, frame, shown)
    if experiment.replications == "auto":
        _convergence(page, store)
    _failures(page, frame)
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
    rows: list[list[Any]] = [["model", experiment.model], ["design", experiment.design.kind],
                             ["points", len(experiment.design)],
                             ["replications", experiment.replications],
                             ["seed", experiment.seed]]  # fmt: skip
    for name, value in experiment.fixed.items():
        rows.append([name, value])
    for name in experiment.design.column_types():
        values = sorted(frame[name].dropna().unique().tolist())
        listed = ", ".join(_text(value) for value in values[:12])
        rows.append(
            [name, listed if len(values) <= 12 else f"{_text(values[0])} to {_text(values[-1])}"]
        )
    for name, unit in (("max_seconds", "simulated s"), ("time_limit", "s")):
        if getattr(experiment, name) is not None:
            rows.append([name, f"{getattr(experiment, name):g} {unit}"])
    page.table("Design", ["what", "value"], rows)


def _estimates(page: Page, store: Store, frame: pd.DataFrame, shown: list[str]) -> None:
    experiment = store.experiment()
    names = list(experiment.design.column_types())
    done = frame[frame["status"] == DONE]
    columns = [*names, "done"]
    for figure in shown:
        columns += [f"{figure}, mean and 95 % interval", f"{figure}, 95th percentile and interval"]
    rows = []
    for _, of in list(done.groupby("point", sort=False))[:_MOST_ROWS]:
        row: list[Any] = [_text(of[name].iloc[0]) for name in names]
        row.append(len(of))
        for figure in shown:
            values = of[figure].to_numpy(dtype=np.float64)
            row += [_interval(mean_interval(values)), _interval(quantile_interval(values, 0.95))]
        rows.append(row)
    page.table(
        "Results by point", columns, rows,
        "Means have intervals of Student's t. Percentiles have intervals between two of the runs, "
        "which need about 72 runs for the 95th percentile; where there are fewer, none is given.",
    )  # fmt: skip
    for figure in shown:
        if lacking := len(frame) - int(done[figure].notna().sum()):
            page.text(
                f"{lacking} of {len(frame)} runs have no {figure}, and are in no mean or "
                "percentile of it: they have failed, stalled, or ended with people inside."
            )
    if done["point"].nunique() > _MOST_ROWS:
        page.text(f"The first {_MOST_ROWS} of {done['point'].nunique()} points.")


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
        elif known.hopeless:
            end = "no run has a figure"
        else:
            end = "maximum of runs" if known.runs >= precision.most else "not finished"
        rows.append(
            [*[_text(value) for value in point.values()], known.runs, end,
             *[_reached(name, known) for name in known.met]]
        )  # fmt: skip
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
    return f"{_interval(known.estimates[name])} {said}" if name in known.estimates else said


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


def _repeat(page: Page, definition: dict[str, Any]) -> None:
    session = definition["sessions"][-1]
    add_versions(
        page, session["versions"], session["inputs"], session["machine"], "Of the last session."
    )
    page.table(
        "Sessions", ["began", "executor", "mesa-mobility"],
        [[each["began"], each["executor"], each["versions"].get("mesa-mobility", "-")]
         for each in definition["sessions"]],
    )  # fmt: skip
    page.json("The experiment, to be run again from a .json file", definition["experiment"])


def _picture(frame: pd.DataFrame, figure: str, names: list[str]) -> bytes:
    """A figure against the parameters that vary, or its distribution where none does."""
    from matplotlib.figure import Figure

    done = frame[(frame["status"] == DONE) & frame[figure].notna()]
    numeric = [n for n in names if done[n].nunique() > 1 and done[n].dtype.kind in "if"]
    drawn: Figure = Figure(figsize=(6.4, 3.8), dpi=110, layout="constrained")
    axes = drawn.subplots()
    axes.grid(alpha=0.3)
    if not numeric:
        axes.hist(done[figure], bins="auto", color="#2166ac")
        axes.set(xlabel=figure, ylabel="runs")
        return picture(drawn)
    numeric.sort(key=lambda name: -done[name].nunique())
    along = numeric[0]
    by = [n for n in names if n != along and 1 < done[n].nunique() <= 8]
    for value, of in done.groupby(by[0]) if by else [(None, done)]:
        known = [
            (some[along].iloc[0], mean_interval(some[figure])) for _, some in of.groupby(along)
        ]
        across = [float(x) for x, _ in known]
        middle = [each.value or 0.0 for _, each in known]
        half = [each.half_width or 0.0 for _, each in known]
        label = None if value is None else f"{by[0]} {_text(value)}"
        axes.errorbar(across, middle, half, marker="o", capsize=3, label=label)
    if by:
        axes.legend(frameon=False, fontsize=8)
    axes.set(xlabel=along, ylabel=f"{figure}, mean and 95 % interval")
    return picture(drawn)


def _interval(known: Estimate) -> str:
    if known.value is None:
        return "-"
    if known.low is None or known.high is None:
        return f"{known.value:.4g}"
    return f"{known.value:.4g} ({known.low:.4g} to {known.high:.4g})"


def _count(value: int | None) -> str:
    return "as many as it takes" if value is None else str(value)


def _text(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
