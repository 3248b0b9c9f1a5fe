"""Many runs: Mesa's ``batch_run``, the same call on every Mesa that is supported."""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from multiprocessing import current_process, get_context
from typing import Any

import mesa

from mesa_mobility.errors import ModelError

_TRIAL, _CALLED_AGAIN = "mesa-mobility trial", 75


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

    Raises:
        ModelError: ``rng`` is among the parameters, or another process cannot import the model.
    """
    if "rng" in parameters:
        raise ModelError("batch_run: rng is among the parameters, expected seeds as rng=[...]")
    if number_processes != 1:
        _check_importable(model_class)
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


def _check_importable(model_class: type[mesa.Model]) -> None:
    """Raise ModelError where a process of its own would not find the class.

    Mesa starts its processes again and again for as long as they fail.
    """
    if current_process().name == _TRIAL:  # this script, imported by the trial below
        sys.exit(_CALLED_AGAIN)
    module, name = model_class.__module__, model_class.__qualname__
    reason = ""
    main = sys.modules["__main__"]
    if "<locals>" in name:
        reason = "it is defined within a function"
    elif module == "__main__" and getattr(main, "__spec__", None) is None:
        file = getattr(main, "__file__", None)
        if file is None or not os.path.isfile(file):
            reason = "it is defined in a notebook or at a prompt"
    if not reason and module == "__main__":
        reason = _tried(model_class)
    if reason:
        raise ModelError(
            f"batch_run: other processes cannot import {name}: {reason}; expected a class of a "
            "module, or number_processes=1"
        )


def _tried(model_class: type[mesa.Model]) -> str:
    """Why a process that is started like those of Mesa does not find the class, or nothing."""
    trial = get_context("spawn").Process(target=id, args=(model_class,), name=_TRIAL)
    trial.start()
    trial.join()
    if trial.exitcode == _CALLED_AGAIN:
        return "its script calls batch_run when it is imported, not below `if __name__ == ...`"
    return "its script fails when it is imported" if trial.exitcode else ""


def _takes_seeds() -> bool:
    return "rng" in inspect.signature(mesa.batch_run).parameters
