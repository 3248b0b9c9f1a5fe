"""Pictures of the report of a run."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from mesa_mobility.reports.html import picture
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.plots import TYPE_COLOURS

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

PAGE = 7.6, 5.4
"""Largest width and height of pictures of the plan, inches: as a page of A4 shows them."""

_MOST_DOORS = 8
"""Doors with a curve; more cannot be told apart."""

_SEEN = 0.05
"""Share of the greatest number of people below which a curve would lie on the axis."""

_STYLES: list[dict[str, Any]] = [
    {"color": colour, "linestyle": line}
    for colour, line in zip(TYPE_COLOURS, cycle(("-", "--", "-.", ":")), strict=False)
]
"""Colours and strokes, so that curves differ in black and white, too."""


def drawn(plot: Callable[[str | os.PathLike[str]], None]) -> bytes:
    """The PNG that a function draws to the path that it gets."""
    with tempfile.TemporaryDirectory(prefix="mesa-mobility-report-") as folder:
        path = Path(folder) / "picture.png"
        plot(path)
        return path.read_bytes()


def n_t_curves(measured: Measured) -> tuple[bytes, int]:
    """How many people have passed each door by each time, and how many doors are left out."""
    curves = _curves(measured.n_t)
    figure, axes = _axes()
    for style, (door, own) in zip(cycle(_STYLES), curves.items(), strict=False):
        axes.step(own["time_s"], own["people"], where="post", label=door, **style)
    axes.set_ylabel("people who have passed (N)")
    return _finished(figure, axes, measured), measured.n_t["door"].nunique() - len(curves)


def queue_curves(measured: Measured) -> tuple[bytes, int]:
    """How many people wait before each door, second by second, and how many doors are left out."""
    waited = measured.queues[measured.queues["people"] > 0]
    curves = _curves(measured.queues)
    figure, axes = _axes()
    for style, (door, own) in zip(cycle(_STYLES), curves.items(), strict=False):
        axes.plot(own["time_s"], own["people"], label=door, **style)
    axes.set_ylabel("people who wait")
    return _finished(figure, axes, measured), waited["door"].nunique() - len(curves)


def _curves(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Curves of the doors with the greatest numbers of people, by door, in the table's order."""
    most = table.groupby("door", sort=False)["people"].max()
    seen = most[(most > 0) & (most >= _SEEN * most.max())]
    shown = seen.sort_values(ascending=False, kind="stable").index[:_MOST_DOORS]
    return {str(door): own for door, own in table.groupby("door", sort=False) if door in shown}


def _axes() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(7.2, 3.8), dpi=150, layout="constrained")
    axes = figure.subplots()
    axes.set_xlabel("time since the start (s)")
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _finished(figure: Figure, axes: Axes, measured: Measured) -> bytes:
    axes.set_xlim(0.0, max(measured.trajectories.duration, 1e-9) * 1.02)
    axes.set_ylim(bottom=0.0)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(frameon=False, fontsize=9, handlelength=3.0)
    return picture(figure)
