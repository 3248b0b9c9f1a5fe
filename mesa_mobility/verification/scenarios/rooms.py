"""Rooms that empty through doors, and a corridor with a corner."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.behaviors import QuickestExit
from mesa_mobility.distributions import Uniform
from mesa_mobility.results import flow
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model, evacuate

MALES_30_TO_50 = (0.97, 1.62)
"""Uniform range of walking speeds, m/s (IMO MSC.1/Circ.1533, table 3.4)."""

HALL = box(0.0, 0.0, 30.0, 20.0)
FOUR_EXITS = {
    "exit 1": ((4.0, 20.0), (5.0, 20.0)),
    "exit 2": ((25.0, 20.0), (26.0, 20.0)),
    "exit 3": ((4.0, 0.0), (5.0, 0.0)),
    "exit 4": ((25.0, 0.0), (26.0, 0.0)),
}
TWO_EXITS = {"exit 1": ((21.0, 20.0), (22.0, 20.0)), "exit 2": ((27.0, 20.0), (28.0, 20.0))}
CORNER = Polygon([(0, 0), (12, 0), (12, 12), (10, 12), (10, 2), (0, 2)])
SMALL_ROOM = box(0.0, 0.0, 8.0, 5.0)
SMALL_ROOM_DOOR = ((8.0, 2.0), (8.0, 3.0))


def corner(seed: int, *, people: int, start_x: float, speed: float) -> dict[str, Any]:
    """People in a corridor 2 m wide walk round a left-hand corner.

    Args:
        seed: of the run.
        people: how many start between `start_x` and x = 6 m.
        start_x: metres.
        speed: of everybody, m/s.

    Returns:
        The common figures, and ``points_outside``, as the function of this name counts them.
    """
    plan = FloorPlan(CORNER, exits=[Exit("end", (10.0, 12.0), (12.0, 12.0))])
    model = crowd_model(plan, seed)
    start = box(start_x, 0.0, 6.0, 2.0)
    places = plan.random_points(
        people, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=speed)
    run = evacuate(model, 180.0)
    return {**run.figures(), "points_outside": points_outside(run)}


def points_outside(run: Run) -> int:
    """How many recorded places of people still inside lie more than a millimetre off the floor."""
    tracks = run.trajectories
    left = tracks.exit_frames[tracks.person]
    inside = (left < 0) | (tracks.frame < left)
    floor = run.model.floor_plan.walkable.buffer(1e-3, join_style="mitre")
    shapely.prepare(floor)
    within = shapely.contains_xy(floor, tracks.x[inside], tracks.y[inside])
    return int(np.count_nonzero(~within))


def small_room(seed: int, *, people: int) -> dict[str, Any]:
    """People leave a room of 8 m x 5 m by a door 1 m wide in its right wall.

    Returns:
        The common figures (see ``Run.figures``) and two more. ``flow_per_s`` is the flow through
        the door, people a second; None if fewer than two people crossed it. ``left`` is the number
        of people who left.
    """
    plan = FloorPlan(SMALL_ROOM, exits=[Exit("door", *SMALL_ROOM_DOOR)])
    model = crowd_model(plan, seed)
    places = plan.random_points(people, model.rng, spacing=SPACING, clearance=CLEARANCE)
    model.add_pedestrians(places)
    run = evacuate(model, 300.0)
    times = run.crossing_times(*SMALL_ROOM_DOOR)
    return {**run.figures(), "flow_per_s": flow(times), "left": len(times)}


def hall(seed: int, *, people: int, exits: int) -> dict[str, Any]:
    """Men of 30 to 50 in a hall of 30 m x 20 m leave by four exits of 1 m, or by the last two.

    Returns:
        The common figures, and how many people left by each exit, ``by_exit``.
    """
    names = list(FOUR_EXITS)
    plan = FloorPlan(HALL, exits=[Exit(name, *FOUR_EXITS[name]) for name in names])
    for name in names[: len(names) - exits]:
        plan.close_gate(name)
    return _empty(plan, box(2.0, 2.0, 28.0, 18.0), people, seed)


def two_exits(seed: int, *, people: int) -> dict[str, Any]:
    """People crowd the left half of a hall whose two exits of 1 m lie on the right.

    They weigh the walk against the queue.

    Returns:
        The common figures, and how many people left by each exit, ``by_exit``.
    """
    plan = FloorPlan(HALL, exits=[Exit(name, *line) for name, line in TWO_EXITS.items()])
    start = box(2.0, 2.0, 15.0, 18.0)
    return _empty(plan, start, people, seed, target_choice=QuickestExit())


def _empty(
    plan: FloorPlan, start: Polygon, people: int, seed: int, **keywords: Any
) -> dict[str, Any]:
    model = crowd_model(plan, seed, **keywords)
    places = plan.random_points(
        people, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=Uniform(*MALES_30_TO_50))
    run = evacuate(model, 900.0)
    lines = {exit_.name: (exit_.a, exit_.b) for exit_ in plan.open_exits()}
    by_exit = {name: len(run.crossing_times(*line)) for name, line in lines.items()}
    return {**run.figures(), "by_exit": by_exit}
