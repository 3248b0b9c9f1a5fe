"""Pictures of an experiment's report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.experiments.observed import estimate, observed
from mesa_mobility.experiments.storing.rows import FAILED
from mesa_mobility.reports.html import picture
from mesa_mobility.reports.words import with_value, words_of
from mesa_mobility.results.plots import TYPE_COLOURS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEAST_RUNS = 5
"""Runs of a point below which no interval is given: it would say little."""

_MARKS = {"v": "median, no mean: some runs did not reach it", "^": "the median is greater"}
"""Markers at points where no mean is given, in words."""

_MOST_POINTS = 8
"""Points of the design with a colour each."""

_SPREAD = (0.06, 0.2)
"""Single runs lie so far beside their place, from and to, as shares of the room between two."""

_NARROW = 6
"""That room is at most the range of all places over so many, so that runs stay near theirs."""


def picture_of(
    frame: pd.DataFrame, figure: str, names: list[str], labels: Mapping[str, str]
) -> bytes:
    """A figure against the parameters that vary: each run a point, with means and intervals.

    A point of the design without a mean, since runs did not reach the figure, has its median, or
    else an arrow at the greatest value that was reached. One of fewer than five runs has no
    interval.

    Args:
        frame: rows of the store.
        figure: the column.
        names: of the parameters that vary.
        labels: what columns are called, with units.
    """
    done = frame[frame["status"] != FAILED]
    numeric = [n for n in names if done[n].nunique() > 1 and done[n].dtype.kind in "if"]
    numeric.sort(key=lambda name: -done[name].nunique())
    drawn, axes = _axes()
    if numeric:
        along = numeric[0]
        by = [n for n in names if n != along and 1 < done[n].nunique() <= _MOST_POINTS]
        step = _step(done[along])
        for value, of in done.groupby(by[0]) if by else [(None, done)]:
            said = with_value(words_of(by[0], labels), value_text(value)) if by else None
            places = np.unique(of[along].dropna())
            groups = [observed(of[of[along] == x], figure) for x in places]
            _draw(axes, places, groups, step, figure, said)
        axes.set_xlabel(words_of(along, labels))
        # All places, also those without a value to draw, with room for the runs beside them.
        first, last = done[along].min(), done[along].max()
        axes.set_xlim(first - 0.3 * step, last + 0.5 * step)
    else:
        points = [of for _, of in done.groupby("point", sort=False)]
        _draw(axes, np.arange(len(points)), [observed(of, figure) for of in points], 1.0, figure)
        axes.set_xticks(range(len(points)), [_said_of_point(of, names, labels) for of in points])
        axes.set_xlim(-0.7, len(points) - 0.3)
    if lacking := int(np.isinf(observed(done, figure)).sum()):
        for marker, said in _MARKS.items():
            axes.plot([], [], marker, color="#555555", fillstyle="none", label=said)
        axes.set_title(f"not reached in {lacking} of {len(done)} runs", fontsize=9)
    if axes.get_legend_handles_labels()[1]:
        drawn.legend(loc="outside lower center", ncols=2, frameon=False, fontsize=8)
    axes.set_ylabel(words_of(figure, labels))
    return picture(drawn)


def spread_of(
    frame: pd.DataFrame, figure: str, names: list[str], labels: Mapping[str, str]
) -> bytes:
    """How a figure scatters over the runs, and how its mean settles with their number.

    Left each run in turn; right the mean of all runs so far, with its interval from five on. Of a
    design of many points the first eight are drawn.

    Args:
        frame: rows of the store.
        figure: the column.
        names: of the parameters that vary.
        labels: what columns are called, with units.
    """
    from matplotlib.figure import Figure

    drawn: Figure = Figure(figsize=(8.0, 4.2), dpi=130, layout="constrained")
    single, mean = drawn.subplots(1, 2)
    done = frame[frame["status"] != FAILED].sort_values("replication")
    points = [of for _, of in done.groupby("point", sort=False)][:_MOST_POINTS]
    for colour, of in zip(cycle(TYPE_COLOURS), points, strict=False):
        values, number = observed(of, figure), of["replication"].to_numpy() + 1
        reached = np.isfinite(values)
        said = _said_of_point(of, names, labels) if len(points) > 1 else None
        single.plot(number[reached], values[reached], ".", color=colour, label=said)
        if not reached.all() or len(values) < 2:
            continue
        so_far = [estimate(f"mean {figure}", values[:n]) for n in range(1, len(values) + 1)]
        runs = np.arange(1, len(values) + 1)
        middle = np.array([each.value for each in so_far], dtype=np.float64)
        half = np.array([each.half_width or np.nan for each in so_far])
        known = runs >= LEAST_RUNS
        mean.plot(runs, middle, color=colour, label=said)
        mean.fill_between(
            runs[known],
            (middle - half)[known],
            (middle + half)[known],
            color=colour,
            alpha=0.15,
            linewidth=0,
        )
    single.set(xlabel="number of the run", ylabel=words_of(figure, labels))
    mean.set(xlabel="number of runs", ylabel="mean so far, 95 % interval")
    for axes in (single, mean):
        axes.grid(alpha=0.3)
        axes.xaxis.get_major_locator().set_params(integer=True)
    if len(points) > 1:
        handles, said_of = single.get_legend_handles_labels()
        drawn.legend(
            handles, said_of, loc="outside lower center", ncols=4, frameon=False, fontsize=8
        )
    return picture(drawn)


def value_text(value: Any) -> str:
    """A parameter's value as pages and pictures have it."""
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _axes() -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    drawn: Figure = Figure(figsize=(7.2, 4.0), dpi=130, layout="constrained")
    axes = drawn.subplots()
    axes.grid(alpha=0.3)
    return drawn, axes


def _draw(
    axes: Axes,
    places: NDArray[Any],
    groups: Sequence[NDArray[np.float64]],
    step: float,
    figure: str,
    label: str | None = None,
) -> None:
    """Single runs as points, beside them their mean with its interval."""
    means = [estimate(f"mean {figure}", each) for each in groups]
    middle = [np.nan if each.value is None else each.value for each in means]
    half = [
        (mean.half_width or 0.0) if len(own) >= LEAST_RUNS else 0.0
        for mean, own in zip(means, groups, strict=True)
    ]
    drawn = axes.errorbar(places, middle, half, marker="o", capsize=3, label=label)
    colour = drawn[0].get_color()
    if not isinstance(step, float) or len(places) < 2:
        drawn[0].set_linestyle("none")
    for place, own in zip(places, groups, strict=True):
        reached = own[np.isfinite(own)]
        # In a fixed order, so that the same runs give the same picture.
        aside = np.linspace(*_SPREAD, len(reached))
        axes.plot(place + step * aside, reached, ".", color=colour, alpha=0.45, markersize=4)
    for marker in _MARKS:
        instead = [_instead(figure, each, marker) for each in groups]
        axes.plot(places, instead, marker, color=colour, fillstyle="none")


def _step(values: pd.Series[Any]) -> float:
    """The room that the runs of a value have: up to the next one, if that is near."""
    places = np.unique(values.dropna())
    if len(places) < 2:
        return 1.0
    return float(min(np.diff(places).min(), np.ptp(places) / _NARROW))


def _said_of_point(of: pd.DataFrame, names: list[str], labels: Mapping[str, str]) -> str:
    """The values of a point's parameters, each on a line."""
    row = of.iloc[0]
    said = [with_value(words_of(name, labels), value_text(row[name])) for name in names]
    return "\n".join(said) if said else f"{len(of)} runs"


def _instead(figure: str, values: NDArray[np.float64], marker: str) -> float:
    """The value of a marker at a point, or nan where it has none."""
    if not np.isinf(values).any():
        return np.nan
    median = estimate(f"p50 {figure}", values)
    found = median.value if marker == "v" else median.beyond
    return np.nan if found is None else found
