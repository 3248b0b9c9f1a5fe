"""Run scenarios and compute their figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility import Building, FloorPlan, MobilityMap, PedestrianModel, Trajectories
from mesa_mobility.results import check_safety, crossings, flow
from mesa_mobility.verification.drawings import collect

FloatArray = NDArray[np.float64]

CLEARANCE = 0.2
"""Initial distance to walls, metres: a body core of 0.14 m and a little."""

SPACING = 0.4
"""Initial distance between people, metres, unless the crowd is too dense for it."""


def crowd_model(
    plan: FloorPlan | Building, seed: int | np.random.Generator, **keywords: Any
) -> PedestrianModel:
    """A recording model of the default preset on the map that ships."""
    if "pedestrian_types" not in keywords:
        keywords["mobility_map"] = MobilityMap.load()
    return PedestrianModel(plan, record=True, rng=seed, **keywords)


@dataclass(frozen=True, eq=False)
class Run:
    """A model that has run.

    Attributes:
        model: the model.
        walls: (m, 4) walls that nobody may cross, metres.
    """

    model: PedestrianModel
    walls: FloatArray

    @cached_property
    def trajectories(self) -> Trajectories:
        """The recorded trajectories."""
        return Trajectories.of(self.model)

    def figures(self) -> dict[str, Any]:
        """Figures of a run; overlaps and wall crossings are counted on its trajectories."""
        model, building = self.model, self.model.building
        walls = self.walls
        if building is not None:  # those of its levels, in true coordinates
            storeys = [building.floor_plan_of(level.number) for level in building.levels]
            walls = np.concatenate([plan.walls for plan in storeys])
        collect(self.trajectories, walls, building or model.floor_plan)
        safety = check_safety(
            self.trajectories, self.walls, model.floor_plan.free, building=building
        )
        summary = self.model.summary()
        kept = (
            "pedestrians",
            "simulated_s",
            "egress_s",
            "left_inside",
            "stalled",
            "fallback_time_share",
            "fallback_decision_share",
        )
        return {
            **{name: summary[name] for name in kept},
            "person_s": float(self.model.crowd.active_frames.sum()) / self.model.frame_rate,
            "overlaps": safety.overlaps,
            "wall_crossings": safety.wall_crossings,
            "off_floor": safety.off_floor,
            "min_distance_m": safety.min_distance_m,
        }

    def crossing_times(self, a: ArrayLike, b: ArrayLike) -> FloatArray:
        """(k,) seconds in rising order: when each person first crossed the line from a to b."""
        found = crossings(self.trajectories, a, b)
        _, first = np.unique(found.person, return_index=True)
        return np.sort(found.time[first])

    def track(self, person: int) -> tuple[FloatArray, FloatArray]:
        """(k,) seconds and (k, 2) metres of one person."""
        rows = self.trajectories.person == person
        places = np.column_stack([self.trajectories.x[rows], self.trajectories.y[rows]])
        return self.trajectories.frame[rows] / self.trajectories.frame_rate, places


def evacuate(
    model: PedestrianModel,
    seconds: float,
    events: Sequence[tuple[float, Callable[[PedestrianModel], None]]] = (),
    *,
    stop_when_stalled: bool = True,
) -> Run:
    """Run until everybody is out, nothing moves any more or time is up.

    Args:
        model: the model.
        seconds: simulated seconds at most.
        events: times and actions, in order of time.
        stop_when_stalled: False where people may wait for longer than a minute.
    """
    walls = model.floor_plan.walls
    ahead = list(events)
    while model.inside and model.elapsed < seconds - 1e-9:
        if ahead and model.elapsed >= ahead[0][0] - 1e-9:
            ahead.pop(0)[1](model)
        model.step()
        if model.stalled and stop_when_stalled:
            break
    return Run(model, walls)


def steady_flow(times: FloatArray, people: int) -> float | None:
    """Flow between the passage of the sixth part of the people and that of five sixths, 1/s.

    The run-up and the tail, in which no crowd stands in front, are left out. None where
    fewer got through.
    """
    first, last = round(people / 6), round(people * 5 / 6)
    return flow(times[first - 1 : last]) if len(times) >= last else None


def passing_time(
    times: FloatArray, positions: FloatArray, axis: int, low: float, high: float
) -> float | None:
    """Seconds from first reaching `low` to first reaching `high` along an axis, interpolated."""
    start, end = (
        _first_at(times, positions[:, axis], low),
        _first_at(times, positions[:, axis], high),
    )
    return None if start is None or end is None else end - start


def _first_at(times: FloatArray, values: FloatArray, level: float) -> float | None:
    beyond = np.flatnonzero(values >= level)
    if not len(beyond):
        return None
    k = int(beyond[0])
    if k == 0:
        return float(times[0])
    share = (level - values[k - 1]) / (values[k] - values[k - 1])
    return float(times[k - 1] + share * (times[k] - times[k - 1]))
