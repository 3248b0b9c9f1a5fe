"""A comparison of measured tracks with replays of them, as `mesa-mobility validate` runs it."""

from __future__ import annotations

import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mesa_mobility import FloorPlan, Trajectories
from mesa_mobility.buildings import read_floor
from mesa_mobility.distributions import parse
from mesa_mobility.results.columns import COLUMNS
from mesa_mobility.results.distances import Comparison, Distance, compare
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.validation.tracks.pictures import draw, thinned
from mesa_mobility.validation.tracks.setting import Setting
from mesa_mobility.verification import Verdict, case
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, within
from mesa_mobility.verification.runs import Run, crowd_model

ALLOWED = 0.7, 1.4
"""How many times as large as measured a figure may be."""
FLOW_ALLOWED = 0.88, 1.12
JUDGED = {
    "density": "density 1/m2",
    "speed": "speed m/s",
    "direction_change": "sd of direction change deg",
    "lateral_step": "sd of lateral step m",
    "speed_change": "sd of speed change m/s",
    "acceleration": "acceleration m/s2, p99",
}
"""Figures that must be as measured, and what tables call them."""
SHOWN = (
    *JUDGED,
    "time_headway",
    "n_t",
    "speed_density",
    "distance_headway",
    "dwell_time",
    "lane_order",
    "speed_jump",
)


def experiment(setting: Setting, plan: FloorPlan, tracks: Trajectories) -> Experiment:
    """The comparison of a measured run with its replay.

    Args:
        setting: where and when people are measured.
        plan: the floor.
        tracks: those of the setting's file.
    """
    numbers = {
        "file": setting.file,
        "unit": setting.unit,
        "frame_rate": setting.frame_rate,
        "plan": setting.plan_file,
        "start": setting.start,
        "seconds": setting.seconds,
        "speeds": setting.speeds,
        "exits": setting.exits,
        "level": setting.level,
    }
    return Experiment(
        name=Path(setting.file).stem,
        what=f"measured people and their replay, {setting}",
        source=f"{Path(setting.file).name}, {setting.frame_rate:g} frames a second",
        criterion="Measured at the same times and places, density, speed and the motion of single "
        "people of the replay are 0.7 to 1.4 times as measured, and the flow is within 12 %",
        cases=(case(replayed, effort=10.0, **numbers),),
        judge=partial(judge, setting=setting, plan=plan, tracks=tracks),
        draw=partial(draw, setting=setting, plan=plan),
    )


def replayed(
    seed: int,
    *,
    file: str,
    unit: str,
    frame_rate: float,
    plan: str,
    start: int,
    seconds: float,
    speeds: str | None,
    exits: str | None = None,
    level: str | None = None,
) -> Figures:
    """A replay of measured tracks.

    Args:
        seed: of the run.
        file: of the tracks.
        unit: of its coordinates.
        frame_rate: frames a second.
        plan: file of the floor plan.
        start: frame of the tracks at which the replay begins.
        seconds: of the replay.
        speeds: free speeds as a distribution's text; None for the type's.
        exits: of a floor plan whose file has none.
        level: of a file that has several.

    Returns:
        With what every run tells: ``tracks``, the columns of the trajectories by name,
        ``moved_m``, the greatest distance by which somebody was moved for room at the start, and
        ``late``, people who had not come in by the end.
    """
    with warnings.catch_warnings():
        # The command has shown what is wrong with the tracks.
        warnings.simplefilter("ignore")
        tracks = Trajectories.read(file, unit=unit, frame_rate=frame_rate)
        floor = read_floor(plan, exits, level=level)
        model = crowd_model(floor, seed)
        replay = model.replay(
            tracks, start, preferred_speeds=None if speeds is None else parse(speeds)
        )
    walls = model.floor_plan.walls
    while model.elapsed < seconds:
        model.step()
    run = Run(model, walls)
    found = run.trajectories
    arrivals = replay.arrivals
    due = arrivals["frame"] <= model.frame
    return {
        **run.figures(),
        "tracks": {name: getattr(found, name) for name in COLUMNS},
        "frame_rate": found.frame_rate,
        "moved_m": float(replay.moved.max(initial=0.0)),
        "late": int(np.count_nonzero(due & (arrivals["row"] < 0))),
    }


def judge(runs: Runs, *, setting: Setting, plan: FloorPlan, tracks: Trajectories) -> Verdict:
    """Density, speed and the motion of single people 0.7 to 1.4 times as measured, and the flow
    within 12 %."""
    (own,) = zip(*runs, strict=True)
    simulated = [Trajectories(**each["tracks"], frame_rate=each["frame_rate"]) for each in own]
    view, measured_view = setting.replayed_view(plan.free), setting.view(plan.free)
    found = compare(simulated, tracks, view, measured_view=measured_view, figures=SHOWN)
    checks = [_flow(found["time_headway"])]
    checks += [_judged(found[name], called) for name, called in JUDGED.items()]
    numbers: dict[str, float] = {}
    for each in found.distances.values():
        numbers[f"{each.name}: measured {each.unit}"] = each.measured
        numbers[f"{each.name}: distance {each.unit}"] = float(each.distance.middle)
    return Verdict(
        tuple(checks),
        {
            **numbers,
            "greatest way by which somebody was moved for room m": max(e["moved_m"] for e in own),
            "people who could not come in": max(each["late"] for each in own),
            "envelopes": _envelopes(found),
            "curves": _curves(found),
            "samples": _samples(found),
            "tracks": [
                thinned(measured_view.of(tracks)).tolist(),
                thinned(view.of(simulated[0])).tolist(),
            ],
        },
    )


def _flow(headway: Distance) -> Check:
    """The flow, from the mean time between passages."""
    measured, ours = 1.0 / headway.measured, 1.0 / float(headway.simulated.middle)
    low, high = (each * measured for each in FLOW_ALLOWED)
    return within("flow 1/s", ours if np.isfinite(ours) else None, low, high)


def _judged(distance: Distance, called: str) -> Check:
    low, high = (each * distance.measured for each in ALLOWED)
    ours = float(distance.simulated.middle)
    return within(called, ours if np.isfinite(ours) else None, low, high)


def _envelopes(found: Comparison) -> dict[str, Any]:
    """Quantiles 0.05, 0.5 and 0.95 of each figure over the seeds."""
    return {
        name: [float(of) for of in (each.simulated.low, each.simulated.middle, each.simulated.high)]
        for name, each in found.distances.items()
    }


def _curves(found: Comparison) -> dict[str, Any]:
    """Curves to draw: measured, and the envelope of the seeds."""
    curves = {}
    for name in ("n_t", "speed_density"):
        each = found[name]
        assert each.curve is not None
        assert each.measured_curve is not None
        curves[name] = {
            "measured": each.measured_curve.tolist(),
            "low": each.curve.low.tolist(),
            "middle": each.curve.middle.tolist(),
            "high": each.curve.high.tolist(),
        }
    return curves


def _samples(found: Comparison) -> dict[str, Any]:
    """Samples to draw, to the millimetre."""
    samples = {}
    for name in ("speed", "lateral_step"):
        each = found[name]
        assert each.sample is not None
        assert each.measured_sample is not None
        samples[name] = {
            "measured": each.measured_sample.round(3).tolist(),
            "simulated": each.sample.round(3).tolist(),
        }
    return samples
