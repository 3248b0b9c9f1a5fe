"""Diagrams of speed and flow against density, beside what was measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mesa_mobility.verification import charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.judging import LEAST_ENTRIES, single_file_bins
from mesa_mobility.verification.references import (
    STAIR_DENSITIES,
    corridor_band,
    published,
    stair_band,
)
from mesa_mobility.verification.scenarios.tracks.track import binned

Runs = Sequence[Sequence[Figures]]
"""Figures of each case, for each seed in turn."""

_BAND = charts.Look(
    charts.MEASURED.colour, "measured in corridors: middle 80 % and median", charts.MEASURED.marker
)
_FOUND = charts.Look(charts.OURS.colour, "simulated: middle 80 % and median", charts.OURS.marker)
_RANGE = charts.Look(
    charts.MEASURED.colour, "measured in single file: range and mean", charts.MEASURED.marker
)

_STAIRS = "measured on stairs: slow to fast (Corbetta)"


def corridor_diagram(runs: Runs) -> Figure:
    """Speed and flow against individual density in a closed corridor, with the measured band."""
    flat = [figures for row in runs for figures in row]
    bins = binned(flat, LEAST_ENTRIES)
    low, middle, high = corridor_band(bins["density"])
    figure, (speed, flow) = charts.panels(2)
    charts.band(speed, bins["density"], low, middle, high, _BAND)
    charts.band(speed, bins["density"], bins["p10"], bins["p50"], bins["p90"], _FOUND)
    speed.set_ylabel("speed along the corridor (m/s)")
    density = bins["density"]
    charts.band(flow, density, density * low, density * middle, density * high, _BAND)
    flow.plot(
        [each["mean_density"] for each in flat],
        [each["mean_density"] * each["mean_speed"] for each in flat],
        **{**charts.OURS.dots, "label": "simulated: mean of each run"},
    )
    flow.set_ylabel("specific flow (persons/(m s))")
    for panel in (speed, flow):
        panel.set_xlabel("density (persons/m²)")
    charts.finish((speed, flow))
    return figure


def stair_diagram(runs: Runs) -> Figure:
    """Speed in plan against density on a stair, down and up, with the measured band."""
    figure, panels = charts.panels(2)
    for axes, up, title in zip(panels, (False, True), ("down", "up"), strict=True):
        bins = binned([row[int(up)] for row in runs], LEAST_ENTRIES)
        at = np.linspace(*STAIR_DENSITIES, 60)
        axes.fill_between(at, *stair_band(at, up=up), color=_BAND.colour, alpha=0.2, label=_STAIRS)
        charts.band(axes, bins["density"], bins["p10"], bins["p50"], bins["p90"], _FOUND)
        axes.set(title=title, xlabel="density (persons/m²)", ylabel="speed in plan (m/s)")
    charts.finish(panels)
    return figure


def single_file_diagram(bins: dict[str, NDArray[np.float64]]) -> Figure:
    """Speed against density in single file, with the measured range."""
    figure, (axes,) = charts.panels(1)
    reference = published("1D single file")
    charts.band(
        axes,
        reference["density"],
        reference["v_min"],
        reference["v_mean"],
        reference["v_max"],
        _RANGE,
    )
    charts.band(axes, bins["density"], bins["p10"], bins["p50"], bins["p90"], _FOUND)
    axes.set_xlabel("density (persons/m)")
    axes.set_ylabel("speed (m/s)")
    charts.finish([axes])
    return figure


def single_file_of(runs: Runs) -> Figure:
    """`single_file_diagram` of all runs."""
    return single_file_diagram(single_file_bins([figures for row in runs for figures in row]))


def filled_corridor_diagram(runs: Runs) -> Figure:
    """Speed and flow against density in a corridor that is filled, a point for each run."""
    figure, (speed, flow) = charts.panels(2)
    flat = [figures for row in runs for figures in row]
    density = charts.numbers([each["density"] for each in flat])
    dots = {**charts.OURS.dots, "label": "simulated, a run each"}
    speed.plot(density, charts.numbers([each["speed"] for each in flat]), **dots)
    flow.plot(density, charts.numbers([each["flow"] for each in flat]), **dots)
    speed.set_ylabel("mean speed (m/s)")
    flow.set_ylabel("specific flow (persons/(m s))")
    for panel in (speed, flow):
        panel.set_xlabel("density in the zone (persons/m²)")
    charts.finish((speed, flow))
    return figure


DIAGRAMS = {
    "corridor": corridor_diagram,
    "stairs": stair_diagram,
    "single file": single_file_of,
    "filled corridor": filled_corridor_diagram,
}
"""By the names that tests have for them."""
