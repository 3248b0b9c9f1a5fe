"""Counts of a run: passages through doors, waiting times, and time series."""

from __future__ import annotations

from bisect import bisect_right
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd.running.trace import Trace
from mesa_mobility.dashboard.session.storeys import own_openings
from mesa_mobility.results import passages

SLOW = 0.2
"""Speed in m/s below which somebody counts as waiting."""

NEAR = 1.0
"""Radius in metres of the disc in which the density around somebody is counted."""

EVERY = 1.0
"""Simulated seconds between two entries of the time series."""

WINDOW = 10.0
"""Seconds over which the flow through a door is averaged."""


def densities(model: PedestrianModel) -> NDArray[np.float64]:
    """(n,) density around each person inside, 1/m2: people within 1 m, themselves included.

    The number of people is divided by the area of the disc.

    Walls are not cut out of the disc: beside a wall the value is too low by up to a half.
    """
    if model.inside == 0:
        return np.empty(0)
    points = np.column_stack([model.crowd.x[model.rows], model.crowd.y[model.rows]])
    counts = cKDTree(points).query_ball_point(points, NEAR, return_length=True)
    return np.asarray(counts, dtype=np.float64) / (np.pi * NEAR**2)


class Observer:
    """Watches one model from outside, step by step.

    Args:
        model: the model, before its first step.

    Attributes:
        openings: names of the doors and exits, without those of stairs and lifts.
        trace: where people have been; of all observers of the model.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self._model = model
        self._openings = own_openings(model.floor_plan, model.building)
        self.openings = tuple(opening.name for opening in self._openings)
        self._net = np.zeros(len(self._openings), dtype=np.int64)
        self._passed: list[tuple[str, int, float]] = []
        self.trace = model.dynamics.trace = model.dynamics.trace or Trace()
        self._waited = np.zeros(0)
        self._elapsed = model.elapsed
        self._series: dict[str, list[float]] = {
            name: []
            for name in (
                "elapsed",
                "inside",
                "mean_speed",
                "mean_density",
                "max_density",
                "fallback_share",
                *(f"passed {name}" for name in self.openings),
            )
        }
        self._remember()
        self._sample()

    def waited(self, rows: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n,) seconds that the people in ``rows`` have spent below 0.2 m/s."""
        self._make_room()
        return self._waited[rows]

    def passed(self, since: float) -> list[tuple[str, int, float]]:
        """Net passages of openings, in the direction of most, after each step that changed them.

        Args:
            since: seconds; only later steps count.

        Returns:
            Name, passages since the start, and seconds at the end of the step, in order of time.
        """
        return self._passed[bisect_right(self._passed, since, key=itemgetter(2)) :]

    def columns(self) -> dict[str, list[float]]:
        """The time series so far, an entry each second; may be called from any thread.

        Returns:
            ``elapsed`` (s), ``inside``, ``mean_speed`` (m/s), ``mean_density`` and ``max_density``
            (1/m2, see ``densities``), ``fallback_share`` (of pedestrian-time so far), and for each
            door or exit ``passed NAME``, net passages since the start in the direction of most,
            and ``flow NAME``, the same a second over the 10 s before.
        """
        columns = {name: list(values) for name, values in self._series.items()}
        # An entry may just be under way.
        length = min(map(len, columns.values()))
        columns = {name: values[:length] for name, values in columns.items()}
        for name in self.openings:
            passed = np.array(columns[f"passed {name}"])
            before = np.concatenate([np.zeros(round(WINDOW / EVERY)), passed])[:length]
            columns[f"flow {name}"] = ((passed - before) / WINDOW).tolist()
        return columns

    def after_step(self) -> None:
        """Count what the model's last step has brought; people who left have their last place."""
        model = self._model
        passed, self._elapsed = model.elapsed - self._elapsed, model.elapsed
        if passed <= 0.0:
            return
        places = self._places(self._rows)
        for k, opening in enumerate(self._openings):
            _, direction = passages(self._before, places, opening.a, opening.b)
            if change := int(direction.sum()):
                self._net[k] += change
                self._passed.append((opening.name, abs(int(self._net[k])), model.elapsed))
        self._remember()
        crowd, rows = model.crowd, model.rows
        slow = np.hypot(crowd.vx[rows], crowd.vy[rows]) < SLOW
        self._make_room()
        self._waited[rows[slow]] += passed
        if not model.running or model.elapsed >= self._series["elapsed"][-1] + EVERY - 1e-9:
            self._sample()

    def _places(self, rows: NDArray[np.int64]) -> NDArray[np.float64]:
        return np.column_stack([self._model.crowd.x[rows], self._model.crowd.y[rows]])

    def _remember(self) -> None:
        self._rows = self._model.rows.copy()
        self._before = self._places(self._rows)

    def _make_room(self) -> None:
        missing = self._model.population.count - len(self._waited)
        if missing > 0:
            self._waited = np.concatenate([self._waited, np.zeros(missing)])

    def _sample(self) -> None:
        model, around = self._model, densities(self._model)
        values = [
            model.elapsed,
            model.inside,
            model.statistics.mean_speed,
            float(around.mean()) if len(around) else 0.0,
            float(around.max()) if len(around) else 0.0,
            model.statistics.fallback_time_share,
            *np.abs(self._net).tolist(),
        ]
        for column, value in zip(self._series.values(), values, strict=True):
            column.append(value)
