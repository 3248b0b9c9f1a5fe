"""Many runs: Mesa's ``batch_run``, the same call on every Mesa that is supported."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mesa


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
    former; this takes them as ``rng`` on both.

    Args:
        model_class: an importable model (workers are spawned).
        parameters: values, or iterables of values, by name.
        rng: seeds.
        max_steps: steps after which a run is cut.
        number_processes: None for one a processor.
        data_collection_period: steps between two rows of a run; -1 for its last step only.
        display_progress: show Mesa's progress bar.

    Returns:
        One row a run and collected step, with parameters and collected values.
    """
    seeds = list(rng)
    options: dict[str, Any] = {
        "max_steps": max_steps,
        "number_processes": number_processes,
        "data_collection_period": data_collection_period,
        "display_progress": display_progress,
    }
    if _takes_seeds():
        return mesa.batch_run(model_class, dict(parameters), rng=seeds, **options)
    values: dict[str, Any | Iterable[Any]] = {**parameters, "rng": seeds}
    return mesa.batch_run(model_class, values, **options)


def _takes_seeds() -> bool:
    return "rng" in inspect.signature(mesa.batch_run).parameters
