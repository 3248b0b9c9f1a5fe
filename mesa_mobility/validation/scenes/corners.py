"""Corners: lone people who walk round one, and a crowd in an L-shaped corridor."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Source
from mesa_mobility.results.distances import View, compare
from mesa_mobility.validation.conditions import condition_of, conditions, median
from mesa_mobility.validation.corridor import RECORDED
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, at_most, exactly, within
from mesa_mobility.verification.references import published
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model, evacuate

FloatArray = NDArray[np.float64]

WIDTH, LEG = 2.4, 12.0
"""Of the corridor, and from the outer corner to either end, metres. It leads along +x, then +y."""
INNER = (LEG - WIDTH, WIDTH)
"""The inner corner, metres."""
BEFORE = box(LEG - WIDTH - 4.0, 0.0, LEG - WIDTH, WIDTH)
"""Measuring area: the last four metres before the corner."""
LINE = ((LEG - WIDTH, 0.0), (LEG - WIDTH, WIDTH))
DENSITY = 1.75
SETTLE_S, MEASURE_S = 40.0, 40.0
REFERENCE = "eo corner 2.4 m"
SAME_SPEED = 0.7, 1.4
"""Speed of the inner half of the corridor over that of the outer half: neither stands while the
other walks. Chosen, not measured."""
SAME_NUMBER = 0.3, 0.7
"""Share of the people before the corner who are in the inner half. Chosen, not measured."""
MOST_DETOUR = 1.25
"""Way of 95 % of lone people over the shortest one."""
WALKERS = 24


def corner_plan() -> FloorPlan:
    """Two legs, 2.4 m wide, at a right angle."""
    inner_x, inner_y = INNER
    floor = Polygon(
        [(0, 0), (LEG, 0), (LEG, LEG), (inner_x, LEG), (inner_x, inner_y), (0, inner_y)]
    )
    return FloorPlan(floor, exits=[Exit("end", (inner_x, LEG), (LEG, LEG))], name="corner")


def alone(seed: int) -> Figures:
    """People walk alone round the corner; ``detours`` (24,), of each the way over the shortest."""
    detours, runs = [], []
    for number in range(WALKERS):
        plan = corner_plan()
        model = crowd_model(plan, seed=WALKERS * seed + number)
        y = CLEARANCE + (WIDTH - 2.0 * CLEARANCE) * number / (WALKERS - 1)
        model.add_pedestrians([(1.0, y)], headings=[0.0])
        run = evacuate(model, 60.0)
        runs.append(run)
        detours.append(detour(run.track(0)[1]))
    figures = [run.figures() for run in runs]
    person_s = sum(each["person_s"] for each in figures)
    spent = sum(each["fallback_time_share"] * each["person_s"] for each in figures)
    return {
        **{n: sum(each[n] for each in figures) for n in ("overlaps", "wall_crossings", "person_s")},
        "left_inside": sum(each["left_inside"] for each in figures),
        "fallback_time_share": spent / person_s,
        "detours": np.array(detours),
    }


def detour(places: FloatArray) -> float:
    """(n, 2) a way round the corner over the shortest one from its first to its last place, which
    touches the inner corner unless it passes it."""
    walked = float(np.hypot(*np.diff(places, axis=0).T).sum())
    (ax, ay), (bx, by) = places[0], places[-1]
    x, y = INNER
    straight = float(np.hypot(bx - ax, by - ay))
    left_of_corner = (bx - ax) * (y - ay) - (by - ay) * (x - ax) < 0.0
    round_it = float(np.hypot(x - ax, y - ay) + np.hypot(bx - x, by - y))
    return walked / (round_it if left_of_corner else straight)


def crowd(seed: int) -> Figures:
    """People walk through the corridor, fed as measured crowds of 1.75 persons/m2 walked.

    Returns:
        The common figures; before the corner ``density``, ``speed`` and ``flow``,
        ``inner_speed`` and ``outer_speed`` of either half (m/s), and ``inner_share`` of people.
    """
    plan = corner_plan()
    model = crowd_model(plan, seed)
    places = plan.random_points(
        round(DENSITY * plan.area), model.rng, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=RECORDED.draw(len(places), model.rng))
    theirs = published(REFERENCE)
    speed = float(np.interp(DENSITY, theirs["density"], theirs["v_mean"]))
    entry = box(0.4, CLEARANCE, 1.4, WIDTH - CLEARANCE)
    rate = DENSITY * speed * WIDTH
    model.add_source(Source(area=entry, rate=rate, preferred_speeds=RECORDED))
    while model.elapsed < SETTLE_S + MEASURE_S:
        model.step()
    run = Run(model, plan.walls)
    tracks = run.trajectories
    west, south, east, north = BEFORE.bounds
    middle = (south + north) / 2
    halves = {"inner": box(west, middle, east, north), "outer": box(west, south, east, middle)}
    found = {
        name: compare(
            tracks,
            tracks,
            View(direction=(1.0, 0.0), area=half, after=SETTLE_S),
            figures=["speed", "density"],
        )
        for name, half in halves.items()
    }
    inner, outer = (found[name]["density"].measured for name in halves)
    return {
        **run.figures(),
        **condition_of(tracks, BEFORE, LINE, after=SETTLE_S),
        **{f"{name}_speed": each["speed"].measured for name, each in found.items()},
        "inner_share": inner / (inner + outer) if inner + outer else None,
    }


def judge(runs: Runs) -> Verdict:
    """Lone people take no detours; the crowd has the measured density and speed, and uses both
    halves of the corridor alike."""
    lone, crowds = (list(of) for of in zip(*runs, strict=True))
    detours = np.concatenate([each["detours"] for each in lone])
    theirs = published(REFERENCE)
    slowest, mean, fastest = (
        float(np.interp(DENSITY, theirs["density"], theirs[name]))
        for name in ("v_min", "v_mean", "v_max")
    )
    measured = {"density": DENSITY, "flow": DENSITY * mean * WIDTH}
    inner, outer, share, speed = (
        median([each[name] for each in crowds])
        for name in ("inner_speed", "outer_speed", "inner_share", "speed")
    )
    ratio = inner / outer if inner is not None and outer else None
    checks: list[Check] = [
        exactly("alone: left inside", sum(each["left_inside"] for each in lone), 0),
        at_most(
            "alone: way over the shortest one, p95", float(np.percentile(detours, 95)), MOST_DETOUR
        ),
        *conditions("crowd before the corner", crowds, measured),
        within("crowd: speed before the corner m/s", speed, slowest, fastest),
        within("crowd: speed of the inner half over the outer", ratio, *SAME_SPEED),
        within("crowd: share of people in the inner half", share, *SAME_NUMBER),
    ]
    return Verdict(tuple(checks), {"detours": detours.tolist(), "speeds": [inner, outer]})


def draw(figures: dict[str, Any]) -> Figure:
    """Detours of lone people, and the speed of either half of the crowd."""
    figure, axes = charts.panels(2)
    axes[0].hist(
        figures["detours"], bins=np.arange(0.95, 1.6, 0.02).tolist(), color=charts.OURS.colour
    )
    axes[0].axvline(MOST_DETOUR, color=charts.OTHER.colour, label="bound of 95 %")
    axes[0].set(xlabel="way round the corner over the shortest one", ylabel="lone people")
    axes[1].bar(
        ["inner half", "outer half"],
        charts.numbers(figures["speeds"]),
        color=charts.OURS.colour,
        width=0.5,
    )
    theirs = published(REFERENCE)
    slowest, fastest = (
        float(np.interp(DENSITY, theirs["density"], theirs[name])) for name in ("v_min", "v_max")
    )
    axes[1].axhspan(
        slowest, fastest, color=charts.MEASURED.colour, alpha=0.2, label=charts.MEASURED.label
    )
    axes[1].set_ylabel("speed before the corner (m/s)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="corners",
    what="lone people round a corner, and a crowd in an L-shaped corridor 2.4 m wide",
    source="corner of corridors 2.4 m wide (data archive of Forschungszentrum Jülich); the "
    "bounds of detours and of halves are chosen",
    criterion="People alone take no detours round a corner; a crowd has the measured density and "
    "speed and uses both halves of the corridor alike",
    cases=(case(alone, effort=6.0), case(crowd, effort=6.0)),
    judge=judge,
    draw=draw,
)
