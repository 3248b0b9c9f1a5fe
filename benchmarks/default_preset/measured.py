"""The measured runs that the preset `default` is calibrated on, and how far their replays are off.

They are of the archive of Forschungszentrum Juelich (https://ped.fz-juelich.de/da): corridors of
HERMES (2009) and BaSiGo (2013), and the gate of https://doi.org/10.34735/ped.2018.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import shapely
from shapely import Polygon, affinity, box

from benchmarks.default_preset.closeness import off
from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.distributions import parse
from mesa_mobility.results.distances import View, compare

FIGURES = ("density", "speed", "direction_change", "lateral_step", "speed_change", "acceleration")
TOLERANCES = {
    "flow": 0.06,
    "density": 0.12,
    "speed": 0.12,
    "direction_change": 0.25,
    "lateral_step": 0.25,
    "speed_change": 0.25,
    "acceleration": 0.25,
}
"""How far a figure may be off to count as 1: a share of what was measured."""

CORRIDOR = Polygon(
    [(2.8, -6.5), (2.8, -4), (1.8, -4), (1.8, 4), (2.8, 4), (2.8, 8), (-1, 8), (-1, 4), (0, 4),
     (0, -4), (-1, -4), (-1, -6.5)]
)  # fmt: skip
CORRIDOR_WITH_EXIT = CORRIDOR.difference(
    shapely.union_all([box(0, -4.05, 0.3, -3.95), box(1.5, -4.05, 1.8, -3.95)])
)
BOTH_WAYS = box(-6, -0.2, 5, 4.35)
BARRIER = Polygon(
    [(-0.7, -1.1), (-0.25, -1.1), (-0.25, -0.15), (-0.4, 0), (-2.8, 0), (-2.8, 6.7), (-3.05, 6.7),
     (-3.05, -0.3), (-0.7, -0.3)]
)  # fmt: skip
GATE = box(-3.5, -2, 3.5, 8).difference(
    shapely.union_all([BARRIER, affinity.scale(BARRIER, -1, 1, origin=(0, 0))])
)


@dataclass(frozen=True)
class MeasuredRun:
    """A measured run, its floor, and where and when both crowds are measured.

    Attributes:
        file: name of the file of tracks.
        unit: of its coordinates.
        rate: frames a second.
        plan: makes the floor plan.
        start: frame at which the replay begins.
        window: first and last frame that are measured.
        speeds: free speeds of the simulated people, as a distribution's text.
        direction: (x, y) of the crowd.
        line: both ends of the line that people cross, metres.
        areas: polygons in which people are measured, metres.
    """

    file: str
    unit: str
    rate: float
    plan: Callable[[], FloorPlan]
    start: int
    window: tuple[int, int]
    speeds: str
    direction: tuple[float, float]
    line: tuple[tuple[float, float], tuple[float, float]]
    areas: tuple[Polygon, ...]

    def view(self, area: Polygon, zero: int) -> View:
        """Of tracks whose time begins at frame ``zero`` of the file."""
        first, last = ((frame - zero) / self.rate for frame in self.window)
        return View(direction=self.direction, area=area, line=self.line, after=first, until=last)


def _corridor(floor: Polygon) -> FloorPlan:
    return FloorPlan(floor, exits=[Exit("out", (2.8, -6.5), (-1, -6.5))])


def corridor() -> FloorPlan:
    """The corridor 1.8 m wide, with the wider floor on either side."""
    return _corridor(CORRIDOR)


def corridor_with_exit() -> FloorPlan:
    """The same with an exit of 1.2 m at its end."""
    return _corridor(CORRIDOR_WITH_EXIT)


def both_ways() -> FloorPlan:
    """The wide corridor that people walk both ways."""
    low, _, high, _ = BOTH_WAYS.bounds
    ends = [("left", low), ("right", high)]
    return FloorPlan(BOTH_WAYS, exits=[Exit(name, (x, -0.2), (x, 4.35)) for name, x in ends])


def gate() -> FloorPlan:
    """The gate of 0.5 m between barriers."""
    return FloorPlan(GATE, exits=[Exit("out", (3.5, -2), (-3.5, -2))])


_FAST, _USUAL = "normal(1.55, 0.18)", "normal(1.34, 0.26)"

_ONE_WAY: dict[str, Any] = {
    "unit": "cm",
    "rate": 16.0,
    "speeds": _FAST,
    "direction": (0.0, -1.0),
    "line": ((0.0, 0.0), (1.8, 0.0)),
    "areas": (box(0, -3.5, 1.8, 3.5), box(-1, 2.0, 2.8, 7.4)),
}

RUNS = {
    "uo-060": MeasuredRun(
        file="uo-060-180-180.txt", plan=corridor, start=150, window=(243, 771), **_ONE_WAY
    ),
    "uo-070": MeasuredRun(
        file="uo-070-180-180.txt", plan=corridor, start=110, window=(203, 1113), **_ONE_WAY
    ),
    "uo-180-120": MeasuredRun(
        file="uo-180-180-120.txt",
        plan=corridor_with_exit,
        start=200,
        window=(300, 1099),
        **_ONE_WAY,
    ),
    "bi-corr": MeasuredRun(
        file="bi_corr_400_b_03.txt",
        unit="cm",
        rate=25.0,
        plan=both_ways,
        start=1000,
        window=(1250, 2250),
        speeds=_USUAL,
        direction=(1.0, 0.0),
        line=((-0.5, -0.2), (-0.5, 4.35)),
        areas=(box(-4, -0.2, 3, 4.35),),
    ),
    "gate": MeasuredRun(
        file="040_c_56_h-.txt",
        unit="m",
        rate=25.0,
        plan=gate,
        start=0,
        window=(125, 1250),
        speeds=_USUAL,
        direction=(0.0, -1.0),
        line=((-0.25, -0.15), (0.25, -0.15)),
        areas=(box(-1.5, 0.2, 1.5, 3),),
    ),
}
"""By name.  Free speeds are those of the archive's pages, or of measured walkers alone."""

FOLDS = {
    "corridors": ("uo-060", "uo-070"),
    "exit": ("uo-180-120",),
    "both-ways": ("bi-corr",),
    "gate": ("gate",),
}
"""Runs that are left out of a calibration together."""


def read(path: str, name: str) -> Trajectories:
    """The measured tracks of a run."""
    return Trajectories.read(path, unit=RUNS[name].unit, frame_rate=RUNS[name].rate)


def replay(seed: int, *, name: str, path: str) -> PedestrianModel:
    """A replay of a measured run."""
    run = RUNS[name]
    model = PedestrianModel(run.plan(), record=True, rng=seed)
    model.replay(read(path, name), run.start, preferred_speeds=parse(run.speeds))
    while model.elapsed < (run.window[1] - run.start) / run.rate + 0.1:
        model.step()
    return model


def figures(simulated: Trajectories, measured: Trajectories, name: str) -> dict[str, float]:
    """Simulated over measured, by figure, in each area of a run."""
    run = RUNS[name]
    found: dict[str, float] = {}
    for k, area in enumerate(run.areas):
        view, measured_view = run.view(area, run.start), run.view(area, 0)
        compared = compare(
            [simulated],
            measured,
            view,
            measured_view=measured_view,
            figures=(*FIGURES, "time_headway"),
        )
        found |= {f"{each} {k}": compared[each].ratio for each in FIGURES}
        found["flow"] = 1.0 / compared["time_headway"].ratio
    return found


def distance(simulated: Trajectories, measured: Trajectories, *, name: str) -> float:
    """Mean square of how far the figures of a replay are off."""
    found = figures(simulated, measured, name)
    return off({each: (value, TOLERANCES[each.split()[0]]) for each, value in found.items()})
