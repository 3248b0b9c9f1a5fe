"""People walking both ways in a corridor 4 m wide: speed and lanes."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from matplotlib.figure import Figure
from numpy.typing import NDArray
from shapely import box

from mesa_mobility import Exit, FloorPlan, Source
from mesa_mobility.results.measures.lanes import lane_order
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.checks import Check, at_least, more_than, within
from mesa_mobility.verification.references import published
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model

FloatArray = NDArray[np.float64]

LENGTH, WIDTH = 32.0, 4.0
BOX = box(12.0, 0.0, 20.0, WIDTH)
"""Measuring area of speed, density and lanes."""
ENTRY_M = (0.6, 1.6)
"""Distance of newcomers from either end, metres, clear of people who are just leaving."""
DENSITIES = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75)
SETTLE_S, MEASURE_S, WINDOW_S, EVERY_S = 30.0, 60.0, 1.5, 1.0
REFERENCE = "bo bidirectional"
LEAST_ORDER = 0.76
"""Least order measured in lanes at 0.75 to 1.75 persons/m2; shuffled people gave 0.22 to 0.48."""
STANDSTILL = 0.1
"""Mean speed below which counterflow counts as stuck, m/s."""


def both_ways(seed: int, *, density: float) -> dict[str, Any]:
    """People walk both ways in a corridor of 32 m x 4 m that is fed at either end.

    Args:
        seed: of the run.
        density: persons per square metre at the start.

    Returns:
        With what every run tells, over the middle 8 m: ``mean_speed`` in each one's own direction
        over 1.5 s (m/s), ``mean_density`` (1/m2), ``lane_order`` and the same with directions
        shuffled.
    """
    run = both_ways_run(seed, density=density)
    crowd = run.model.crowd
    east = crowd.destination[: run.model.population.count] == crowd.destination[0]
    return {
        **run.figures(),
        **_in_box(run, np.where(east, 1.0, -1.0), np.random.default_rng(seed)),
    }


def both_ways_run(seed: int, *, density: float) -> Run:
    """The run of ``both_ways``, with the same arguments.

    It starts with half of the people each way all over the corridor. People come in at the rate at
    which measured crowds of this density walked: where ours are slower than those, it fills up.
    """
    exits = [Exit("east", (LENGTH, 0.0), (LENGTH, WIDTH)), Exit("west", (0.0, 0.0), (0.0, WIDTH))]
    plan = FloorPlan(box(0.0, 0.0, LENGTH, WIDTH), exits=exits)
    model = crowd_model(plan, seed)
    places = plan.random_points(
        2 * round(density * LENGTH * WIDTH / 2), model.rng, spacing=SPACING, clearance=CLEARANCE
    )
    half = len(places) // 2
    model.add_pedestrians(places[:half], exits=["east"])
    model.add_pedestrians(places[half:], exits=["west"])
    reference = published(REFERENCE)
    speed = float(np.interp(density, reference["density"], reference["v_mean"]))
    near, far = ENTRY_M
    for name, low, high in (("east", near, far), ("west", LENGTH - far, LENGTH - near)):
        area = box(low, CLEARANCE, high, WIDTH - CLEARANCE)
        model.add_source(Source(area=area, rate=density * speed * WIDTH / 2, exits=[name]))
    while model.elapsed < SETTLE_S + MEASURE_S + WINDOW_S:
        model.step()
    return Run(model, plan.walls)


def _in_box(run: Run, sign: FloatArray, shuffle: np.random.Generator) -> dict[str, float | None]:
    tracks = run.trajectories
    start, end = tracks.steps(round(WINDOW_S * tracks.frame_rate))
    every = round(EVERY_S * tracks.frame_rate)
    frame = tracks.frame[start]
    now = (frame >= SETTLE_S * tracks.frame_rate) & (frame % every == 0)
    now &= shapely.contains_xy(BOX, tracks.x[start], tracks.y[start])
    start, end, frame = start[now], end[now], frame[now]
    direction = sign[tracks.person[start]]
    gone = (tracks.x[end] - tracks.x[start]) * direction
    order, shuffled = [], []
    by_frame = np.argsort(frame, kind="stable")
    for each in np.split(by_frame, np.flatnonzero(np.diff(frame[by_frame])) + 1):
        across = tracks.y[start[each]] - WIDTH / 2
        order.append(lane_order(across, direction[each]))
        shuffled.append(lane_order(across, shuffle.permutation(direction[each])))
    instants = MEASURE_S / EVERY_S
    return {
        "mean_speed": float(gone.mean() / WINDOW_S) if len(gone) else None,
        "mean_density": len(start) / instants / BOX.area,
        "lane_order": float(np.nanmean(order)) if len(start) else None,
        "lane_order_shuffled": float(np.nanmean(shuffled)) if len(start) else None,
    }


def judge(runs: Runs) -> Verdict:
    """Nobody is stuck, and people keep to lanes as measured."""
    columns = list(zip(*runs, strict=True))

    def over_seeds(name: str) -> list[float]:
        return [float(np.median([each[name] for each in of])) for of in columns]

    speeds, orders = over_seeds("mean_speed"), over_seeds("lane_order")
    densities = over_seeds("mean_density")
    reference = published(REFERENCE)
    checks: list[Check] = [
        more_than(
            "least mean speed of any run",
            min(each["mean_speed"] for row in runs for each in row),
            STANDSTILL,
        )
    ]
    for density, order in zip(DENSITIES, orders, strict=True):
        checks.append(
            at_least(f"lane order at {density:g}/m2", order, LEAST_ORDER, gates=density >= 0.75)
        )
    for density, there, speed in zip(DENSITIES, densities, speeds, strict=True):
        slowest, fastest = (
            float(np.interp(there, reference["density"], reference[name]))
            for name in ("v_min", "v_max")
        )
        checks.append(
            within(f"speed when fed for {density:g}/m2", speed, slowest, fastest, gates=False)
        )
    figures = {
        "density": list(DENSITIES),
        "measured density": densities,
        "mean speed": speeds,
        "lane order": orders,
        "lane order shuffled": over_seeds("lane_order_shuffled"),
        "fallback share": over_seeds("fallback_time_share"),
    }
    return Verdict(tuple(checks), figures)


def draw(figures: dict[str, Any]) -> Figure:
    """Speed and lane order against density."""
    figure, axes = charts.panels(2)
    reference = published(REFERENCE)
    shown = reference["density"] <= 2.5
    axes[0].errorbar(
        reference["density"][shown],
        reference["v_mean"][shown],
        yerr=[
            (reference["v_mean"] - reference["v_min"])[shown],
            (reference["v_max"] - reference["v_mean"])[shown],
        ],
        **charts.MEASURED.dots,
    )
    axes[0].plot(figures["measured density"], figures["mean speed"], **charts.OURS.dots)
    axes[0].set_ylabel("mean speed (m/s)")
    axes[1].axhspan(0.76, 0.94, color=charts.MEASURED.colour, alpha=0.3, label="experiments")
    axes[1].axhspan(
        0.22, 0.48, color=charts.OTHER.colour, alpha=0.15, label="experiments, shuffled"
    )
    axes[1].plot(figures["measured density"], figures["lane order"], **charts.OURS.dots)
    axes[1].plot(
        figures["measured density"],
        figures["lane order shuffled"],
        **{**charts.OTHER.dots, "label": "mesa-mobility, shuffled"},
    )
    axes[1].set_ylabel("lane order")
    axes[1].set_ylim(0, 1)
    for each in axes:
        each.set_xlabel("density (persons/m²)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="bidirectional",
    what="speed and lanes of people walking both ways in a corridor 4 m wide",
    source="corridors 3.6 m and 4 m wide of HERMES 2009 and BaSiGo 2013 with people walking "
    "both ways (data archive of Forschungszentrum Jülich)",
    criterion="Nobody is stuck (the mean speed of each run is above 0.1 m/s), and from 0.75 "
    "persons/m² on people keep to lanes as measured (lane order 0.76 or more); speeds are reported "
    "beside the measured range",
    cases=tuple(case(both_ways, effort=1.0 + 3.0 * each, density=each) for each in DENSITIES),
    judge=judge,
    draw=draw,
)
