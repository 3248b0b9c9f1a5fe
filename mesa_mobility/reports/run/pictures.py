"""Pictures of the report of a run."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from mesa_mobility.reports.html import picture
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.plots import TYPE_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PAGE = 7.6, 5.4
"""Largest width and height of pictures of the plan, inches: as a page of A4 shows them."""

_MOST_DOORS = 8
"""Doors with a curve; more cannot be told apart."""


def drawn(plot: Callable[[str | os.PathLike[str]], None]) -> bytes:
    """The PNG that a function draws to the path that it gets."""
    with tempfile.TemporaryDirectory(prefix="mesa-mobility-report-") as folder:
        path = Path(folder) / "picture.png"
        plot(path)
        return path.read_bytes()


def n_t_curves(measured: Measured) -> bytes:
    """How many people have passed each door by each time."""
    figure, axes = _axes()
    chosen = _most_used(measured)
    for colour, door in zip(cycle(TYPE_COLOURS), chosen, strict=False):
        own = measured.n_t[measured.n_t["door"] == door]
        axes.step(own["time_s"], own["people"], where="post", color=colour, label=door)
    axes.set_ylabel("people who have passed (N)")
    return _finished(figure, axes, measured)


def queue_curves(measured: Measured) -> bytes:
    """How many people wait before each door, second by second."""
    figure, axes = _axes()
    chosen = _most_used(measured)
    for colour, door in zip(cycle(TYPE_COLOURS), chosen, strict=False):
        own = measured.queues[measured.queues["door"] == door]
        axes.plot(own["time_s"], own["people"], color=colour, label=door)
    axes.set_ylabel("people who wait before the door")
    return _finished(figure, axes, measured)


def left_out(measured: Measured) -> int:
    """How many doors that people passed have no curve."""
    return max(measured.n_t["door"].nunique() - _MOST_DOORS, 0)


def _most_used(measured: Measured) -> list[str]:
    """The doors with most passages, in the order of the table of doors."""
    most = set(measured.n_t["door"].value_counts().index[:_MOST_DOORS])
    return [str(name) for name in measured.doors.loc["all"].index if name in most]


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
        axes.legend(frameon=False, fontsize=9)
    return picture(figure)
