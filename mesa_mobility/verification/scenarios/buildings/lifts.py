"""Three storeys that a lift serves: one rider, and more riders than the car holds (NIST 2.7)."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import box

from mesa_mobility import Building, Exit, Level, Lift
from mesa_mobility.verification.runs import SPACING, Run, crowd_model, evacuate

STOREY = 3.5
"""Metres from one level to the next."""

OPEN_S = 3.0
"""Seconds for which doors stay open at least for those who get in."""

HALL = box(0.0, 0.0, 12.0, 6.0)
DOOR = ((5.4, 6.0), (6.6, 6.0))
WIDTH, DEPTH = 2.0, 1.6
"""Of the car, metres."""

WAITING = box(3.5, 3.0, 8.5, 4.7)
"""Where people start, all within 4 m of the door, from where they call the car."""

LOBBY = (6.0, 4.0)
"""Where somebody alone starts."""


def tower(car: int, *, speed: float, door_s: float, capacity: int = 8) -> Building:
    """Levels 0 to 2 with a lift, which everybody uses, and exits on levels 0 and 2.

    Args:
        car: level at which the car stands at first.
        speed: of the car, m/s.
        door_s: seconds in which its doors open, and in which they close.
        capacity: most people in the car.
    """
    out = {0: "street", 2: "roof"}
    levels = [
        Level(k, HALL, k * STOREY, exits=[Exit(out[k], (0.0, 2.0), (0.0, 4.0))] if k in out else [])
        for k in range(3)
    ]
    lift = Lift(
        "lift",
        [car, *(k for k in range(3) if k != car)],
        DOOR,
        capacity=capacity,
        speed=speed,
        door_s=door_s,
        width=WIDTH,
        depth=DEPTH,
        everybody=True,
    )
    return Building(levels, lifts=[lift])


def way_s(storeys: int, *, speed: float, door_s: float) -> float:
    """Seconds in which a car closes its doors, passes some storeys, and opens them again."""
    return 2.0 * door_s + storeys * STOREY / speed


def one_rider(
    seed: int, *, car: int, start: int, goal: int, speed: float, door_s: float
) -> dict[str, Any]:
    """One person rides from a level to another, from which an exit leads out.

    Args:
        seed: of the run.
        car: level at which the car stands at first.
        start: level of the person.
        goal: level to which they have to go, 0 or 2.
        speed: of the car, m/s.
        door_s: seconds in which its doors open, and in which they close.

    Returns:
        The common figures; ``arrived_s``, when the doors are open at the goal, and
        ``expected_s``, when they should be, both in seconds from the start of the run; and
        ``elsewhere``, 1 if the person was on another level than these two.
    """
    building = tower(car, speed=speed, door_s=door_s)
    model = crowd_model(building, seed)
    model.add_pedestrians(
        building.places([LOBBY], start), exits=["street" if goal == 0 else "roof"]
    )
    run = evacuate(model, 200.0)
    arrived = _arrivals(run, goal)
    comes = 0.0 if car == start else way_s(abs(car - start), speed=speed, door_s=door_s)
    rides = way_s(abs(goal - start), speed=speed, door_s=door_s)
    return {
        **run.figures(),
        "arrived_s": float(arrived[0]) if len(arrived) else None,
        "expected_s": max(comes + OPEN_S, _entered_s(run)) + rides,
        "elsewhere": _elsewhere(run, {start, goal}),
    }


def many_riders(
    seed: int, *, people: int, capacity: int, speed: float, door_s: float
) -> dict[str, Any]:
    """People of level 1 leave by level 0, more of them than the car holds.

    Args:
        seed: of the run.
        people: at the start.
        capacity: most people in the car.
        speed: of the car, m/s.
        door_s: seconds in which its doors open, and in which they close.

    Returns:
        The common figures; the ``rides`` that brought people to level 0; ``most``, the most people
        of one ride; ``between_s``, the seconds from each ride's end to the next one's; and
        ``elsewhere``, the people who were on another level than 0 and 1.
    """
    building = tower(1, speed=speed, door_s=door_s, capacity=capacity)
    model = crowd_model(building, seed)
    places = building.floor_plan.random_points(
        people,
        model.rng,
        within=box(*(building.places(np.reshape(WAITING.bounds, (2, 2)), 1).ravel())),
        spacing=SPACING,
        clearance=0.3,
    )
    model.add_pedestrians(places, exits=["street"])
    run = evacuate(model, 400.0)
    times, riders = np.unique(_arrivals(run, 0), return_counts=True)
    return {
        **run.figures(),
        "rides": len(times),
        "most": int(riders.max(initial=0)),
        "between_s": np.diff(times).tolist(),
        "elsewhere": _elsewhere(run, {0, 1}),
    }


def _arrivals(run: Run, level: int) -> np.ndarray:
    """(k,) seconds at which each person was on a level first, of those who were."""
    tracks = run.trajectories
    there = np.flatnonzero(tracks.level == level)
    _, first = np.unique(tracks.person[there], return_index=True)
    times: np.ndarray = tracks.frame[there[first]] / tracks.frame_rate
    return times


def _entered_s(run: Run) -> float:
    """Seconds at which the first person was in the car; infinite if they never were."""
    times, places = run.track(0)
    inside = np.flatnonzero(places[:, 1] >= DOOR[0][1])
    return float(times[inside[0]]) if len(inside) else np.inf


def _elsewhere(run: Run, levels: set[int]) -> int:
    """How many people were on other levels than these."""
    off = ~np.isin(run.trajectories.level, list(levels))
    return len(np.unique(run.trajectories.person[off]))
