"""Which runs of an experiment are not in its store yet."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.experiments.design.points import Point, point_key, run_name
from mesa_mobility.experiments.experiment import Experiment
from mesa_mobility.experiments.store import DEFINITION, Store

Runs: TypeAlias = Iterator[tuple[Point, int]]
"""Point and number of the replication of one run after the other."""


def count_missing(experiment: Experiment, store: str | os.PathLike[str]) -> int:
    """Runs that ``run_experiment`` would do now; with "auto", at first."""
    return missing_runs(experiment, Store(store))[0]


def missing_runs(experiment: Experiment, store: Store) -> tuple[int, Runs]:
    """Number of runs that are missing now, and the runs.

    Args:
        experiment: with the points and replications asked for.
        store: of the experiment; it need not exist yet.
    """
    there = store.folder.exists(DEFINITION)
    points = range(len(experiment.design))
    keys = np.array([point_key(experiment.point(index)) for index in points], dtype="S16")
    # Whole numbers drawn between bounds may give a point twice.
    _, first = np.unique(keys, return_index=True)
    order: list[int] = np.sort(first).tolist()
    wanted = _wanted(experiment, store if there else None, keys, order)
    known = store.run_names() if there else np.empty(0, dtype="S40")

    def runs() -> Runs:
        for index in order:
            key = keys[index].decode()
            names = np.array(
                [run_name(key, number) for number in range(wanted[index])], dtype="S40"
            )
            # The known ones are in order: to sort them for each point would take for ever.
            at = np.searchsorted(known, names)
            present = np.zeros(len(names), dtype=bool)
            inside = at < len(known)
            present[inside] = known[at[inside]] == names[inside]
            for number in np.flatnonzero(~present).tolist():
                yield experiment.point(index), number

    return sum(1 for _ in runs()), runs()


def _wanted(
    experiment: Experiment, store: Store | None, keys: NDArray[np.bytes_], order: list[int]
) -> dict[int, int]:
    """Replications that each point should have by now."""
    if experiment.replications != "auto":
        return dict.fromkeys(order, experiment.replications)
    found = store.assessments(experiment) if store is not None else {}
    precision = experiment.precision
    wanted = {}
    for index in order:
        known = found.get(keys[index].decode())
        have = known.runs if known else 0
        ended = known and have >= precision.least and (known.enough or known.hopeless)
        wanted[index] = have if ended else precision.next_count(have)
    return wanted
