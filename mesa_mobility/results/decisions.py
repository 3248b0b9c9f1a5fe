"""Decisions of a run: who has taken which movement option, and when."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.seal import FIELD, UNSEALED, check_seal, seal

if TYPE_CHECKING:
    from mesa_mobility.bodies import Movements

FILE = "decisions.parquet"
FORMAT_VERSION = 1
METADATA_KEY = b"mesa_mobility"
SCHEMA = pa.schema(
    [
        ("frame", pa.int32()),
        ("person", pa.int32()),
        ("type_index", pa.int32()),
        ("option", pa.int32()),
        ("share", pa.float32()),
    ]
)


@dataclass(frozen=True, eq=False)
class Decisions:
    """One row for each decision, in the order of time.

    Attributes:
        frame: (n,) int32; when the movement begins.
        person: (n,) int32; who moves, as in ``Trajectories``.
        type_index: (n,) int32; number of the person's type.
        option: (n,) int32; row of the type's mobility map, or -2 for the fallback.
        share: (n,) float32; share of the option's ground that is covered.
        maps: for each type, the digest of its mobility map.

    Raises:
        ResultsError: columns of unequal length, decisions that go back in time, types without map.
    """

    frame: NDArray[np.int32]
    person: NDArray[np.int32]
    type_index: NDArray[np.int32]
    option: NDArray[np.int32]
    share: NDArray[np.float32]
    maps: tuple[str, ...]

    def __post_init__(self) -> None:
        for name in SCHEMA.names:
            values = getattr(self, name)
            if values.shape != (len(self.frame),):
                raise ResultsError(
                    f"decisions: {name} has shape {values.shape}, expected ({len(self.frame)},)"
                )
            view = values.view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)
        if np.any(np.diff(self.frame) < 0):
            raise ResultsError("decisions: frames go back, expected the order of time")
        kinds = self.type_index
        if len(kinds) and not 0 <= kinds.min() <= kinds.max() < len(self.maps):
            raise ResultsError(
                f"decisions: types {kinds.min()} to {kinds.max()}, expected those of the "
                f"{len(self.maps)} maps"
            )

    @classmethod
    def of(cls, model: Any) -> Decisions:
        """The decisions that a model has recorded so far.

        Raises:
            ResultsError: the model does not record them.
        """
        arrays = model.decided()
        if arrays is None:
            raise ResultsError(
                'the model has recorded no decisions: create it with record="decisions"'
            )
        maps = tuple(each.mobility_map.digest for each in model.pedestrian_types)
        return cls(**arrays, maps=maps)

    def __len__(self) -> int:
        return len(self.frame)

    @cached_property
    def _by_person(self) -> NDArray[np.int64]:
        return np.argsort(self.person, kind="stable").astype(np.int64)

    @cached_property
    def _sorted_people(self) -> NDArray[np.int32]:
        return self.person[self._by_person]

    def rows_of(self, person: int) -> NDArray[np.int64]:
        """(d,) rows of the decisions of one person, in the order of time."""
        first, last = np.searchsorted(self._sorted_people, [person, person + 1])
        return self._by_person[first:last]

    def movements_of(self, person: int) -> Movements:
        """What one person does, as bodies take it."""
        from mesa_mobility.bodies import Movements

        rows = self.rows_of(person)
        return Movements(
            self.frame[rows].astype(np.int64),
            self.option[rows].astype(np.int64),
            self.share[rows].astype(np.float64),
        )

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write a Parquet file with a checksum over all of it; equal decisions give equal bytes.

        Raises:
            ResultsError: the file cannot be written.
        """
        metadata = {"format_version": FORMAT_VERSION, "maps": list(self.maps), FIELD: UNSEALED}
        table = pa.table([getattr(self, name) for name in SCHEMA.names], schema=SCHEMA)
        with replacing(path, ResultsError) as temporary:
            with pq.ParquetWriter(
                temporary, SCHEMA, compression="zstd", write_page_checksum=True, store_schema=False
            ) as writer:
                writer.write_table(table)
                text = json.dumps(metadata, sort_keys=True)
                writer.add_key_value_metadata({METADATA_KEY: text})
            seal(temporary)


def read_decisions(path: str | os.PathLike[str]) -> Decisions:
    """Read a file that ``Decisions.to_parquet`` wrote.

    Raises:
        ResultsError: no such file, not a Parquet file, any byte of it changed, or columns or
            metadata missing.
    """
    source = Path(path)
    try:
        check_seal(source)
        table = pq.read_table(source, page_checksum_verification=True)
        values = json.loads(table.schema.metadata[METADATA_KEY])
        if values["format_version"] != FORMAT_VERSION:
            raise ResultsError(
                f"{source}: format version {values['format_version']}, expected {FORMAT_VERSION}"
            )
        columns = table.select(SCHEMA.names).cast(SCHEMA)
        maps = tuple(str(each) for each in values["maps"])
        return Decisions(**{name: columns[name].to_numpy() for name in SCHEMA.names}, maps=maps)
    except FileNotFoundError as error:
        raise ResultsError(f"{source}: no such file") from error
    except ResultsError:
        raise
    except (
        OSError, KeyError, TypeError, ValueError, RecursionError, pa.ArrowException
    ) as error:  # fmt: skip
        reason = next(iter(str(error).splitlines()), type(error).__name__)
        raise ResultsError(f"{source}: not readable decisions: {reason}") from error
