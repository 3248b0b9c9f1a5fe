"""Scenes with published figures: necks, people alone, single files, crowded corridors."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.default_preset.closeness import off
from mesa_mobility.validation.bottleneck import DENSITY_IN_FRONT, START, density_in_front, plan
from mesa_mobility.validation.scenes import corridors, wide_necks
from mesa_mobility.verification.references import bottleneck_fit, corridor_band, published
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate, steady_flow
from mesa_mobility.verification.scenarios.tracks.single_file import single_file
from mesa_mobility.verification.scenarios.tracks.track import track

NECKS = {0.9: 90, 1.6: 120, 3.6: 150}
"""Width of each neck, metres, and how many people go through."""
LONGEST_S = 120.0
"""Measured people take less than a minute."""
IN_LINE = (14, 23, 33, 43, 48)
"""How many people walk round the oval."""
CROWDED = (2.0, 3.0, 4.0)
"""Persons a square metre in a closed corridor 2 m wide."""
STANDS = 0.03
"""Added to both speeds of single files, m/s, so that a ratio exists where people stand."""
ALONE = {"turns": 4.374, "across": 0.126, "speed_changes": 0.060}
"""Of people who walk alone: standard deviation of the change of direction from step to step,
degrees, of the lateral step, m, and of the change of speed, m/s (row "free walk 3 m corridor" of
``motion_in_crowds.csv``)."""


def neck(seed: int, *, width: float) -> dict[str, Any]:
    """Flow and density in front of a neck, simulated."""
    people = NECKS[width]
    floor = plan(width)
    model = crowd_model(floor, seed)
    places = floor.random_points(
        people, model.rng, within=START, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    run = evacuate(model, LONGEST_S)
    gate = floor.gates[0]
    times = run.crossing_times(gate.a, gate.b)
    first, last = round(people / 6) - 1, round(people * 5 / 6) - 1
    if len(times) <= last:
        return {"flow": len(times) / LONGEST_S, "density": None}
    return {
        "flow": steady_flow(times, people),
        "density": density_in_front(run, times[first], times[last]),
    }


def of_necks(width: float) -> dict[str, tuple[float, float]]:
    """Least and greatest flow and density measured: of narrow necks the fit and the range of many
    experiments, of wide ones the experiment."""
    if width not in wide_necks.MEASURED:
        flow = bottleneck_fit(width)
        return {"flow": (flow, flow), "density": DENSITY_IN_FRONT}
    row = wide_necks.MEASURED[width]
    flow, density = float(row["flow_1_s"]), float(row["density_in_front_1_m2"])
    return {"flow": (flow, flow), "density": (density, density)}


def alone(seed: int) -> dict[str, float]:
    """Standard deviations of ``ALONE``, simulated."""
    found = corridors.alone(seed)
    return {
        "turns": float(np.degrees(found["turns"].std())),
        "across": float(found["across"].std()),
        "speed_changes": float(found["speed_changes"].std()),
    }


def in_line(seed: int, *, people: int) -> dict[str, float]:
    """Density and speed in single file, simulated: persons a metre, and m/s."""
    found = single_file(seed, people=people)
    speed = float(np.median(found["along"]))
    return {"density": float(np.median(found["density"])), "speed": max(speed, 0.0) + STANDS}


def crowded(seed: int, *, density: float) -> dict[str, float]:
    """Density and mean speed in a closed corridor, simulated: persons a square metre, and m/s."""
    found = track(seed, density=density, width=2.0, speed=1.34, settle_s=10.0, measure_s=20.0)
    return {"density": found["mean_density"], "speed": max(found["mean_speed"], 0.0) + STANDS}


def far(simulated: dict[str, float | None], measured: dict[str, tuple[float, float]]) -> float:
    """How far necks are off what was measured: 6 % of the flow count as 1, and 12 % of the
    density."""
    tolerances = {"flow": 0.06, "density": 0.12}
    ratios = {}
    for name, (low, high) in measured.items():
        value = simulated[name] or 0.0
        ratios[name] = (value / min(max(value, low), high), tolerances[name])
    return off(ratios)


def far_alone(simulated: dict[str, float], measured: dict[str, float]) -> float:
    """How far people alone are off: a quarter counts as 1."""
    return off({name: (simulated[name] / value, 0.25) for name, value in measured.items()})


def far_at_density(simulated: dict[str, float], measured: dict[str, list[float]]) -> float:
    """How far single files and corridors are off the published speeds at their density: 24 % count
    as 1."""
    speed = float(np.interp(simulated["density"], measured["density"], measured["speed"]))
    return off({"speed": (simulated["speed"] / (speed + STANDS), 0.24)})


def published_crowded() -> dict[str, list[float]]:
    """The median speed at each density of a corridor."""
    density = np.arange(0.5, 6.0, 0.1)
    return {"density": density.tolist(), "speed": corridor_band(density)[1].tolist()}


def published_in_line() -> dict[str, list[float]]:
    """The published fundamental diagram of single file."""
    found = published("1D single file")
    return {"density": found["density"].tolist(), "speed": found["v_mean"].tolist()}
