"""Pictures that show measured and simulated figures in different styles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Look:
    """Colour and label of one side of a comparison."""

    colour: str
    label: str
    marker: str

    @property
    def line(self) -> dict[str, Any]:
        """Keywords of a line with its markers."""
        return {"color": self.colour, "label": self.label, "marker": self.marker, "markersize": 4}

    @property
    def dots(self) -> dict[str, Any]:
        """Keywords of markers alone."""
        return {**self.line, "linestyle": "none"}


MEASURED = Look("#7f7f7f", "experiments", "s")
OURS = Look("#2166ac", "mesa-mobility", "o")
OTHER = Look("#d6604d", "", "^")


def panels(count: int) -> tuple[Figure, list[Axes]]:
    """A figure of panels side by side."""
    figure = Figure(figsize=(4.8 * count, 3.8), dpi=120, layout="constrained")
    return figure, list(figure.subplots(1, count, squeeze=False).flat)


def band(
    axes: Axes, x: ArrayLike, low: ArrayLike, middle: ArrayLike, high: ArrayLike, look: Look
) -> None:
    """A line with a band about it."""
    axes.fill_between(x, low, high, color=look.colour, alpha=0.2, linewidth=0)
    axes.plot(x, middle, **look.line)


def finish(axes: Sequence[Axes]) -> None:
    """Legends, grids and origins."""
    for each in axes:
        each.grid(alpha=0.3)
        each.set_ylim(bottom=min(0.0, each.get_ylim()[0]))
        if each.get_legend_handles_labels()[0]:
            each.legend(frameon=False, fontsize=8)


def numbers(values: Sequence[float | None]) -> list[float]:
    """Figures to draw; empty if nothing was measured."""
    return [float("nan") if value is None else value for value in values]
