"""The files of a store: tables of rows, written whole or not at all, on any file system."""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import fsspec
import pyarrow as pa
import pyarrow.parquet as pq
from fsspec.implementations.local import LocalFileSystem

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments.storing.rows import ENDED, FAILED, TIMED_OUT, Row
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.parquet import METADATA_KEY
from mesa_mobility.results.seal import FIELD, UNSEALED, check_open, seal_open

RUN_COLUMNS: dict[str, pa.DataType] = {
    "run": pa.string(),
    "point": pa.string(),
    "replication": pa.int64(),
    "seed": pa.int64(),
    "status": pa.string(),
    "error": pa.string(),
    "began": pa.float64(),
    "wall_s": pa.float64(),
    "cpu_s": pa.float64(),
    "worker": pa.string(),
    "inputs": pa.string(),
    "warning": pa.string(),
}
"""Columns of each row, whatever the model."""

_TYPES = pa.list_(
    pa.struct(
        [
            ("type", pa.int64()),
            ("people", pa.int64()),
            ("left", pa.int64()),
            ("mean_s", pa.float64()),
            ("longest_s", pa.float64()),
        ]
    )
)
_FIGURES: dict[str, pa.DataType] = {
    "types": _TYPES,
    "occupancy": pa.list_(pa.int64()),
    "stall_reason": pa.string(),
}
_RANK = {**dict.fromkeys(ENDED, 0), TIMED_OUT: 1, FAILED: 2}
_OLD = 600.0
"""Seconds after which a file that is being written counts as left behind."""


class Folder:
    """A folder on a local or shared file system, or at an fsspec URL.

    Args:
        url: path or URL.

    Raises:
        ResultsError: an unknown kind of URL.
    """

    def __init__(self, url: str | os.PathLike[str]) -> None:
        self.url = os.fspath(url)
        try:
            self.fs, self.root = fsspec.core.url_to_fs(self.url)
        except (ValueError, ImportError) as error:
            raise ResultsError(f"{self.url}: {' '.join(str(error).split())}") from error
        self.local = isinstance(self.fs, LocalFileSystem)

    def path(self, name: str) -> str:
        """Path of a file on the file system."""
        return f"{self.root}/{name}"

    def make(self, name: str) -> None:
        """Make a folder below this one, if it is not there."""
        try:
            with self._reached(name):
                self.fs.makedirs(self.path(name), exist_ok=True)
        except OSError as error:
            raise ResultsError(
                f"{self.url}: cannot be written: {error.strerror or error}"
            ) from error

    def exists(self, name: str) -> bool:
        """Whether there is such a file."""
        with self._reached(name):
            self.fs.invalidate_cache()
            return bool(self.fs.exists(self.path(name)))

    def write_bytes(self, name: str, content: bytes) -> None:
        """Write a file; it is complete or absent.

        Raises:
            ResultsError: the file cannot be written.
        """
        if self.local:
            path = self.path(name)
            with replacing(path, ResultsError) as temporary, temporary.open("wb") as file:
                file.write(content)
                file.flush()
                # Without power a renamed file may be empty, and what it holds gone elsewhere.
                os.fsync(file.fileno())
            return
        with self._reached(name):
            self.fs.pipe_file(self.path(name), content)  # an object is put as a whole

    def read_bytes(self, name: str) -> bytes:
        """The content of a file."""
        with self._reached(name):
            content: bytes = self.fs.cat_file(self.path(name))
            return content

    def remove(self, name: str) -> None:
        """Delete a file, if it is there and nobody reads it."""
        with suppress(OSError):
            self.fs.rm_file(self.path(name))

    def files(self, folder: str, suffix: str) -> dict[str, int]:
        """Name and bytes of the files of a folder, in alphabetical order."""
        try:
            with self._reached(folder):
                self.fs.invalidate_cache()
                found = self.fs.ls(self.path(folder), detail=True)
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise ResultsError(
                f"{self.url}/{folder}: cannot be read: {error.strerror or error}"
            ) from error
        names = {each["name"].rstrip("/").rpartition("/")[2]: each for each in found}
        return {
            f"{folder}/{name}": int(names[name]["size"] or 0)
            for name in sorted(names)
            if name.endswith(suffix) and not name.startswith(".")
        }

    @contextmanager
    def _reached(self, name: str) -> Iterator[None]:
        """Turn what a remote file system may raise, which is anything, into one line."""
        try:
            yield
        except FileNotFoundError:
            raise
        except Exception as error:
            if self.local:
                raise
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise ResultsError(f"{self.url}/{name}: cannot be reached: {reason}") from error

    def remove_half_written(self, folder: str) -> None:
        """Delete temporary files that killed processes have left behind."""
        if not self.local:
            return
        for path in Path(self.path(folder)).glob(".*.tmp*"):
            with suppress(OSError):
                if time.time() - path.stat().st_mtime > _OLD:
                    path.unlink()


def table_of(rows: Sequence[Row], column_types: dict[str, str]) -> pa.Table:
    """Rows as a table; numbers among the figures are float64.

    Args:
        rows: of runs.
        column_types: name of the Arrow type of each parameter.
    """
    types = dict(RUN_COLUMNS)
    types |= {name: pa.type_for_alias(kind) for name, kind in column_types.items()}
    figures: dict[str, pa.DataType | None] = {}
    for row in rows:
        for name, value in row.items():
            if name not in types:
                kind = _FIGURES.get(name) or _type_of(value)
                known = figures.get(name)
                figures[name] = _wider(known, kind) if known and kind else known or kind
    types |= {name: kind or pa.float64() for name, kind in figures.items()}
    columns = {
        name: pa.array([_fitting(row.get(name), kind) for row in rows], type=kind)
        for name, kind in types.items()
    }
    return pa.table(columns)


def write_table(folder: Folder, name: str, table: pa.Table) -> None:
    """Write a table as a Parquet file with its sha256 in it, whole or not at all."""
    buffer = io.BytesIO()
    with pq.ParquetWriter(buffer, table.schema, compression="zstd") as writer:
        writer.write_table(table)
        writer.add_key_value_metadata({METADATA_KEY: json.dumps({FIELD: UNSEALED})})
    seal_open(buffer, name)
    folder.write_bytes(name, buffer.getvalue())


def read_table(folder: Folder, name: str, columns: Sequence[str] | None = None) -> pa.Table | None:
    """A table of the store, or None where the file has gone, merged with others meanwhile.

    Raises:
        ResultsError: a file that cannot be read, of which any byte has changed, or which is not of
            a store.
    """
    try:
        content = io.BytesIO(folder.read_bytes(name))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ResultsError(
            f"{folder.url}/{name}: cannot be read: {error.strerror or error}"
        ) from error
    try:
        check_open(content, f"{folder.url}/{name}")
    except ResultsError as error:
        raise ResultsError(f"{error}; without this file its runs are done anew") from error
    file = pq.ParquetFile(content)
    there = None
    if columns is not None:
        there = [each for each in columns if each in file.schema_arrow.names]
    return file.read(columns=there)


def joined(tables: Iterable[pa.Table]) -> pa.Table:
    """Tables below one another, each run once: one that is done rather than one that failed."""
    present = [table for table in tables if table.num_rows]
    if not present:
        return table_of([], {})
    types: dict[str, pa.DataType | None] = {}
    for table in present:
        for column in table.schema:
            empty = table[column.name].null_count == table.num_rows
            known = types.get(column.name)
            kind = None if empty and column.name not in RUN_COLUMNS else column.type
            types[column.name] = _wider(known, kind) if known and kind else known or kind
    fallback = {c.name: c.type for table in present for c in table.schema}
    kinds = {name: kind or fallback[name] for name, kind in types.items()}
    whole = pa.concat_tables([_cast(table, kinds) for table in present])
    rank = [_RANK.get(status, 3) for status in whole["status"].to_pylist()]
    best: dict[str, int] = {}
    for number, run in enumerate(whole["run"].to_pylist()):
        known_row = best.get(run)
        if known_row is None or rank[number] < rank[known_row]:
            best[run] = number
    if len(best) == whole.num_rows:
        return whole
    return whole.take(sorted(best.values()))


def _cast(table: pa.Table, types: dict[str, pa.DataType]) -> pa.Table:
    columns = {}
    for name, kind in types.items():
        if name not in table.column_names:
            columns[name] = pa.nulls(table.num_rows, kind)
        elif table[name].type == kind:
            columns[name] = table[name]
        elif table[name].null_count == table.num_rows:
            columns[name] = pa.nulls(table.num_rows, kind)
        elif pa.types.is_string(kind):
            # As in a table of both from the start; Arrow writes numbers in its own way.
            columns[name] = pa.array([_fitting(v, kind) for v in table[name].to_pylist()], kind)
        else:
            columns[name] = table[name].cast(kind)
    return pa.table(columns)


def _type_of(value: Any) -> pa.DataType | None:
    if value is None:
        return None
    if isinstance(value, bool):
        return pa.bool_()
    return pa.string() if isinstance(value, str) else pa.float64()


def _wider(one: pa.DataType, other: pa.DataType) -> pa.DataType:
    """A type that holds the values of both."""
    if one == other:
        return one
    numbers = {pa.int64(), pa.float64()}
    return pa.float64() if {one, other} <= numbers else pa.string()


def _fitting(value: Any, kind: pa.DataType) -> Any:
    """A value as Arrow takes it for a type."""
    if value is None or pa.types.is_nested(kind):
        return value
    if pa.types.is_string(kind):
        return str(value)
    return float(value) if pa.types.is_floating(kind) else value
