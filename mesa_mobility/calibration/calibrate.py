"""Calibration by simulation: search on training data, judge on seeds and data held out."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from mesa_mobility.calibration.judging import judged
from mesa_mobility.calibration.optimiser import Optimiser, costs_of
from mesa_mobility.calibration.outcome import Calibrated, Generation
from mesa_mobility.calibration.report import write_report
from mesa_mobility.calibration.runs import TRAINING, Runs, folder_of, seeds_of, total
from mesa_mobility.calibration.settings import Free, Search, Seeds
from mesa_mobility.calibration.task import Distances, Task, task_of
from mesa_mobility.crowd.presets.files import write_preset
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.storing.shards import Folder
from mesa_mobility.runs.choice import workers_for
from mesa_mobility.runs.processes import check_main

DEFINITION, PRESET, REPORT = "calibration.json", "preset.toml", "report.html"
FORMAT_VERSION = 1


def calibrate(
    scenarios: Mapping[str, Any],
    data: Mapping[str, Any],
    *,
    free: Sequence[str | Free],
    distances: Distances | Mapping[str, Distances],
    store: str | os.PathLike[str],
    seeds: Seeds | int = 1,
    search: Search | None = None,
    executor: Any = "processes",
    workers: int | None = None,
) -> Calibrated:
    """Find numbers of behaviours for which simulated crowds are near to measured ones.

    CMA-ES asks for sets of numbers. Each is run on all scenarios whose data are not held out, with
    seeds that are new in each generation. The search makes the mean over the scenarios of the
    weighted sum of their distances small. In the end, the numbers at the start and those found are
    run with seeds that the search has not had, on all data, those held out included.

    All runs are kept. The same call goes on where an interrupted one stopped, or further with more
    evaluations, to the same result as without an interruption, whatever the executor.

    Args:
        scenarios: by name, functions of a seed or names of models. A function makes a model, which
            is run and recorded if it has not been, and whose trajectories are compared; or it gives
            anything else that distances compare. Models that it makes have the numbers that are
            tried, as in ``model_rules``.
        data: what was measured, by scenario: the path of a file, a function that gives the data, or
            numbers, texts and lists of them. ``HeldOut(...)`` around it hides it from the search.
        free: names of numbers whose range has two ends, or a ``Free`` for each.
        distances: functions of what was simulated and what was measured, or a ``Distance`` with a
            weight for each; or such a list by scenario.
        store: path or fsspec URL of a folder, made if need be. It has the stores ``training`` and
            ``held_out`` of two experiments; on this machine also ``preset.toml`` and
            ``report.html``.
        seeds: of each set of numbers in a generation, or ``Seeds``.
        search: the number of evaluations, the preset at the start, and limits.
        executor: as for ``run_experiment``.
        workers: as for ``run_experiment``.

    Returns:
        The numbers, the preset, and the figures.

    Raises:
        ModelError: an argument that does not fit, or a store of another calibration.
        ResultsError: a file or the store cannot be used, or all runs of a generation fail.
    """
    task = task_of(
        scenarios,
        data,
        free=free,
        distances=distances,
        seeds=seeds if isinstance(seeds, Seeds) else Seeds(seeds),
        search=Search() if search is None else search,
    )
    optimiser = Optimiser(task.free, task.search, task.seeds.first)
    place = folder_of(store)
    folder = Folder(place)
    if executor == "processes":
        check_main("calibrate")
    crew, closing = workers_for(executor, workers)
    with closing:
        began = _prepare(folder, task)
        runs = Runs(task, place, crew)
        history = _searched(task, optimiser, runs)
        figures = judged(task, runs, optimiser.middle, seeds_of(task, len(history) - 1))
    found = Calibrated(
        place, began, task.preset, task.files, optimiser.middle, tuple(history), figures
    )
    if folder.local:
        write_preset(found.preset, folder.path(PRESET))
        write_report(found, task, folder.path(REPORT))
    return found


def _searched(task: Task, optimiser: Optimiser, runs: Runs) -> list[Generation]:
    """Search, generation by generation."""
    training = task.names(held_out=False)
    history: list[Generation] = []
    for generation in range(math.ceil(task.search.evaluations / optimiser.candidates)):
        numbers = optimiser.ask()
        found = runs.distances(TRAINING, numbers, training, seeds_of(task, generation))
        totals: dict[int, float | None] = {}
        for number, by_seed in enumerate(found):
            whole = [total(task, each, training) for each in by_seed if each is not None]
            totals[number] = sum(whole) / len(whole) if len(whole) == len(by_seed) else None
        if all(value is None for value in totals.values()):
            raise ResultsError(
                f"{generation + 1}. generation: each set of numbers has a run that failed"
            )
        costs = costs_of(totals, len(numbers))
        optimiser.tell(costs)
        failed = sum(value is None for value in totals.values())
        history.append(Generation(numbers, costs, failed, optimiser.middle))
        if optimiser.has_ended:
            break
    return history


def _prepare(folder: Folder, task: Task) -> str:
    """Write what is calibrated, or compare it with what a store holds.

    Returns:
        The day on which the calibration began.

    Raises:
        ModelError: the store is of another calibration.
        ResultsError: the store is damaged, or cannot be written.
    """
    said = json.loads(json.dumps(task.definition()))
    folder.make("")
    if folder.exists(DEFINITION):
        try:
            values = json.loads(folder.read_bytes(DEFINITION))
            version, before, began = (
                values[key] for key in ("format_version", "calibration", "began")
            )
            datetime.fromisoformat(began)
            known = dict(before)
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            raise ResultsError(f"{folder.url}/{DEFINITION}: damaged: {error}") from error
        if version != FORMAT_VERSION:
            raise ResultsError(f"{folder.url}: format version {version}, expected {FORMAT_VERSION}")
        for key, value in said.items():
            if known.get(key) != value:
                raise ModelError(
                    f"{folder.url}: holds a calibration with other {key}, expected another store"
                )
        return str(began)
    began = datetime.now(UTC).date().isoformat()
    values = {"format_version": FORMAT_VERSION, "began": began, "calibration": said}
    folder.write_bytes(DEFINITION, (json.dumps(values, indent=1) + "\n").encode())
    return began
