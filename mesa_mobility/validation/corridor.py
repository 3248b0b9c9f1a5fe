"""Fundamental diagram: walkers in a corridor 1.8 m wide without an end."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.validation import drawing
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case
from mesa_mobility.verification.checks import Check, falling, within
from mesa_mobility.verification.references import corridor_band
from mesa_mobility.verification.scenarios.track import DENSITY_BIN, binned, track

DENSITIES = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)
ASKED = (0.5, 1.125, 1.625, 2.125, 3.125)
"""Densities at which the speed must lie within the reference, persons/m2: bins of it."""
WIDTH = 1.8


def near(runs: Runs, density: float) -> np.ndarray:
    """Speeds of people whose individual density is within a quarter of the one asked for."""
    densities = np.concatenate([each["density"] for row in runs for each in row])
    along = np.concatenate([each["along"] for row in runs for each in row])
    reach = DENSITY_BIN / 2 if density > 0.75 else DENSITY_BIN
    return along[np.abs(densities - density) <= reach]


def judge(runs: Runs) -> Verdict:
    """Median speed at each density asked for within p10 to p90 of the reference."""
    checks: list[Check] = []
    for density in ASKED:
        speeds = near(runs, density)
        low, _, high = corridor_band(density)
        median = float(np.median(speeds)) if len(speeds) >= 20 else None
        checks.append(within(f"v at {density:.1f}/m2", median, float(low), float(high)))
    bins = binned([each for row in runs for each in row])
    _, reference, _ = corridor_band(bins["density"])
    cases = list(zip(*runs, strict=True))
    speeds_at = [float(np.mean([each["mean_speed"] for each in of])) for of in cases]
    figures = {
        "bins": {name: values.tolist() for name, values in bins.items()},
        "reference p50": reference.tolist(),
        "global density": list(DENSITIES),
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
    checks.append(falling("least fall of the mean speed with density", speeds_at, gates=False))
    return Verdict(tuple(checks), figures)


def draw(figures: dict[str, Any]) -> Figure:
    """Speed against individual density, measured and ours, and specific flow."""
    figure, axes = drawing.panels(2)
    bins = {name: np.array(values) for name, values in figures["bins"].items()}
    low, middle, high = corridor_band(bins["density"])
    drawing.band(axes[0], bins["density"], low, middle, high, drawing.MEASURED)
    drawing.band(axes[0], bins["density"], bins["p10"], bins["p50"], bins["p90"], drawing.OURS)
    axes[0].set_xlabel("individual density (1/m²)")
    axes[0].set_ylabel("speed along the corridor over 1.5 s (m/s)")
    axes[1].plot(bins["density"], bins["density"] * middle, **drawing.MEASURED.line)
    axes[1].plot(bins["density"], bins["density"] * bins["p50"], **drawing.OURS.line)
    axes[1].set_xlabel("individual density (1/m²)")
    axes[1].set_ylabel("median speed x density (1/(m s))")
    drawing.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="corridor",
    what="speed against density in an endless corridor 1.8 m wide",
    source="individual bins of HERMES and BaSiGo corridors (fd_corridor_individual_bins.csv)",
    cases=tuple(
        case(track, effort=1.0 + 2.0 * each, density=each, width=WIDTH) for each in DENSITIES
    ),
    judge=judge,
    draw=draw,
)
