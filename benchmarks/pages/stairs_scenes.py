"""Scenes of docs/explanation/stairs.md: streams on a stair and on a landing, and an office."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon, box

from mesa_mobility import Building, Exit, Level, PedestrianType, Stairs, Trajectories
from mesa_mobility.results import by_level, climbs, flow
from mesa_mobility.verification.runs import Run, crowd_model, evacuate
from mesa_mobility.verification.scenarios.buildings.stairs import lone_climber

RISERS, RISER, TREAD, WIDTH = 18, 0.17, 0.29, 1.2
RISE, GOING = RISERS * RISER, (RISERS - 1) * TREAD
SLOPE = math.hypot(GOING, RISE) / GOING
"""Metres along the slope for a metre in plan."""

LIMIT_S = 900.0

CORRIDOR_M = 30.0
"""Length of the corridor before the stair, as wide as it."""

ROOM = box(-10.0, -3.4, 0.0, 4.6)
"""A room before the stair."""

ENDS = 0.5
"""Metres at either end of a flight where nobody is measured."""

EVERY_S = 0.5
"""Seconds over which speeds are taken."""

QUEUED = 80
"""People in each of the two streams that merge."""

OF_A_TYPE = 60
"""People of one type who leave a room."""

STOREYS, ON_A_STOREY, DELAY_S = 4, 40, 60.0
"""The office that empties at once or in phases; people wait so long in the second phase."""

Line = tuple[tuple[float, float], tuple[float, float]]


def stream(seed: int, *, up: bool, density: float) -> dict[str, Any]:
    """People walk along a corridor onto a stair, up or down.

    Args:
        seed: of the run.
        up: whether they walk up.
        density: in the corridor at the start, persons/m2; infinite for 100 people in a room.
    """
    crowded = not math.isfinite(density)
    before = ROOM if crowded else box(-CORRIDOR_M, 0.0, 0.0, WIDTH)
    building = stair_after(before, up=up)
    model = crowd_model(building, seed)
    people = 100 if crowded else round(density * before.area)
    spacing = 0.4 if density > 1.0 else 0.8
    places = building.random_points(
        people, model.rng, level=0 if up else 1, spacing=spacing, clearance=0.2
    )
    model.add_pedestrians(places)
    run = evacuate(model, LIMIT_S)
    times = run.crossing_times((GOING / 2, 0.0), (GOING / 2, WIDTH))
    found, speeds = on_the_flight(run.trajectories)
    return {
        **safety(run),
        "up": up,
        "density": density,
        "flow": middle_flow(times, people) if crowded else None,
        "densities": found.tolist(),
        "speeds": speeds.tolist(),
    }


def of_one_type(seed: int, kind: str, *, up: bool) -> dict[str, Any]:
    """One person of a type alone on a stair, and 60 of them who leave a room by it.

    Args:
        seed: of the runs.
        kind: name of the type.
        up: whether they walk up.

    Returns:
        ``level_mps``, the mean speed that they prefer on a level floor; ``free_mps``, that along
        the slope of one who prefers it; ``flow``, persons/s from the room.
    """
    each = PedestrianType.named(kind)
    preferred = float(each.draw_speeds(1000, np.random.default_rng(seed)).mean())
    stair = {"risers": RISERS, "riser": RISER, "tread": TREAD}
    alone = lone_climber(seed, up=up, preferred=preferred, kind=kind, **stair)
    building = stair_after(ROOM, up=up)
    model = crowd_model(building, seed, pedestrian_types=(each,))
    places = building.random_points(
        OF_A_TYPE, model.rng, level=0 if up else 1, spacing=0.5, clearance=each.half_width + 0.05
    )
    model.add_pedestrians(places)
    run = evacuate(model, LIMIT_S)
    times = run.crossing_times((GOING / 2, 0.0), (GOING / 2, WIDTH))
    return {
        **safety(run),
        "up": up,
        "kind": kind,
        "level_mps": preferred,
        "free_mps": alone["speed_mps"],
        "flow": middle_flow(times, OF_A_TYPE),
    }


def stair_after(before: Polygon, *, up: bool) -> Building:
    """A stair from x = 0 on, with a floor before it and 4 m of floor and an exit behind it."""
    end = GOING + 4.0
    behind = box(GOING, 0.0, end, WIDTH)
    out = [Exit("out", (end, 0.0), (end, WIDTH))]
    if up:
        lower, upper = Level(0, before), Level(1, behind, RISE, exits=out)
        head: Line = ((GOING, 0.0), (GOING, WIDTH))
    else:
        lower, upper = Level(0, behind, exits=out), Level(1, before, RISE)
        head = ((0.0, WIDTH), (0.0, 0.0))
    stairs = Stairs.straight("stair", upper, lower, head, risers=RISERS, tread=TREAD)
    return Building([lower, upper], [stairs])


def on_the_flight(tracks: Trajectories) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Every half second with people on the flight: (k,) density, 1/m2 in plan, and (k,) mean speed
    along the slope, m/s."""
    step = round(EVERY_S * tracks.frame_rate)
    start, end = tracks.steps(step)
    middle = (tracks.x[start] + tracks.x[end]) / 2.0
    on = (middle > ENDS) & (middle < GOING - ENDS) & (tracks.frame[start] % step == 0)
    moved = np.hypot(
        tracks.x[end[on]] - tracks.x[start[on]], tracks.y[end[on]] - tracks.y[start[on]]
    )
    frame = tracks.frame[start[on]] // step
    people = np.bincount(frame)
    there = people > 0
    mean = np.bincount(frame, moved)[there] / people[there] / EVERY_S * SLOPE
    return people[there] / ((GOING - 2 * ENDS) * WIDTH), mean


def merging(seed: int, *, beside: bool) -> dict[str, Any]:
    """People from a stair and from a floor merge on a landing, and walk on down.

    The landing is 2.6 m wide and 1.5 m deep, with the foot of one stair and the head of the next
    side by side. The door of the floor, 1 m wide, is opposite to the foot or beside it.

    Args:
        seed: of the run.
        beside: whether the door is beside the foot.

    Returns:
        ``share``, that of people from the stair among those who walk on, while both queue.
    """
    building = landing(beside=beside)
    model = crowd_model(building, seed)
    level_of = []
    for level in (1, 2):
        room = ROOMS["beside" if beside else "opposite"] if level == 1 else ABOVE
        (dx, dy) = building.places([(0.0, 0.0)], level=level)[0]
        places = building.floor_plan.random_points(
            QUEUED,
            model.rng,
            within=shapely.affinity.translate(room, dx, dy),
            spacing=0.4,
            clearance=0.25,
        )
        model.add_pedestrians(places)
        level_of += [level] * QUEUED
    run = evacuate(model, LIMIT_S)
    over = climbs(run.trajectories, building)["lower"].over_head()
    _, first = np.unique(over.person, return_index=True)
    time, from_stair = over.time[first], np.array(level_of)[over.person[first]] == 2
    # Both queue from some seconds after both have come until one of them is nearly over.
    begin = max(time[from_stair].min(), time[~from_stair].min()) + 10.0
    end = min(np.sort(time[from_stair])[-10], np.sort(time[~from_stair])[-10])
    merging_now = (time >= begin) & (time <= end)
    return {
        **safety(run),
        "beside": beside,
        "share": float(from_stair[merging_now].mean()),
        "seconds": float(end - begin),
        "flow": flow(time[merging_now]),
    }


ABOVE = box(0.0, -4.0, 6.0, 6.6)
"""The floor above the landing."""

ROOMS = {"opposite": box(1.7, -4.0, 7.7, 6.6), "beside": box(-3.0, 2.8, 4.5, 10.0)}
"""The floor at the landing, by the place of its door."""

DOORS = {"opposite": box(1.5, 1.5, 1.7, 2.5), "beside": box(0.25, 2.6, 1.25, 2.8)}


def landing(*, beside: bool) -> Building:
    """A floor above, a landing with a floor behind a door, and a floor with an exit below."""
    name = "beside" if beside else "opposite"
    at_landing = shapely.union_all([box(0.0, 0.0, 1.5, 2.6), DOORS[name], ROOMS[name]])
    below = Level(0, box(0.0, 0.0, 3.0, 2.6), exits=[Exit("out", (3.0, 0.0), (3.0, 2.6))])
    levels = [below, Level(1, at_landing, RISE), Level(2, ABOVE, 2 * RISE)]
    head = ((0.0, 0.0), (0.0, WIDTH))
    stairs = [
        Stairs.dog_leg(name, k, k - 1, head, risers=RISERS, tread=TREAD, turn="right")
        for name, k in (("upper", 2), ("lower", 1))
    ]
    return Building(levels, stairs)


def office(seed: int, *, phased: bool) -> dict[str, Any]:
    """Four storeys of 40 people each empty down one stair, at once or the top storey first.

    Args:
        seed: of the run.
        phased: whether the people of the other storeys wait for a minute.

    Returns:
        ``clear``, seconds after which each storey is empty, from the top; ``on_stairs_s``, mean
        time on the stairs to the storey below; ``most``, the greatest number of people on them.
    """
    floor = shapely.union_all([box(0.0, 0.0, 2.0, 2.6), box(2.0, -4.0, 16.0, 6.6)])
    out = [Exit("out", (0.0, 2.6), (2.0, 2.6))]
    head = ((0.0, 0.0), (0.0, WIDTH))
    building = Building(
        [Level(k, floor, k * RISE, exits=[] if k else out) for k in range(STOREYS)],
        [
            Stairs.dog_leg(f"stair {k}", k, k - 1, head, risers=RISERS, tread=TREAD, turn="right")
            for k in range(1, STOREYS)
        ],
    )
    model = crowd_model(building, seed)
    for level in range(STOREYS):
        places = building.random_points(
            ON_A_STOREY, model.rng, level=level, spacing=0.8, clearance=0.3
        )
        waits = DELAY_S if phased and level < STOREYS - 1 else 0.0
        model.add_pedestrians(places, pre_movement=waits)
    run = evacuate(model, LIMIT_S, stop_when_stalled=False)
    ways = climbs(run.trajectories, building).values()
    return {
        **safety(run),
        "phased": phased,
        "clear": by_level(run.trajectories, building).clear_s.tolist(),
        "on_stairs_s": float(np.concatenate([(each.end - each.start) for each in ways]).mean()),
    }


def counted(runs: Sequence[dict[str, Any]]) -> str:
    """The figures of ``safety`` over all runs, as a sentence."""
    left, overlaps, crossings = (
        sum(run[name] for run in runs) for name in ("left_inside", "overlaps", "wall_crossings")
    )
    return (
        f"People left inside {left}, overlaps {overlaps}, wall crossings {crossings}, in "
        f"{len(runs)} runs."
    )


def middle_flow(times: NDArray[np.float64], people: int) -> float:
    """The flow from the sixth part of the people to five sixths, persons/s; seconds in order."""
    return flow(times[round(people / 6) - 1 : round(people * 5 / 6)])


def safety(run: Run) -> dict[str, Any]:
    """People left inside, overlaps and steps through walls of a run."""
    figures = run.figures()
    return {name: figures[name] for name in ("left_inside", "overlaps", "wall_crossings")}
