"""How far the numbers at the start and those found are from measurements, old and new."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.calibration.outcome import NEW_DATA, NEW_SEEDS, TRAINED, Figure
from mesa_mobility.calibration.runs import HELD_OUT, TRAINING, Runs, seeds_of, total
from mesa_mobility.calibration.task import Task
from mesa_mobility.experiments.intervals import mean_interval

OBJECTIVE = "objective"
"""The name of the figure that the search makes small."""

_BySeed = Sequence[dict[tuple[str, str], float] | None]


def judged(
    task: Task, runs: Runs, found: Mapping[str, float], last_seeds: Sequence[int]
) -> tuple[Figure, ...]:
    """The figures of a calibration.

    Args:
        task: the calibration.
        runs: the runs of this calibration.
        found: the numbers found, by name.
        last_seeds: seeds of the last generation.
    """
    sets = [task.start, dict(found)]
    seen, unseen = task.names(held_out=False), task.names(held_out=True)
    figures: list[Figure] = []
    start, end = runs.distances(TRAINING, sets, seen, last_seeds)
    figures += _figures(task, TRAINED, seen, start, end)
    # One call does the runs of both, side by side.
    everything = [*seen, *unseen]
    start, end = runs.distances(HELD_OUT, sets, everything, seeds_of(task, None))
    figures += _figures(task, NEW_SEEDS, seen, start, end)
    if unseen:
        figures += _figures(task, NEW_DATA, unseen, start, end)
    return tuple(figures)


def _figures(
    task: Task, part: str, scenarios: Sequence[str], start: _BySeed, found: _BySeed
) -> Iterator[Figure]:
    yield _figure(
        part,
        "",
        OBJECTIVE,
        *(
            _values([None if each is None else total(task, each, scenarios) for each in by_seed])
            for by_seed in (start, found)
        ),
    )
    for name in scenarios:
        for distance in task.scenarios[name].distances:
            key = name, distance.name
            yield _figure(
                part,
                name,
                distance.name,
                *(
                    _values([None if each is None else each[key] for each in by_seed])
                    for by_seed in (start, found)
                ),
            )


def _figure(
    part: str,
    scenario: str,
    distance: str,
    start: NDArray[np.float64],
    found: NDArray[np.float64],
) -> Figure:
    return Figure(
        part,
        scenario,
        distance,
        mean_interval(start),
        mean_interval(found),
        mean_interval(found - start),
        int(np.isnan(start).sum() + np.isnan(found).sum()),
    )


def _values(values: Sequence[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if each is None else each for each in values])
