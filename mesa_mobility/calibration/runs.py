"""The runs of a calibration, in the stores of two experiments: training, and held out."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from mesa_mobility.calibration.task import Task, rules_text
from mesa_mobility.calibration.trial import Trial, column_of
from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.design.designs import Table
from mesa_mobility.experiments.design.points import Point, point_key
from mesa_mobility.experiments.driver import run_experiment
from mesa_mobility.experiments.experiment import Experiment
from mesa_mobility.experiments.storing.rows import DONE
from mesa_mobility.runs.workers import Workers

TRAINING, HELD_OUT = "training", "held_out"


class Runs:
    """Runs of sets of numbers, done once and kept.

    Args:
        task: the calibration.
        store: path or URL of its folder.
        workers: do them; they stay from one generation to the next.
    """

    def __init__(self, task: Task, store: str, workers: Workers) -> None:
        self._task, self._store, self._workers = task, store, workers
        self._rules = rules_text(task)
        self._points: dict[str, dict[str, Point]] = {TRAINING: {}, HELD_OUT: {}}

    def distances(
        self,
        part: str,
        numbers: Sequence[Mapping[str, float]],
        scenarios: Iterable[str],
        seeds: Sequence[int],
    ) -> list[list[dict[tuple[str, str], float] | None]]:
        """Distances of sets of numbers, by scenario and distance.

        Args:
            part: of the store, ``TRAINING`` or ``HELD_OUT``.
            numbers: the sets, values by name.
            scenarios: their names.
            seeds: of the scenarios.

        Returns:
            For each set, and for each seed in it, the distances; None where a run has failed.

        Raises:
            ResultsError: all runs have failed, or the store cannot be used.
        """
        scenarios = list(scenarios)
        asked = {
            (number, name, seed): self._point(values, name, seed)
            for number, values in enumerate(numbers)
            for name in scenarios
            for seed in seeds
        }
        rows = self._rows(part, asked.values())
        found: list[list[dict[tuple[str, str], float] | None]] = []
        for number in range(len(numbers)):
            found.append([])
            for seed in seeds:
                own: dict[tuple[str, str], float] | None = {}
                for name in scenarios:
                    row = rows[point_key(asked[number, name, seed])]
                    if row["status"] != DONE or own is None:
                        own = None
                        continue
                    own |= {
                        (name, each.name): float(row[column_of(each.name)])
                        for each in self._task.scenarios[name].distances
                    }
                found[-1].append(own)
        if all(each is None for one in found for each in one):
            said = next(row["error"] for row in rows.values() if row["status"] != DONE)
            raise ResultsError(f"{self._store}: all runs of these numbers fail, the first: {said}")
        return found

    def _point(self, values: Mapping[str, float], name: str, seed: int) -> Point:
        compared = self._task.scenarios[name]
        return {
            "scenario": name,
            "simulates": compared.simulates,
            "measures": compared.measures,
            "distances": compared.functions,
            "scenario_seed": seed,
            "rules": self._rules,
            "longest_s": float(self._task.search.max_seconds or 0.0),
            **values,
        }

    def _rows(self, part: str, points: Iterable[Point]) -> dict[str, dict[str, Any]]:
        """Rows of the store by the key of the point; runs that are missing are done."""
        known = self._points[part]
        wanted = {point_key(point): point for point in points}
        known |= wanted
        experiment = Experiment(
            Trial,
            Table(list(known.values())),
            seed=self._task.seeds.first,
            time_limit=self._task.search.time_limit,
            name=f"Calibration, {part.replace('_', ' ')}",
        )
        kept = run_experiment(experiment, f"{self._store}/{part}", executor=self._workers)
        distances = {
            column_of(each.name) for of in self._task.scenarios.values() for each in of.distances
        }
        table = kept.table(["point", "error", *sorted(distances)])
        rows = {row["point"]: row for row in table.to_pylist()}
        return {key: rows[key] for key in wanted}


def total(task: Task, found: Mapping[tuple[str, str], float], scenarios: Sequence[str]) -> float:
    """The objective of a search: the mean over scenarios of the weighted sum of distances."""
    sums = [
        sum(of.weight * found[name, of.name] for of in task.scenarios[name].distances)
        for name in scenarios
    ]
    return float(np.mean(sums))


def seeds_of(task: Task, generation: int | None) -> list[int]:
    """Seeds of a generation, from 0 on; those held out for None."""
    part = [1] if generation is None else [0, generation]
    count = task.seeds.held_out if generation is None else task.seeds.each
    drawn = np.random.SeedSequence([task.seeds.first, *part]).generate_state(count, np.uint32)
    return [int(each) for each in drawn]


def folder_of(store: str | os.PathLike[str]) -> str:
    """The store as a text without a slash at its end."""
    return os.fspath(store).rstrip("/")
