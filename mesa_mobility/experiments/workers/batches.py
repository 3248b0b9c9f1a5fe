"""Batches of runs, as a worker does them: with a journal while it runs, and one file at the end.

The journal has a line for each run that begins or ends. Where a worker dies, the next one that
gets the batch goes on after the last run that ended. A run during which workers die twice counts
as failed.
"""

from __future__ import annotations

import faulthandler
import gc
import json
import os
import tempfile
import threading
import uuid
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.design.points import Point, point_key, run_name
from mesa_mobility.experiments.storing.rows import FAILED, RUNS, TIMED_OUT, TRAJECTORIES, WORK, Row
from mesa_mobility.experiments.storing.shards import Folder, read_table, table_of, write_table
from mesa_mobility.experiments.workers.compiling import compile_once
from mesa_mobility.experiments.workers.one_run import (
    Setup,
    first_columns,
    run_once,
)

DEATHS = 2
"""Deaths of workers during a run after which it counts as failed."""

_WORTH_COLLECTING = 2.0
"""Seconds of runs after which a tenth of a second for the collection of garbage is little."""

_OF_EVERYTHING = 20
"""One collection of so many goes through all objects: some of those that were left over by an
earlier one may be garbage since."""

_collections = count()
_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Batch:
    """Runs that a worker does one after the other.

    Attributes:
        name: of its files.
        runs: point and number of the replication of each.
    """

    name: str
    runs: tuple[tuple[Point, int], ...]


@dataclass(frozen=True)
class Finished:
    """What a worker says of a batch.

    Attributes:
        statuses: number of runs by status.
        wall_s: seconds that the runs took.
    """

    statuses: dict[str, int]
    wall_s: float


def run_batch(setup: Setup, batch: Batch) -> Finished:
    """Do the runs of a batch that are missing, and write the rows of all.

    Threads of one process take turns.

    Raises:
        ResultsError: the store cannot be written.
    """
    with _one_at_a_time:
        folder = Folder(setup.store)
        name = f"{RUNS}/{batch.name}.parquet"
        if folder.exists(name):  # the worker before has died, or its message was lost
            table = read_table(folder, name, ["status", "wall_s"])
            if table is not None:
                return _finished(table.to_pylist())
        compile_once(setup.model)
        journal = Journal.of(folder, batch.name)
        rows = list(_rows(setup, batch, folder, journal))
        write_table(folder, name, table_of(rows, setup.column_types))
        journal.remove()
        finished = _finished(rows)
        if setup.may_end and finished.wall_s >= _WORTH_COLLECTING:
            _collect()
        return finished


def _collect() -> None:
    """Free the models of a batch.

    They and their agents know each other. Python finds few objects in them, however large their
    arrays are, and would let hundreds of models wait.
    """
    if next(_collections) % _OF_EVERYTHING == 0:
        gc.unfreeze()
    gc.collect()
    # The next collections need not go through what is left: Dask's profile of an hour is millions
    # of dictionaries.
    gc.freeze()


class Journal:
    """What has become of the runs of a batch, line by line.

    Args:
        path: local file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.late = path.with_suffix(".late")
        self.rows: dict[str, Row] = {}
        self.begun: Counter[str] = Counter()
        self._before = ""
        self._read()

    @classmethod
    def of(cls, folder: Folder, batch: str) -> Journal:
        """The journal of a batch; on this machine where the store is no file system."""
        place = (
            Path(folder.path(WORK))
            if folder.local
            else (
                Path(tempfile.gettempdir())
                / f"mesa-mobility-{os.getuid() if os.name == 'posix' else 0}-work"
            )
        )
        try:
            place.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ResultsError(f"{place}: cannot be made: {error.strerror or error}") from error
        return cls(place / f"{batch}.jsonl")

    def begin(self, run: str) -> None:
        """Note that a run begins."""
        self._write({"begin": run})

    def end(self, row: Row) -> None:
        """Note a run that has ended."""
        self._write({"row": row})

    def remove(self) -> None:
        """Delete it."""
        self.path.unlink(missing_ok=True)
        self.late.unlink(missing_ok=True)

    @property
    def was_late(self) -> bool:
        """Whether the last run was ended because it did not return in time."""
        with suppress(OSError):
            return self.late.stat().st_size > 0
        return False

    def _read(self) -> None:
        try:
            text = self.path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            return
        # A line that is not whole must not take the next one along.
        self._before = "" if text.endswith("\n") or not text else "\n"
        for line in text.splitlines():
            try:
                entry = json.loads(line)
            except ValueError:  # the process was killed while it wrote the line
                continue
            if "begin" in entry:
                self.begun[entry["begin"]] += 1
            elif "row" in entry:
                self.rows[entry["row"]["run"]] = entry["row"]

    def _write(self, entry: dict[str, Any]) -> None:
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(self._before + json.dumps(entry) + "\n")
            self._before = ""
        except OSError as error:
            raise ResultsError(
                f"{self.path.parent}: cannot be written: {error.strerror or error}"
            ) from error


def salvage(folder: Folder, column_types: dict[str, str]) -> None:
    """Bring the rows in the journals of dead workers into the store, and delete the journals."""
    if not folder.local:
        return
    paths = sorted(Path(folder.path(WORK)).glob("*.jsonl"))
    journals = [Journal(path) for path in paths]
    rows: list[Row] = [row for journal in journals for row in journal.rows.values()]
    if rows:
        name = f"{RUNS}/salvaged-{uuid.uuid4().hex}.parquet"
        write_table(folder, name, table_of(rows, column_types))
    for journal in journals:
        journal.remove()


def rows_of_lost_workers(setup: Setup, batch: Batch, reason: str) -> None:
    """Write rows of failed runs for a batch of which no worker comes back."""
    rows = [
        {**first_columns(setup, point, replication), "error": reason}
        for point, replication in batch.runs
    ]
    folder = Folder(setup.store)
    write_table(folder, f"{RUNS}/{batch.name}.parquet", table_of(rows, setup.column_types))


def _rows(setup: Setup, batch: Batch, folder: Folder, journal: Journal) -> Iterator[Row]:
    late = journal.was_late
    for point, replication in batch.runs:
        run = run_name(point_key(point), replication)
        row = journal.rows.get(run)
        if row is None and journal.begun[run]:
            row = _death(setup, point, replication, deaths=journal.begun[run], late=late)
            if row is not None:
                journal.end(row)
        if row is None:
            journal.begin(run)
            with _ended_when_late(setup, journal.late):
                row, model = run_once(setup, point, replication)
            if setup.trajectories and _has_tracks(model):
                _write_trajectories(folder, model, row["run"])
            journal.end(row)
        yield row


def _death(setup: Setup, point: Point, replication: int, *, deaths: int, late: bool) -> Row | None:
    """The row of a run during which workers have died, or None if it may be tried again."""
    row = first_columns(setup, point, replication)
    if late:
        limit = setup.time_limit
        return {
            **row,
            "status": TIMED_OUT,
            "wall_s": limit,
            "cpu_s": limit,
            "error": f"took longer than {limit:g} s, without an end to its step",
        }
    if deaths >= DEATHS:
        return {**row, "status": FAILED, "error": f"{deaths} workers died during this run"}
    return None


@contextmanager
def _ended_when_late(setup: Setup, said_in: Path) -> Iterator[None]:
    """End this process where the block takes far longer than the limit, whatever it is doing.

    Another thread of Python could not: compiled code may hold the interpreter's lock.
    """
    if setup.time_limit is None or not setup.may_end:
        yield
        return
    with said_in.open("w") as file:
        faulthandler.dump_traceback_later(setup.time_limit * 1.25 + 1.0, exit=True, file=file)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()


def _has_tracks(model: Any) -> bool:
    """Whether a model has recorded anything: a run that failed at its start has not."""
    recorder = getattr(model, "recorder", None)
    return recorder is not None and len(recorder.arrays()["frame"]) > 0


def _write_trajectories(folder: Folder, model: Any, run: str) -> None:
    from mesa_mobility.results import Trajectories

    name = f"{TRAJECTORIES}/{run}.parquet"
    if folder.local:
        Trajectories.of(model).to_parquet(folder.path(name))
        return
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "trajectories.parquet"
        Trajectories.of(model).to_parquet(path)
        folder.write_bytes(name, path.read_bytes())


def _finished(rows: Iterable[Row]) -> Finished:
    rows = list(rows)
    return Finished(dict(Counter(row["status"] for row in rows)), sum(r["wall_s"] for r in rows))
