"""Pictures of an experiment's report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.experiments.observed import estimate, observed
from mesa_mobility.experiments.storing.rows import FAILED
from mesa_mobility.reports.html import picture

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

_MARKS = {"v": "median, no mean: some runs did not reach it", "^": "the median is greater"}
"""What stands at a point where no mean is given."""


def picture_of(frame: pd.DataFrame, figure: str, names: list[str]) -> bytes:
    """A figure against the parameters that vary, or its distribution where none does.

    A point without a mean, since runs did not reach the figure, has its median, or else an arrow at
    the greatest value that was reached.
    """
    from matplotlib.figure import Figure

    done = frame[frame["status"] != FAILED]
    numeric = [n for n in names if done[n].nunique() > 1 and done[n].dtype.kind in "if"]
    drawn: Figure = Figure(figsize=(6.4, 3.8), dpi=110, layout="constrained")
    axes = drawn.subplots()
    axes.grid(alpha=0.3)
    if not numeric:
        values = observed(done, figure)
        reached = np.isfinite(values)
        axes.hist(values[reached], bins="auto", color="#2166ac")
        axes.set(xlabel=figure, ylabel="runs")
        if not reached.all():
            axes.set_title(f"not reached in {len(values) - reached.sum()} of {len(values)} runs")
        return picture(drawn)
    numeric.sort(key=lambda name: -done[name].nunique())
    along = numeric[0]
    by = [n for n in names if n != along and 1 < done[n].nunique() <= 8]
    for value, of in done.groupby(by[0]) if by else [(None, done)]:
        label = None if value is None else f"{by[0]} {value_text(value)}"
        across = np.unique(of[along].dropna())
        by_point = [observed(of[of[along] == x], figure) for x in across]
        means = [estimate(f"mean {figure}", each) for each in by_point]
        middle = [np.nan if each.value is None else each.value for each in means]
        half = [each.half_width or 0.0 for each in means]
        [line, *_] = axes.errorbar(across, middle, half, marker="o", capsize=3, label=label)
        for marker in _MARKS:
            instead = [_instead(figure, each, marker) for each in by_point]
            axes.plot(across, instead, marker, color=line.get_color(), fillstyle="none")
    if lacking := int(np.isinf(observed(done, figure)).sum()):
        for marker, said in _MARKS.items():
            axes.plot([], [], marker, color="#555555", fillstyle="none", label=said)
        axes.set_title(f"not reached in {lacking} of {len(done)} runs", fontsize=9)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, fontsize=8)
    axes.set(xlabel=along, ylabel=f"{figure}, mean and 95 % interval")
    return picture(drawn)


def _instead(figure: str, values: NDArray[np.float64], marker: str) -> float:
    """What a marker stands for at a point, or nan where it does not."""
    if not np.isinf(values).any():
        return np.nan
    median = estimate(f"p50 {figure}", values)
    found = median.value if marker == "v" else median.beyond
    return np.nan if found is None else found


def value_text(value: Any) -> str:
    """A parameter's value as pages and pictures have it."""
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
