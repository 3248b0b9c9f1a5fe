"""Corridors of walking people: alone, one way, before an exit, and both ways."""

from __future__ import annotations

import numpy as np
import shapely
from shapely import box

from mesa_mobility import Exit, FloorPlan, Source
from mesa_mobility.results.measures.motion import (
    Selection,
    accelerations,
    speed_jumps,
    steps_between,
)
from mesa_mobility.validation.bidirectional import BOX as BOTH_WAYS_BOX
from mesa_mobility.validation.bidirectional import both_ways_run
from mesa_mobility.validation.conditions import condition_of
from mesa_mobility.validation.corridor import RECORDED
from mesa_mobility.verification import case
from mesa_mobility.verification.cases import Case, Figures
from mesa_mobility.verification.references import bottleneck_fit
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model, evacuate

LENGTH, WIDTH = 24.0, 1.8
BOX = box(12.0, 0.0, 22.0, WIDTH)
"""Where tracks count, metres: ten metres of corridor before its end."""
ENTRY = box(0.6, CLEARANCE, 1.6, WIDTH - CLEARANCE)
WALL, BEHIND = 0.1, (2.5, 1.0)
"""Thickness of the wall beside an exit; of the free area behind it the length, and by how much it
is wider to either side; metres."""
LINE = ((17.0, 0.0), (17.0, WIDTH))
SETTLE_S, MEASURE_S = 30.0, 60.0
LONG_SETTLE_S = 60.0
"""Time until the queue before an exit has reached the whole measuring area, seconds."""


def corridor_plan(exit_width: float) -> FloorPlan:
    """The corridor; behind an exit that is narrower than it, a free area as in the experiment."""
    low, high = (WIDTH - exit_width) / 2, (WIDTH + exit_width) / 2
    floor = box(0.0, 0.0, LENGTH, WIDTH)
    end = ((LENGTH, low), (LENGTH, high))
    if exit_width < WIDTH:
        (length, beside), behind = BEHIND, LENGTH + WALL
        free = box(behind, -beside, behind + length, WIDTH + beside)
        floor = shapely.union_all([floor, box(LENGTH, low, behind, high), free])
        far = behind + length
        end = ((far, -beside), (far, WIDTH + beside))
    return FloorPlan(floor, exits=[Exit("end", *end)])


def one_way(
    seed: int, *, density: float, rate: float, exit_width: float, settle: float = SETTLE_S
) -> Figures:
    """People walk one way along a corridor 24 m long that is fed at one end.

    Args:
        seed: of the run.
        density: persons per square metre at the start.
        rate: at which people come in where there is room, 1/s.
        exit_width: of its end, metres.
        settle: time before anything is measured, seconds.

    Returns:
        With what every run tells, over the last ten metres but two: ``density``, ``speed`` and
        ``flow``, ``turns`` (radians), ``across`` (m), ``speed_changes`` (m/s) between steps of
        1.5 s, ``accelerations`` (m/s2) and ``jumps`` of speed over 0.1 s (m/s).
    """
    plan = corridor_plan(exit_width)
    model = crowd_model(plan, seed)
    people = round(density * LENGTH * WIDTH)
    places = plan.random_points(
        people,
        model.rng,
        within=box(0.0, 0.0, LENGTH, WIDTH),
        spacing=SPACING,
        clearance=CLEARANCE,
    )
    model.add_pedestrians(places, preferred_speeds=RECORDED.draw(people, model.rng))
    model.add_source(Source(area=ENTRY, rate=rate, preferred_speeds=RECORDED))
    while model.elapsed < settle + MEASURE_S:
        model.step()
    run = Run(model, plan.walls)
    moved = _moved(run, Selection(BOX, settle))
    return {**moved, **condition_of(run.trajectories, BOX, LINE, after=settle)}


def before_exit(width: float) -> Case:
    """A case of a jam before an exit of this width.

    As in the experiment, a crowd waits before the corridor: people come in as fast as measured
    crowds pass an opening as wide as the corridor, if the queue before the exit leaves them room.
    """
    return case(
        one_way,
        effort=8.0,
        density=2.06,
        rate=bottleneck_fit(WIDTH),
        exit_width=width,
        settle=LONG_SETTLE_S,
    )


def both_ways(seed: int, *, density: float) -> Figures:
    """People walk both ways in a corridor 4 m wide; figures as of ``one_way``."""
    run = both_ways_run(seed, density=density)
    moved = _moved(run, Selection(BOTH_WAYS_BOX, SETTLE_S))
    return {**moved, **condition_of(run.trajectories, BOTH_WAYS_BOX, after=SETTLE_S)}


def alone(seed: int, *, people: int = 25) -> Figures:
    """People walk alone in lanes 3 m apart. The figures are those of ``one_way``."""
    plan = FloorPlan(
        box(-2.0, 0.0, LENGTH, 3.0 * people),
        exits=[Exit("end", (LENGTH, 0.0), (LENGTH, 3.0 * people))],
    )
    model = crowd_model(plan, seed)
    places = np.column_stack([np.zeros(people), 3.0 * (np.arange(people) + 0.5)])
    model.add_pedestrians(
        places, headings=np.zeros(people), preferred_speeds=RECORDED.draw(people, model.rng)
    )
    run = evacuate(model, 3.0 * LENGTH)
    middle = box(4.0, 0.0, LENGTH - 2.0, 3.0 * people)
    return {**_moved(run, Selection(middle)), **condition_of(run.trajectories, middle)}


def _moved(run: Run, selection: Selection) -> Figures:
    tracks = run.trajectories
    steps = steps_between(tracks, (1.0, 0.0), selection=selection)
    return {
        **run.figures(),
        "turns": steps.turns,
        "across": steps.across,
        "speed_changes": steps.speed_changes,
        "successive": steps.successive,
        "accelerations": accelerations(tracks, selection=selection),
        "jumps": speed_jumps(tracks, selection=selection),
    }
