"""Which workers do the jobs that a caller has."""

from __future__ import annotations

from concurrent.futures import Executor
from contextlib import ExitStack
from typing import Any

from mesa_mobility.errors import ModelError
from mesa_mobility.runs.processes import available_processors
from mesa_mobility.runs.workers import Futures, Processes, Serial, Workers


def workers_for(executor: Any, count: int | None) -> tuple[Workers, ExitStack]:
    """Workers as ``run_experiment`` is asked for them, and what is to be closed after them.

    Args:
        executor: see ``run_experiment``; or workers that somebody has already, and closes.
        count: of workers; None for one a processor.

    Raises:
        ModelError: an unknown kind of executor, a number out of range, or no Dask.
    """
    if count is not None and (isinstance(count, bool) or not isinstance(count, int) or count < 1):
        raise ModelError(f"workers is {count!r}, expected 1 or more")
    closing = ExitStack()
    if isinstance(executor, Serial | Futures):
        return executor, closing
    workers: Workers
    if executor == "serial":
        workers = Serial()
    elif executor == "processes":
        workers = Processes(count or available_processors())
    elif isinstance(executor, Executor):
        given = executor
        known = getattr(given, "_max_workers", None) or available_processors()
        workers = Futures(
            lambda function, job: given.submit(function, job), count or known, own_processes=False
        )
    else:
        from mesa_mobility.runs.dask_workers import dask_workers

        workers = dask_workers(executor, count, closing)
    closing.callback(workers.close)
    return workers, closing
