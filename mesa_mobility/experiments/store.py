"""The store of an experiment: a folder with its definition and the rows of its runs.

experiment.json      the definition, and the versions and maps of each session
runs/*.parquet       one row a run
trajectories/        one file a run, where trajectories are kept
work/                journals of batches under way
driver.lock          held by the process that runs the experiment
"""

from __future__ import annotations

import json
import os
import uuid
from collections import Counter
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.convergence import Assessment, assess, check_figure
from mesa_mobility.experiments.definition import (
    check_definition,
    from_definition,
    to_definition,
)
from mesa_mobility.experiments.design.points import point_key
from mesa_mobility.experiments.experiment import Experiment
from mesa_mobility.experiments.intervals import Estimate
from mesa_mobility.experiments.observed import estimate, observed
from mesa_mobility.experiments.session import check_goes_on, check_inputs
from mesa_mobility.experiments.storing.locks import is_locked, locked
from mesa_mobility.experiments.storing.rows import (
    ENDED,
    FAILED,
    RUNS,
    SERIES,
    STATUSES,
    TRAJECTORIES,
    WORK,
)
from mesa_mobility.experiments.storing.shards import Folder, joined, read_table, write_table
from mesa_mobility.plugins.registry import did_you_mean

if TYPE_CHECKING:
    import pandas as pd

DEFINITION = "experiment.json"
FORMAT_VERSION = 1
_SMALL = 4_000_000
"""Bytes below which a file of rows is merged with others."""


class Store:
    """The store of an experiment.

    Args:
        url: path or fsspec URL of the folder.
    """

    def __init__(self, url: str | os.PathLike[str]) -> None:
        self.folder = Folder(url)

    def __str__(self) -> str:
        return self.folder.url

    def definition(self) -> dict[str, Any]:
        """The content of ``experiment.json``.

        Raises:
            ResultsError: the file is missing, damaged, or of another format version.
        """
        try:
            values = json.loads(self.folder.read_bytes(DEFINITION))
            if values["format_version"] != FORMAT_VERSION:
                raise ResultsError(
                    f"{self}: format version {values['format_version']}, expected {FORMAT_VERSION}"
                )
            check_definition(values)
            return dict(values)
        except (FileNotFoundError, NotADirectoryError) as error:
            raise ResultsError(
                f"{self}: has no {DEFINITION}, expected the store of an experiment"
            ) from error
        except KeyError as error:
            raise ResultsError(f"{self}/{DEFINITION}: damaged: no {error}") from error
        except (OSError, ValueError, TypeError, RecursionError) as error:
            raise ResultsError(f"{self}/{DEFINITION}: damaged: {error}") from error

    def experiment(self) -> Experiment:
        """The experiment, as it was last run.

        Raises:
            ResultsError: its definition is missing or damaged.
        """
        definition = self.definition()["experiment"]
        try:
            return from_definition(definition)
        except ModelError as error:
            raise ResultsError(f"{self}/{DEFINITION}: damaged: {error}") from error

    def table(self, columns: Sequence[str] | None = None) -> pa.Table:
        """Rows as an Arrow table, each run once, in no particular order.

        Args:
            columns: the columns to read beside ``run`` and ``status``; all by default.

        Raises:
            ResultsError: a damaged file.
        """
        wanted = None if columns is None else list(dict.fromkeys(["run", "status", *columns]))
        while True:
            tables = {name: read_table(self.folder, name, wanted) for name in self.shards()}
            gone = [name for name, table in tables.items() if table is None]
            if not gone:
                return joined(table for table in tables.values() if table is not None)
            # Where files were merged meanwhile, their rows are in a file that was not listed.
            if still := sorted({*gone} & {*self.shards()}):
                raise ResultsError(f"{self}/{still[0]}: is listed, but is no file")

    def frame(self, *, series: bool = False) -> pd.DataFrame:
        """Rows as a pandas data frame, by point of the experiment's design and replication.

        Args:
            series: whether to include the columns that hold lists.
        """
        table = self.table()
        if not series:
            table = table.drop_columns([n for n in table.column_names if n in SERIES])
        experiment = self.experiment()
        place: dict[str, int] = {}
        for index in range(len(experiment.design)):
            place.setdefault(point_key(experiment.point(index)), index)
        order = sorted(
            zip(
                (place.get(key, len(place)) for key in table["point"].to_pylist()),
                table["point"].to_pylist(),
                table["replication"].to_pylist(),
                range(table.num_rows),
                strict=True,
            )
        )
        numbers = pa.array([number for *_, number in order], type=pa.int64())
        return table.take(numbers).to_pandas()

    def status(self) -> dict[str, Any]:
        """Number of runs by status, and of those asked for and missing.

        Runs that are in the store but no longer asked for count by their status alone. With
        ``replications="auto"`` the number asked for is the number known so far.
        """
        experiment, table = self.experiment(), self.table(["point", "replication", "wall_s"])
        counts = Counter(table["status"].to_pylist())
        asked: int | None = None
        missing: int | None = None
        if experiment.replications != "auto":
            keys = {point_key(experiment.point(i)) for i in range(len(experiment.design))}
            asked = len(keys) * experiment.replications
            there = zip(table["point"].to_pylist(), table["replication"].to_pylist(), strict=True)
            missing = asked - sum(key in keys and n < experiment.replications for key, n in there)
        return {
            "store": str(self),
            "asked": asked,
            "missing": missing,
            **{status: counts.get(status, 0) for status in STATUSES},
            "runs_s": float(np.sum(table["wall_s"].to_numpy())),
            "files": len(self.shards()),
            "running": self.is_locked(),
        }

    def estimates(self, figure: str, confidence: float = 0.95) -> dict[str, Estimate]:
        """Estimate and interval of a figure over the replications of each point, by its key.

        Runs that have stalled, timed out or ended with people inside count as later than all
        others; those that have failed do not count.

        Args:
            figure: such as "mean egress_s" or "p95 egress_s".
            confidence: of the intervals.

        Raises:
            ModelError: the figure is none.
            ResultsError: no such column.
        """
        check_figure(figure)
        column = figure.split(" ", 1)[1]
        frame = self.table(["point", column]).to_pandas()
        if column not in frame:
            raise ResultsError(f"{self}: has no column {column}")
        return {
            str(key): estimate(figure, observed(of, column), confidence)
            for key, of in frame.groupby("point")
        }

    def assessments(self, experiment: Experiment | None = None) -> dict[str, Assessment]:
        """How well the figures of ``replications="auto"`` are known, by key of the point.

        Args:
            experiment: with the precision asked for; by default that of the store.

        Raises:
            ModelError: runs have ended, but have no such column of numbers.
        """
        precision = (experiment or self.experiment()).precision
        columns = ["point", "replication", *precision.columns]
        if precision.occupancy is not None:
            columns.append("occupancy")
        table = self.table(columns)
        if not table.num_rows:
            return {}
        if ENDED & {*pa.compute.unique(table["status"]).to_pylist()}:
            self._check_figures(precision.columns, table.schema)
        frame = table.to_pandas().sort_values(["point", "replication"])
        found = {}
        for key, every in frame.groupby("point"):
            # What has ended after an interruption are the short runs: only rounds that are
            # complete are looked at.
            whole = every["replication"].to_numpy() == np.arange(len(every))
            count = precision.last_look(len(every) if whole.all() else int(np.argmin(whole)))
            rows = every[:count]
            values = {name: observed(rows, name) for name in precision.columns}
            # That of a crowd that has stalled goes on with those who are stuck.
            ended = rows[rows["status"] != FAILED]
            curves = list(ended["occupancy"]) if "occupancy" in ended else [None] * len(ended)
            found[str(key)] = assess(precision, count, values, curves)
        return found

    def _check_figures(self, columns: Sequence[str], schema: pa.Schema) -> None:
        for name in columns:
            if name not in schema.names:
                known = dict.fromkeys(self.table().column_names)
                raise ModelError(
                    f"precision: runs have no column {name!r}{did_you_mean(name, known)}"
                )
            kind = schema.field(name).type
            if not (pa.types.is_floating(kind) or pa.types.is_integer(kind)):
                raise ModelError(f"precision: column {name} is {kind}, expected numbers")

    def warnings(self) -> dict[str, int]:
        """What runs warn of, with the number of runs."""
        table = self.table(["warning"])
        said = table["warning"].to_pylist() if "warning" in table.column_names else ()
        return dict(Counter(each for each in said if each is not None))

    def run_names(self) -> NDArray[np.bytes_]:
        """(n,) names of the runs that are there, in alphabetical order."""
        return np.unique(np.array(self.table([])["run"].to_pylist(), dtype="S40"))

    def shards(self) -> dict[str, int]:
        """Size in bytes of each file of rows, by file name."""
        return self.folder.files(RUNS, ".parquet")

    # What follows is for the process that runs the experiment.

    def prepare(self, experiment: Experiment, session: dict[str, Any]) -> None:
        """Write the definition, with a session added to those before.

        Args:
            experiment: to be run.
            session: what it is run with; ``inputs`` must be those of the sessions before.

        Raises:
            ModelError: the store is of another experiment, or a map or model file has changed.
            ResultsError: the store cannot be written.
        """
        said = to_definition(experiment)
        sessions = []
        if self.folder.exists(DEFINITION):
            before = self.definition()
            sessions = before["sessions"]
            check_goes_on(str(self), before["experiment"], said)
            check_inputs(str(self), sessions, session)
        for name in (RUNS, WORK, *([TRAJECTORIES] if "trajectories" in experiment.keep else [])):
            self.folder.make(name)
        values = {
            "format_version": FORMAT_VERSION,
            "experiment": said,
            "sessions": [*sessions, session],
        }
        self.folder.write_bytes(DEFINITION, (json.dumps(values, indent=1) + "\n").encode())

    def compact(self) -> None:
        """Merge small files of rows into one."""
        small, size = [], 0
        for name, count in self.shards().items():
            if count < _SMALL and size < 4 * _SMALL:
                small.append(name)
                size += count
        if len(small) < 2:
            return
        tables = [read_table(self.folder, name) for name in small]
        whole = joined(table for table in tables if table is not None)
        write_table(self.folder, f"{RUNS}/merged-{uuid.uuid4().hex}.parquet", whole)
        # Only now: rows are twice in the store for a moment, but never not at all.
        for name in small:
            self.folder.remove(name)

    def is_locked(self) -> bool:
        """Whether a process runs the experiment now, as far as this file system tells."""
        return is_locked(self.folder)

    def locked(self) -> AbstractContextManager[None]:
        """Be the only process that runs the experiment; the lock ends with the process.

        Object stores and some shared file systems have no locks. Two drivers would there do runs
        twice, and count them once.

        Raises:
            ResultsError: another process runs it, or the folder cannot be written.
        """
        return locked(self.folder)


def open_store(url: str | os.PathLike[str]) -> Store:
    """Open the store of an experiment.

    Args:
        url: path or fsspec URL of the folder.

    Raises:
        ResultsError: there is no experiment.
    """
    store = Store(url)
    store.definition()
    return store
