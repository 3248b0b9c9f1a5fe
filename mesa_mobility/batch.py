"""Many runs: Mesa's ``batch_run``, the same call on every Mesa that is supported."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import product
from typing import Any, TypeAlias

from tqdm.auto import tqdm

from mesa_mobility._mesa import mesa
from mesa_mobility.errors import ModelError
from mesa_mobility.runs.choice import workers_for
from mesa_mobility.runs.jobs import Failed, run_jobs
from mesa_mobility.runs.processes import available_processors, check_importable

_Rows: TypeAlias = list[dict[str, Any]]


def batch_run(
    model_class: type[mesa.Model],
    parameters: Mapping[str, Any],
    *,
    rng: Sequence[int | None] = (None,),
    max_steps: int = 10_000,
    number_processes: int | None = 1,
    data_collection_period: int = -1,
    display_progress: bool = True,
) -> list[dict[str, Any]]:
    """Run a model over all combinations of parameters, once for each seed.

    Mesa 3.3 takes seeds among the parameters, 3.5 as an argument of their own and overwrites the
    former; this takes them as ``rng`` on both. A run that fails does not lose the others.

    Args:
        model_class: an importable model (workers are spawned).
        parameters: values, or iterables of values, by name.
        rng: seeds.
        max_steps: steps after which a run is cut.
        number_processes: None for one a processor.
        data_collection_period: steps between two rows of a run; -1 for its last step only.
        display_progress: show a progress bar.

    Returns:
        One row a run and collected step, with parameters and collected values. A run that fails
        has one row with its parameters and ``error``, and gives a warning.

    Raises:
        ModelError: ``rng`` is among the parameters, fewer than one process, another process cannot
            import the model, or all runs fail.
    """
    if "rng" in parameters:
        raise ModelError("batch_run: rng is among the parameters, expected seeds as rng=[...]")
    if number_processes != 1:
        check_importable(model_class, "batch_run")
    run = partial(_run, model_class, max_steps, data_collection_period)
    runs = list(product(enumerate(rng), _combinations(parameters)))
    alone = (number_processes or available_processors()) == 1
    workers, _ = workers_for("serial" if alone else "processes", number_processes)
    results: dict[int, _Rows | Failed] = {}
    with tqdm(total=len(runs), disable=not display_progress) as bar:
        for (number, _), rows in run_jobs(run, enumerate(runs), workers):
            results[number] = rows
            bar.update()
    failed = [each for _, each in sorted(results.items()) if isinstance(each, Failed)]
    if failed:
        said = f"batch_run: {len(failed)} of {len(runs)} runs fail, the first with "
        said += failed[0].error
        if len(failed) == len(runs):
            raise ModelError(said)
        warnings.warn(said, RuntimeWarning, stacklevel=2)
    rows_of_all: _Rows = []
    for number, ((iteration, seed), values) in enumerate(runs):
        found = results[number]
        where = {"RunId": number, "iteration": iteration}
        if isinstance(found, Failed):
            found = [{"Step": None, "rng": seed, **values, "error": found.error}]
        rows_of_all += [{**row, **where} for row in found]
    return rows_of_all


def _combinations(parameters: Mapping[str, Any]) -> list[dict[str, Any]]:
    """All combinations of the values; a text is one value."""
    lists = [
        list(values) if isinstance(values, Iterable) and not isinstance(values, str) else [values]
        for values in parameters.values()
    ]
    return [dict(zip(parameters, values, strict=True)) for values in product(*lists)]


def _run(model_class: type[mesa.Model], max_steps: int, period: int, each: Any) -> _Rows:
    """The rows that Mesa gives for one run."""
    _, ((_, seed), values) = each
    options: dict[str, Any] = {
        "max_steps": max_steps,
        "number_processes": 1,
        "data_collection_period": period,
        "display_progress": False,
    }
    # In lists, or Mesa would take a list of values for several runs.
    keywords = {name: [value] for name, value in values.items()}
    if "rng" in inspect.signature(mesa.batch_run).parameters:
        rows: _Rows = mesa.batch_run(model_class, keywords, rng=[seed], **options)
        return rows
    rows = mesa.batch_run(model_class, {**keywords, "rng": [seed]}, **options)
    return rows
