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
from mesa_mobility.results.seal import FIELD, UNSEALED, check_seal, seal
from mesa_mobility.schema import Array, Each, Real, Several, Text, check

if TYPE_CHECKING:
    from mesa_mobility.bodies import Movements, PoseBank

FILE = "decisions.parquet"
FORMAT_VERSION = 1
METADATA_KEY = b"mesa_mobility"

COLUMNS: dict[str, Array] = {
    "frame": Array("i4", ("rows",), 0),
    "person": Array("i4", ("rows",), 0),
    "type_index": Array("i4", ("rows",), 0, below="types"),
    "option": Array("i4", ("rows",), -2),
    "share": Array("f4", ("rows",), 0.0, 1.0),
}
"""The columns, and what each of them is."""

STAIRS = Several(Several(Each(Text(), Real(0.01, 100.0), of=list)))
"""Records of maps for stairs, in the metadata of a file."""

SCHEMA = pa.schema([(name, pa.from_numpy_dtype(kind.dtype)) for name, kind in COLUMNS.items()])


@dataclass(frozen=True, eq=False)
class Decisions:
    """One row for each decision, in the order of time.

    Attributes:
        frame: (n,) int32; when the movement begins.
        person: (n,) int32; who moves, as in ``Trajectories``.
        type_index: (n,) int32; number of the person's type.
        option: (n,) int32; row of the type's mobility map, or of its maps for stairs, which follow
            one after the other; -2 for the fallback.
        share: (n,) float32; share of the option's ground that is covered.
        maps: for each type, the digest of its mobility map.
        stairs: for each type, the digests of its maps for stairs, each with the factor of its
            lengths; empty without stairs.

    Raises:
        ResultsError: columns of unequal length, decisions that go back in time, types without map.
    """

    frame: NDArray[np.int32]
    person: NDArray[np.int32]
    type_index: NDArray[np.int32]
    option: NDArray[np.int32]
    share: NDArray[np.float32]
    maps: tuple[str, ...]
    stairs: tuple[tuple[tuple[str, float], ...], ...] = ()

    def __post_init__(self) -> None:
        sizes = {"types": len(self.maps), "rows": len(self.frame)}
        for name, kind in COLUMNS.items():
            values = getattr(self, name)
            check(values, kind, f"decisions: {name}", sizes, error=ResultsError)
            view = values.view()
            view.setflags(write=False)
            object.__setattr__(self, name, view)
        if self.stairs and len(self.stairs) != len(self.maps):
            raise ResultsError(
                f"decisions: maps for stairs of {len(self.stairs)} types, expected those of "
                f"{len(self.maps)}"
            )
        if np.any(np.diff(self.frame) < 0):
            raise ResultsError("decisions: frames go back, expected the order of time")

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
        used = [[(each.digest, each.lengths) for each in maps] for maps in model.mobility_maps]
        stairs = tuple(tuple(others) for _, *others in used)
        maps = tuple(digest for (digest, _), *_ in used)
        return cls(**arrays, maps=maps, stairs=stairs if any(stairs) else ())

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
        """The decisions of one person in order of time, as ``mesa_mobility.bodies`` needs them.

        They are empty for unknown people.
        """
        from mesa_mobility.bodies import Movements

        rows = self.rows_of(person)
        return Movements(
            self.frame[rows].astype(np.int64),
            self.option[rows].astype(np.int64),
            self.share[rows].astype(np.float64),
        )

    def bank_of(self, kind: int, given: PoseBank | None = None) -> PoseBank:
        """The poses behind the options of a type.

        Args:
            kind: number of the type.
            given: poses of its own map; by default those that ship.

        Raises:
            MapError: no poses of one of its maps ship, or those given are of another map.
        """
        from mesa_mobility.bodies import bank_of_maps

        stairs = self.stairs[kind] if self.stairs else ()
        return bank_of_maps([(self.maps[kind], 1.0), *stairs], given)

    def to_parquet(self, path: str | os.PathLike[str]) -> None:
        """Write a Parquet file with a checksum over all of it; equal decisions give equal bytes.

        Raises:
            ResultsError: the file cannot be written.
        """
        metadata = {
            "format_version": FORMAT_VERSION,
            "maps": self.maps,
            "stairs": self.stairs,
            FIELD: UNSEALED,
        }
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
        _check_footer(source)
        table = pq.read_table(source, columns=SCHEMA.names, page_checksum_verification=True)
        values = json.loads(table.schema.metadata[METADATA_KEY])
        if values["format_version"] != FORMAT_VERSION:
            raise ResultsError(
                f"{source}: format version {values['format_version']}, expected {FORMAT_VERSION}"
            )
        columns = table.select(SCHEMA.names).cast(SCHEMA)
        maps, stairs = values["maps"], values.get("stairs", [])
        check(maps, Several(Text()), "metadata, maps", error=ResultsError)
        check(stairs, STAIRS, "metadata, stairs", error=ResultsError)
        return Decisions(
            **{name: columns[name].to_numpy() for name in SCHEMA.names},
            maps=tuple(maps),
            stairs=tuple(tuple((digest, by) for digest, by in each) for each in stairs),
        )
    except FileNotFoundError as error:
        raise ResultsError(f"{source}: no such file") from error
    except ResultsError as error:
        said = str(error)
        named = said if said.startswith(f"{source}: ") else f"{source}: {said}"
        raise ResultsError(named) from None
    except (
        AttributeError,
        OverflowError,
        MemoryError,
        OSError,
        KeyError,
        TypeError,
        ValueError,
        RecursionError,
        pa.ArrowException,
    ) as error:
        reason = next(iter(str(error).splitlines()), type(error).__name__)
        raise ResultsError(f"{source}: not readable decisions: {reason}") from error


def _check_footer(path: Path) -> None:
    """Raise ResultsError where a file has other columns, or would unpack to far more than decisions
    do."""
    packed = path.stat().st_size
    most = 64_000_000 + 100 * packed
    about = pq.read_metadata(path)
    if about.schema.names != SCHEMA.names:
        names = ", ".join(about.schema.names)
        raise ResultsError(f"{path}: columns {names:.80}, expected {', '.join(SCHEMA.names)}")
    groups = [about.row_group(k) for k in range(about.num_row_groups)]
    # Encodings, too, may make much of little: rows count as well as bytes.
    total = max(about.num_rows * 20, sum(group.total_byte_size for group in groups))
    if total > most:
        raise ResultsError(
            f"{path}: {total / 1e6:.0f} MB of decisions, expected at most {most / 1e6:.0f} MB"
        )
