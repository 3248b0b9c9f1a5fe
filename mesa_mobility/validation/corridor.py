"""Fundamental diagram of an endless corridor 1.8 m wide.

The speed of a sparse crowd depends on people's free walking speed. Participants in the recorded
corridors were students, 0.2 m/s faster than the people of the default preset. The
corridor is therefore simulated twice, with crowds that differ only in that speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.crowd.types.free_speeds import ADULTS
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, falling, within
from mesa_mobility.verification.references import corridor_band
from mesa_mobility.verification.scenarios.tracks.track import DENSITY_BIN, binned, track

DENSITIES = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
AT_DENSITIES = (0.5, 1.125, 1.625, 2.125, 3.125)
"""Densities at which the speed must lie within the reference, persons/m2: bins of it."""
WIDTH = 1.8
RECORDED = replace(ADULTS, mean=1.55, sd=0.18)
"""Free speeds in the recorded corridors, m/s (HERMES, 42 students: Liao et al.
2014), in the range that the default preset has."""
AS_RECORDED = "speeds as recorded"
"""Name of that crowd in figures and checks; the preset's crowd has none."""


def near(runs: Sequence[Figures], density: float) -> np.ndarray:
    """Speeds of people whose individual density is within a quarter of the given one."""
    densities = np.concatenate([each["density"] for each in runs])
    along = np.concatenate([each["along"] for each in runs])
    reach = DENSITY_BIN / 2 if density > 0.75 else DENSITY_BIN
    return along[np.abs(densities - density) <= reach]


def judge(runs: Runs) -> Verdict:
    """Median speed of either crowd, at each density, within p10 to p90 of the reference."""
    preset, recorded = (
        [row[first : first + len(DENSITIES)] for row in runs] for first in (0, len(DENSITIES))
    )
    checks, figures = _judged(preset, "")
    theirs, beside = _judged(recorded, f"{AS_RECORDED}: ")
    return Verdict((*checks, *theirs), {"global density": list(DENSITIES), **figures, **beside})


def _judged(runs: Runs, crowd: str) -> tuple[list[Check], dict[str, Any]]:
    """Checks and figures of one crowd, each prefixed with its name."""
    flat = [each for row in runs for each in row]
    checks: list[Check] = []
    for density in AT_DENSITIES:
        speeds = near(flat, density)
        low, _, high = corridor_band(density)
        median = float(np.median(speeds)) if len(speeds) >= 20 else None
        checks.append(within(f"{crowd}v at {density:.1f}/m2", median, float(low), float(high)))
    bins = binned(flat)
    _, reference, _ = corridor_band(bins["density"])
    cases = list(zip(*runs, strict=True))
    speeds_at = [float(np.mean([each["mean_speed"] for each in of])) for of in cases]
    figures = {
        "bins": {name: values.tolist() for name, values in bins.items()},
        "reference p50": reference.tolist(),
        "mean speed": speeds_at,
        "specific flow": [
            float(np.mean([each["mean_speed"] * each["mean_density"] for each in of]))
            for of in cases
        ],
        "rms difference of medians m/s": float(np.sqrt(np.mean((bins["p50"] - reference) ** 2))),
        "fallback share by density": [
            float(np.mean([each["fallback_time_share"] for each in of])) for of in cases
        ],
    }
    checks.append(
        falling(f"{crowd}least fall of the mean speed with density", speeds_at, gates=False)
    )
    return checks, {f"{crowd}{name}": value for name, value in figures.items()}


def draw(figures: dict[str, Any]) -> Figure:
    """Speed against individual density, measured and of either crowd, and specific flow."""
    figure, axes = charts.panels(3)
    flow = axes[2]
    for panel, crowd, title, colour in (
        (axes[0], "", "speeds of the preset", charts.OURS.colour),
        (axes[1], f"{AS_RECORDED}: ", AS_RECORDED, charts.OTHER.colour),
    ):
        look = charts.Look(colour, f"mesa-mobility, {title}", "o")
        bins = {name: np.array(values) for name, values in figures[f"{crowd}bins"].items()}
        low, middle, high = corridor_band(bins["density"])
        charts.band(panel, bins["density"], low, middle, high, charts.MEASURED)
        charts.band(panel, bins["density"], bins["p10"], bins["p50"], bins["p90"], look)
        panel.set_ylabel("speed along the corridor over 1.5 s (m/s)")
        flow.plot(bins["density"], bins["density"] * bins["p50"], **look.line)
    flow.plot(bins["density"], bins["density"] * middle, **charts.MEASURED.line)
    flow.set_ylabel("median speed times density (persons/(m s))")
    for panel in axes:
        panel.set_xlabel("individual density (persons/m²)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="corridor",
    what="speed against density in an endless corridor 1.8 m wide",
    source="corridors of HERMES 2009 and BaSiGo 2013 (data archive of Forschungszentrum Jülich), "
    "evaluated by individual Voronoi density with PedPy",
    criterion="At five densities the median speed lies between the 10th and the 90th percentile of "
    "the measured people. The corridor is simulated with the free speeds of the preset, "
    "and with those of the measured people",
    cases=tuple(
        case(track, effort=1.0 + 2.0 * each, density=each, width=WIDTH, speed=speed)
        for speed in (None, RECORDED)
        for each in DENSITIES
    ),
    judge=judge,
    draw=draw,
)
