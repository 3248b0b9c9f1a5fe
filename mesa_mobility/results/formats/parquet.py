"""Trajectories as a Parquet file."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.seal import FIELD, UNSEALED, check_seal, seal
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt

FORMAT_VERSION = 2
METADATA_KEY = b"mesa_mobility"
SCHEMA = pa.schema(
    [
        ("frame", pa.int32()),
        ("person", pa.int32()),
        ("x", pa.float64()),
        ("y", pa.float64()),
        ("heading", pa.float64()),
    ]
)


class Parquet(OutputFormat):
    """Table in Parquet, which pandas and R read: a row for each person and frame."""

    name = "parquet"
    suffixes = (".parquet",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_parquet``."""
        write_parquet(excerpt.tracks(), path)

    def read(self, path: Path) -> Tracks:
        """See ``read_columns``."""
        return Tracks(**read_columns(path))


def write_parquet(trajectories: Tracks, path: str | os.PathLike[str]) -> None:
    """Write columns frame, person, x (m), y (m), heading (rad), person_data and fields, with zstd.

    The schema's metadata hold, under `mesa_mobility`, a JSON object: format_version, frame_rate,
    last_frame, core_radius by person, inside_at_end, names in person_data and of fields, and the
    sha256 of the file (see ``mesa_mobility.results.seal``). Pages have checksums, which others can
    check. Equal trajectories give equal bytes.

    Raises:
        ResultsError: the file cannot be written.
    """
    metadata = {
        "format_version": FORMAT_VERSION,
        "frame_rate": float(trajectories.frame_rate),
        "last_frame": trajectories.frames - 1,
        "core_radius": trajectories.radii.tolist(),
        "inside_at_end": trajectories.remaining.tolist(),
        "person_data": list(trajectories.person_data),
        FIELD: UNSEALED,
    }
    columns = {name: pa.array(getattr(trajectories, name)) for name in SCHEMA.names}
    person = pa.array(trajectories.person)
    for name, values in trajectories.person_data.items():
        # Texts as indices: as many strings as there are rows would take a hundred megabytes.
        by_person = pa.array(values)
        texts = values.dtype.kind == "U"
        columns[name] = (by_person.dictionary_encode() if texts else by_person).take(person)
    fields = trajectories.fields
    if fields:
        metadata["fields"] = list(fields)
    columns |= {name: pa.array(values) for name, values in fields.items()}
    table = pa.table(columns)
    with replacing(path, ResultsError) as temporary:
        with pq.ParquetWriter(
            temporary,
            table.schema,
            compression="zstd",
            use_dictionary=["frame", "person", *trajectories.person_data],
            # Neighbouring values of a double share their high bytes: split, they compress better.
            use_byte_stream_split=["x", "y", "heading"],
            write_page_checksum=True,
            # Arrow's own copy of the schema would repeat the metadata in another encoding.
            store_schema=False,
        ) as writer:
            writer.write_table(table)
            writer.add_key_value_metadata({METADATA_KEY: json.dumps(metadata, sort_keys=True)})
        seal(temporary)


def _by_person(column: pa.ChunkedArray, person: NDArray[np.int32]) -> NDArray[Any]:
    """(m,) the value of each person, from a column by row; nothing or 0 without a row."""
    first = np.full(int(person.max(initial=-1)) + 1, -1, dtype=np.int64)
    first[person[::-1]] = np.arange(len(person))[::-1]
    there = first >= 0
    values = column.take(pa.array(first[there])).to_numpy()
    if values.dtype == object:
        values = values.astype(np.str_)
    found = np.zeros(len(first), dtype=values.dtype)
    found[there] = values
    return found


def read_columns(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read what :func:`write_parquet` wrote: the fields of ``Trajectories`` by name.

    Raises:
        ResultsError: no such file, not a Parquet file, any byte of it changed, columns or
            metadata missing.
    """
    source = Path(path)
    try:
        check_seal(source)
        table = pq.read_table(source, page_checksum_verification=True)
    except FileNotFoundError as error:
        raise ResultsError(f"{source}: no such file") from error
    except (OSError, pa.ArrowException) as error:
        reason = next(iter(str(error).splitlines()), type(error).__name__)
        raise ResultsError(f"{source}: not a readable Parquet file: {reason}") from error
    missing = [name for name in SCHEMA.names if name not in table.column_names]
    if missing:
        raise ResultsError(f"{source}: no column {missing[0]}, expected {', '.join(SCHEMA.names)}")
    metadata = (table.schema.metadata or {}).get(METADATA_KEY)
    if metadata is None:
        raise ResultsError(f"{source}: no {METADATA_KEY.decode()} metadata in its schema")
    try:
        values = json.loads(metadata)
        version = values["format_version"]
        if version != FORMAT_VERSION:
            raise ResultsError(f"{source}: format version {version}, expected {FORMAT_VERSION}")
        columns = table.select(SCHEMA.names).cast(SCHEMA)
        person = columns["person"].to_numpy()
        fields = {name: table[name].to_numpy() for name in values.get("fields", [])}
        return {
            **{name: columns[name].to_numpy() for name in SCHEMA.names},
            "person_data": {
                name: _by_person(table[name], person) for name in values.get("person_data", [])
            },
            "frame_rate": float(values["frame_rate"]),
            "core_radius": np.asarray(values["core_radius"], dtype=np.float64),
            "last_frame": int(values["last_frame"]),
            "inside_at_end": np.asarray(values["inside_at_end"], dtype=np.int64),
            "fields": fields,
        }
    except (
        KeyError,
        TypeError,
        ValueError,
        OverflowError,
        RecursionError,
        pa.ArrowException,
    ) as error:
        reason = " ".join(str(error).split())
        raise ResultsError(f"{source}: damaged trajectories: {reason}") from error
