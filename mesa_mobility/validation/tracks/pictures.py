"""The picture of a measured crowd and its replay."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from mesa_mobility import FloorPlan
from mesa_mobility.results.distances.figures import DENSITY_BIN
from mesa_mobility.results.floor import draw_floor
from mesa_mobility.results.tracks import Tracks
from mesa_mobility.validation.tracks.setting import Setting
from mesa_mobility.verification import charts

FloatArray = NDArray[np.float64]

PIECE_S = 0.5
"""Time of a straight piece of a drawn track, seconds."""
FASTEST = 1.8
"""Speed at which the colours end, m/s."""
LEAST_SPREAD = 0.02
"""By how much a histogram reaches beyond the values, in their unit."""
CURVES = ("speed", "lateral", "n_t", "fd")
WIDE = [["measured", "measured", "simulated", "simulated"], list(CURVES)]
TALL = [["measured", "simulated", "speed", "lateral"], ["measured", "simulated", "n_t", "fd"]]
"""Panels of floors that are wide, and of those that are tall."""


def thinned(tracks: Tracks) -> FloatArray:
    """(k, 5) pieces of tracks of 0.5 s: both ends (m, to the centimetre) and the speed (m/s)."""
    frames = max(round(PIECE_S * tracks.frame_rate), 1)
    start, end = tracks.steps(frames)
    kept = tracks.frame[start] % frames == 0
    start, end = start[kept], end[kept]
    x, y = tracks.x, tracks.y
    speed = np.hypot(x[end] - x[start], y[end] - y[start]) * tracks.frame_rate / frames
    return np.column_stack([x[start], y[start], x[end], y[end], speed]).round(2)


def draw(figures: dict[str, Any], *, setting: Setting, plan: FloorPlan) -> Figure:
    """Tracks measured and simulated side by side; below them speeds, lateral steps, N-t and speed
    against density."""
    figure, axes = _panels(plan)
    for name, title, pieces in zip(
        ("measured", "simulated"), ("measured", "simulated, seed 1"), figures["tracks"], strict=True
    ):
        shown = _tracks(axes[name], np.array(pieces).reshape(-1, 5), plan, setting)
        axes[name].set_title(title)
    bar = figure.colorbar(shown, ax=[axes["measured"], axes["simulated"]], pad=0.01, shrink=0.8)
    bar.set_label("speed over 0.5 s (m/s)")
    _histogram(axes["speed"], figures["samples"]["speed"], "speed over 1.5 s (m/s)")
    _histogram(axes["lateral"], figures["samples"]["lateral_step"], "lateral step of 1.5 s (m)")
    n_t, fd = figures["curves"]["n_t"], figures["curves"]["speed_density"]
    _curve(axes["n_t"], np.arange(len(n_t["low"])), n_t)
    axes["n_t"].set(xlabel="time (s)", ylabel="people over the line")
    _curve(axes["fd"], DENSITY_BIN * (np.arange(len(fd["low"])) + 0.5), fd)
    axes["fd"].set(xlabel="individual density (1/m\u00b2)", ylabel="median speed (m/s)")
    charts.finish([axes[name] for name in CURVES])
    return figure


def _panels(plan: FloorPlan) -> tuple[Figure, dict[str, Axes]]:
    x_low, y_low, x_high, y_high = plan.bounds
    shape = (y_high - y_low) / (x_high - x_low)
    if shape > 1.0:
        wide = float(np.clip(7.0 / shape, 2.0, 5.0))
        figure = Figure(figsize=(2.0 * wide + 9.5, 7.6), dpi=110, layout="constrained")
        ratios = [wide, wide, 4.4, 4.4]
        axes = figure.subplot_mosaic(TALL, width_ratios=ratios)  # type: ignore[arg-type]
    else:
        tall = float(np.clip(8.0 * shape, 2.0, 8.0))
        figure = Figure(figsize=(16.0, tall + 3.8), dpi=110, layout="constrained")
        axes = figure.subplot_mosaic(WIDE, height_ratios=[tall, 3.8])  # type: ignore[arg-type]
    return figure, axes


def _tracks(axes: Axes, pieces: FloatArray, plan: FloorPlan, setting: Setting) -> LineCollection:
    draw_floor(axes, plan)
    shown = LineCollection(
        list(pieces[:, :4].reshape(-1, 2, 2)),
        array=pieces[:, 4],
        cmap="viridis",
        norm=Normalize(0.0, FASTEST),
        linewidths=0.5,
        zorder=3,
    )
    axes.add_collection(shown)
    outline = np.asarray(setting.area.exterior.coords)
    axes.add_patch(Polygon(outline, fill=False, linestyle="--", edgecolor="black", zorder=6))
    axes.plot(*np.transpose(setting.line), color=charts.OTHER.colour, linewidth=2.0, zorder=6)
    return shown


def _histogram(axes: Axes, samples: dict[str, list[float]], label: str) -> None:
    both = np.concatenate([samples["measured"], samples["simulated"]])
    low, high = np.percentile(both, (0.2, 99.8)) if len(both) else (0.0, 0.0)
    edges = np.linspace(low - LEAST_SPREAD, high + LEAST_SPREAD, 41)
    for name, look, how in (
        ("measured", charts.MEASURED, "stepfilled"),
        ("simulated", charts.OURS, "step"),
    ):
        values = np.array(samples[name])
        mean, sd = (values.mean(), values.std()) if len(values) else (np.nan, np.nan)
        axes.hist(
            values,
            bins=edges.tolist(),
            density=bool(len(values)),
            histtype=how,  # type: ignore[arg-type]
            color=look.colour,
            alpha=0.5 if name == "measured" else 1.0,
            label=f"{name}, mean {mean:.2f}, sd {sd:.3f}",
        )
    axes.set(xlabel=label, ylabel="share per unit")


def _curve(axes: Axes, x: NDArray[Any], curve: dict[str, list[float]]) -> None:
    n = len(curve["measured"])
    axes.plot(x[:n], curve["measured"][: len(x)], **{**charts.MEASURED.line, "label": "measured"})
    charts.band(
        axes,
        x,
        curve["low"],
        curve["middle"],
        curve["high"],
        charts.Look(charts.OURS.colour, "simulated, all seeds", ""),
    )
