"""People who walk alone: one along a corridor, or many in lanes far apart."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.distributions import Normal, Uniform
from mesa_mobility.populations import WITHIN, walking_speed
from mesa_mobility.verification.references import speed_by_age
from mesa_mobility.verification.runs import CLEARANCE, Run, crowd_model, evacuate, passing_time

WIDTH = 2.0
LANE = 3.0
LENGTH = 40.0
FASTEST = 1.85
"""Greatest sustained speed in the map, m/s; people cannot walk faster than this."""


def corridor_plan(length: float, width: float = WIDTH) -> FloorPlan:
    """A corridor from x = 0 to `length` and y = 0 to `width`, open at the right end."""
    return FloorPlan(
        box(0.0, 0.0, length, width), exits=[Exit("end", (length, 0.0), (length, width))]
    )


def lone_walker(
    seed: int, *, length: float, speed: float, measured_from: float, measured_to: float
) -> dict[str, Any]:
    """One person walks along a corridor 2 m wide.

    The standards start at x = 0, in the wall; here the person stands a body's radius off it.

    Args:
        seed: of the run.
        length: of the corridor, metres.
        speed: preferred speed, m/s.
        measured_from: x where the person's speed begins to be measured, metres.
        measured_to: x where that ends.
    """
    model = crowd_model(corridor_plan(length), seed)
    model.add_pedestrians(
        [[CLEARANCE, WIDTH / 2]], headings=[0.0], preferred_speeds=[speed], exits=["end"]
    )
    run = evacuate(model, 3.0 * length / speed)
    times, places = run.track(0)
    passed = passing_time(times, places, 0, measured_from, measured_to)
    return {
        **run.figures(),
        "speed_mps": None if passed is None else (measured_to - measured_from) / passed,
        "passing_s": passed,
        "least_y_m": float(places[:, 1].min()),
        "greatest_y_m": float(places[:, 1].max()),
    }


def lanes_model(n: int, seed: int) -> PedestrianModel:
    """An empty field for `n` people who walk 40 m in lanes."""
    width = LANE * n
    plan = FloorPlan(
        box(-2.0, 0.0, LENGTH, width), exits=[Exit("finish", (LENGTH, 0.0), (LENGTH, width))]
    )
    return crowd_model(plan, seed)


def put_in_lanes(model: PedestrianModel, speeds: NDArray[np.float64]) -> None:
    """One person a lane, at x = 0, with these preferred speeds."""
    n = len(speeds)
    places = np.column_stack([np.zeros(n), LANE * (np.arange(n) + 0.5)])
    model.add_pedestrians(places, headings=np.zeros(n), preferred_speeds=speeds)


def speeds_walked(run: Run, n: int) -> list[float | None]:
    """Speed of each person from x = 10 to x = 30 m, m/s."""
    walked: list[float | None] = []
    for person in range(n):
        times, places = run.track(person)
        passed = passing_time(times, places, 0, 10.0, 30.0)
        walked.append(None if passed is None else 20.0 / passed)
    return walked


def uniform_speeds(seed: int, *, people: int, low: float, high: float) -> dict[str, Any]:
    """People with speeds from U(low, high)."""
    model = lanes_model(people, seed)
    return _walked(model, Uniform(low, high).draw(people, model.rng))


def normal_speeds(seed: int, *, people: int, mean: float, sd: float) -> dict[str, Any]:
    """People with speeds from N(mean, sd)."""
    model = lanes_model(people, seed)
    return _walked(model, Normal(mean, sd).draw(people, model.rng))


def speeds_by_age(seed: int, *, people: int, youngest: float, oldest: float) -> dict[str, Any]:
    """People of ages spread evenly, with speeds from the curve of ages.

    Returns:
        As for the others, and in standard deviations of each age group: ``deviation``, of the speed
        walked from the mean of the age, and ``most``, the upper bound of the draws.
    """
    model = lanes_model(people, seed)
    ages = np.linspace(youngest, oldest, people)
    figures = _walked(model, walking_speed(ages, model.rng, FASTEST))
    mean, sd = speed_by_age(ages)
    walked = np.array(figures["walked_mps"], dtype=np.float64)
    return {
        **figures,
        "deviation": ((walked - mean) / sd).tolist(),
        "most": np.minimum((FASTEST - mean) / sd, WITHIN).tolist(),
    }


def _walked(model: PedestrianModel, speeds: NDArray[np.float64]) -> dict[str, Any]:
    put_in_lanes(model, speeds)
    run = evacuate(model, 3.0 * LENGTH / float(speeds.min()))
    return {
        **run.figures(),
        "assigned_mps": speeds.tolist(),
        "walked_mps": speeds_walked(run, len(speeds)),
    }
