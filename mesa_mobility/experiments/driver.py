"""Running an experiment: what is missing goes out in batches, a bounded number at a time."""

from __future__ import annotations

import math
import os
import uuid
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from typing import Any

import numpy as np

from mesa_mobility.crowd.model_files import is_model_file
from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.design.points import point_key, run_name
from mesa_mobility.experiments.experiment import COMMON, Experiment, check_parameters
from mesa_mobility.experiments.missing import Runs, missing_runs
from mesa_mobility.experiments.session import session_of
from mesa_mobility.experiments.store import Store
from mesa_mobility.experiments.storing.rows import ENDED, RUNS, TRAJECTORIES
from mesa_mobility.experiments.workers.batches import (
    DEATHS,
    Batch,
    Finished,
    Journal,
    rows_of_lost_workers,
    run_batch,
    salvage,
)
from mesa_mobility.experiments.workers.one_run import Setup
from mesa_mobility.runs.choice import workers_for
from mesa_mobility.runs.jobs import in_flight
from mesa_mobility.runs.processes import check_importable, check_main
from mesa_mobility.runs.workers import WorkerDied, Workers

BATCH_SECONDS = 5.0
"""Seconds that a batch should take at least: long beside its message, short beside a run lost."""

_BATCHES = 40
"""Batches a second that a scheduler bears; see docs/explanation/scaling_experiments.md."""

_MOST_RUNS = 500
"""Runs of a batch at most."""

_LOOSE = 48
"""Files of rows that come together before they are merged."""

_ATTEMPTS = 3
"""Workers that may die with a batch before its runs go out one by one, or count as failed."""

_MOST_ATTEMPTS = 20
"""The same for a run that these workers had not begun, but waited with."""


@dataclass
class Progress:
    """How far an experiment has come.

    Attributes:
        total: number of runs to do now, without those that were there before.
        ended: number of these runs that have ended.
        statuses: number of ended runs by status.
        runs_s: seconds that the ended runs took, on all workers together.
        address: of the page on which the executor shows its work; empty if it has none.
    """

    total: int = 0
    ended: int = 0
    statuses: Counter[str] = field(default_factory=Counter)
    runs_s: float = 0.0
    address: str = ""

    @property
    def failed(self) -> int:
        """Runs that have failed or timed out."""
        return self.ended - sum(self.statuses[each] for each in ENDED)

    def add(self, finished: Finished) -> None:
        """Add what a worker has finished."""
        self.statuses.update(finished.statuses)
        self.ended += sum(finished.statuses.values())
        self.runs_s += finished.wall_s


def run_experiment(
    experiment: Experiment,
    store: str | os.PathLike[str],
    *,
    executor: Any = "processes",
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Store:
    """Run what is missing of an experiment.

    Args:
        experiment: what is to be run. Points and replications may be added later.
        store: path or fsspec URL of its folder, made if need be.
        executor: "processes" (spawned), "serial", "dask" (a cluster on this machine), the address
            of a Dask scheduler, a ``distributed.Client`` or cluster, or any
            ``concurrent.futures.Executor``. Results do not depend on it.
        workers: processes, or workers of a cluster on this machine; None for one a processor.
        progress: called after each batch, and once a second. If it raises, the experiment stops,
            and goes on where it stopped when it is run again.

    Returns:
        The store.

    Raises:
        ModelError: a model, parameter, executor or store that does not fit.
        ResultsError: the store cannot be read or written, another process is running the
            experiment, or all workers are gone.
    """
    check_parameters(experiment)
    kept = Store(store)
    told = progress or (lambda now: None)

    if executor in ("processes", "dask"):  # before the lock: this may be a trial of the script
        # Dask sends a class of a notebook along with its runs.
        if executor == "processes" and isinstance(experiment.model, type):
            check_importable(experiment.model, "run_experiment")
        check_main("run_experiment")
    with kept.locked():
        kept.prepare(experiment, session_of(experiment, executor))
        for name in ("", RUNS, TRAJECTORIES):
            kept.folder.remove_half_written(name)
        salvage(kept.folder, experiment.column_types())
        crew, closing = workers_for(executor, workers)
        driver = _Driver(experiment, kept, crew, told)
        try:
            with closing:
                driver.run()
        finally:
            salvage(kept.folder, experiment.column_types())
            kept.compact()
    return kept


class _Driver:
    def __init__(
        self,
        experiment: Experiment,
        store: Store,
        workers: Workers,
        told: Callable[[Progress], None],
    ) -> None:
        self._experiment, self._store, self._told = experiment, store, told
        self._workers = workers
        self._attempts: Counter[str] = Counter()
        self._per_run: float | None = None
        self.progress = Progress(address=workers.address)

    def run(self) -> None:
        """Do what is missing, round by round."""
        setup = self._setup(self._workers.own_processes)
        while True:
            count, runs = missing_runs(self._experiment, self._store)
            if not count:
                return
            self.progress.total += count
            self._told(self.progress)
            self._do(setup, runs)
            if self._experiment.replications != "auto":
                return

    def _do(self, setup: Setup, runs: Runs) -> None:
        loose = 0
        again: list[Batch] = []

        def following() -> Batch | None:
            return again.pop() if again else self._batch(runs)

        for ended in in_flight(partial(run_batch, setup), following, self._workers, each=2):
            for batch, answer in ended:
                if isinstance(answer, Finished):
                    self._attempts.pop(batch.name, None)
                    self._check_kept(batch)
                    self._note(answer)
                    loose += 1
                elif isinstance(answer, WorkerDied):
                    again += self._again(setup, batch)
                else:
                    raise self._as_told(answer) from answer
            if loose >= _LOOSE:
                self._store.compact()
                loose = 0
            self._told(self.progress)

    def _check_kept(self, batch: Batch) -> None:
        """Raise ResultsError where a worker has written its rows, but not to this store."""
        if self._store.folder.exists(f"{RUNS}/{batch.name}.parquet"):
            return
        # Another driver may have merged the file, where there are no locks.
        names = [run_name(point_key(point), number) for point, number in batch.runs]
        if not np.isin(np.array(names, dtype="S40"), self._store.run_names()).all():
            raise ResultsError(
                f"{self._store}: has no rows of runs that have ended, expected a folder or URL "
                "that all workers share"
            )

    def _batch(self, runs: Runs) -> Batch | None:
        """The next batch; the first ones are single runs, which tell how long a run takes."""
        size = 1
        if self._per_run is not None:
            seconds = max(BATCH_SECONDS, self._workers.count / _BATCHES)
            size = max(1, min(_MOST_RUNS, math.floor(seconds / max(self._per_run, 1e-6))))
            left = self.progress.total - self.progress.ended
            # Towards the end no worker waits for the batch of another.
            size = min(size, max(1, left // (4 * self._workers.count)))
        taken = tuple(islice(runs, size))
        return Batch(uuid.uuid4().hex, taken) if taken else None

    def _note(self, finished: Finished) -> None:
        self.progress.add(finished)
        runs = sum(finished.statuses.values())
        now = finished.wall_s / runs
        # Only a run of its own may contain compilation: later ones soon outweigh it.
        self._per_run = now if self._per_run is None else 0.5 * (self._per_run + now)

    def _again(self, setup: Setup, batch: Batch) -> list[Batch]:
        """Batches to have done anew after the worker of one has died."""
        self._attempts[batch.name] += 1
        if self._attempts[batch.name] < _ATTEMPTS:
            return [batch]
        if len(batch.runs) > 1:
            return [Batch(f"{batch.name}-{k}", (run,)) for k, run in enumerate(batch.runs)]
        if self._is_innocent(batch):
            return [batch]
        reason = f"{_ATTEMPTS} workers died during this run"
        rows_of_lost_workers(setup, batch, reason)
        self._note(Finished({"failed": 1}, 0.0))
        return []

    def _is_innocent(self, batch: Batch) -> bool:
        """Whether a batch of one run waited behind others whenever its worker died."""
        folder = self._store.folder
        if not folder.local or self._attempts[batch.name] >= _MOST_ATTEMPTS:
            return False
        [(point, replication)] = batch.runs
        begun = Journal.of(folder, batch.name).begun
        return begun[run_name(point_key(point), replication)] < DEATHS

    def _as_told(self, error: BaseException) -> BaseException:
        done = f"{self.progress.ended} of {self.progress.total} runs have ended and are kept"
        text = " ".join(f"{error}".split()) or type(error).__name__
        if isinstance(error, ResultsError):
            return ResultsError(f"{text}; {done}")
        return ResultsError(
            f"{self._store}: the workers fail: {type(error).__name__}: {text}; {done}"
        )

    def _setup(self, own_processes: bool) -> Setup:
        experiment = self._experiment
        folder = self._store.folder
        return Setup(
            model=_found_anywhere(experiment.model),
            seed=experiment.seed,
            common_seeds=experiment.seeds == COMMON,
            max_seconds=experiment.max_seconds,
            time_limit=experiment.time_limit,
            occupancy=experiment.keeps_occupancy,
            trajectories="trajectories" in experiment.keep,
            doors="doors" in experiment.keep,
            column_types=experiment.column_types(),
            # Workers may have been started in another folder.
            store=os.path.abspath(folder.root) if folder.local else folder.url,
            may_end=own_processes,
        )


def _found_anywhere(model: type | str) -> type | str:
    """A model as workers find it that were started in another folder."""
    return os.path.abspath(model) if isinstance(model, str) and is_model_file(model) else model
