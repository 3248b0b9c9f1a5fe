"""Archives (.npz) of plain arrays and JSON metadata: the same bytes for the same arrays."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import MapError
from mesa_mobility.files.archives import add_array, members_of, read_array, reading
from mesa_mobility.files.atomic import replacing

Layout = Mapping[str, str]
"""Names and types of the arrays of a file."""


class Kind(NamedTuple):
    """What files of one kind are.

    Attributes:
        name: as messages say it.
        suffix: end of a file's name.
        largest: bytes of all arrays in a file, uncompressed.
    """

    name: str
    suffix: str
    largest: int


MAP = Kind("mobility map", ".npz", 100_000_000)
"""The able-bodied map has 25 million bytes."""


def write_arrays(
    path: Path, layout: Layout, arrays: Mapping[str, NDArray[Any]], metadata: Mapping[str, Any]
) -> None:
    """Write an archive: complete or not at all.

    Raises:
        MapError: the file cannot be written.
    """
    text = json.dumps(metadata, sort_keys=True, ensure_ascii=False).encode()
    every = {**arrays, "metadata": np.frombuffer(text, dtype=np.uint8)}
    with replacing(path, MapError) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, dtype in layout.items():
            add_array(archive, name, every[name].astype(dtype), level=9)


def read_arrays(path: Path, layouts: Sequence[Layout], kind: Kind = MAP) -> dict[str, NDArray[Any]]:
    """The arrays of an archive of one of these layouts, their types checked.

    Raises:
        MapError: the file is missing or invalid; the message names it and the fault.
    """
    with reading(path, kind.name, MapError, kind.suffix), path.open("rb") as file:
        if file.read(len(np.lib.format.MAGIC_PREFIX)) == np.lib.format.MAGIC_PREFIX:
            raise MapError(f"{path}: a single array, expected a {kind.name} ({kind.suffix})")
        with zipfile.ZipFile(file) as archive:
            return _read_layout(archive, path, layouts, kind)


def read_metadata(raw: NDArray[np.uint8], version: int) -> dict[str, Any]:
    """The metadata of an archive, without the format version, which is checked.

    Raises:
        MapError: they are not JSON, or of another version.
    """
    try:
        metadata = json.loads(raw.tobytes().decode())
    except (ValueError, RecursionError):
        raise MapError("array 'metadata': not JSON, expected an object") from None
    found = metadata.pop("format_version", None) if isinstance(metadata, dict) else None
    if found != version or isinstance(found, bool):
        raise MapError(f"format version {found!r}, expected {version}")
    return metadata


def _read_layout(
    archive: zipfile.ZipFile, path: Path, layouts: Sequence[Layout], kind: Kind
) -> dict[str, NDArray[Any]]:
    entries = members_of(archive, kind.largest, str(path), MapError)
    layout = next((each for each in layouts if set(each) <= set(entries)), layouts[0])
    missing = sorted(set(layout) - set(entries))
    if missing:
        raise MapError(f"{path}: not a {kind.name}, arrays missing: {', '.join(missing)}")
    unknown = sorted(set(entries) - set(layout))
    if unknown:
        raise MapError(
            f"{path}: unknown arrays {', '.join(unknown):.80}, expected {', '.join(layout)}"
        )
    arrays = {
        name: read_array(archive, entries[name], f"{path}: array {name!r}", MapError)
        for name in layout
    }
    for name, dtype in layout.items():
        if arrays[name].dtype != np.dtype(dtype):
            raise MapError(f"{path}: array {name!r}: type {arrays[name].dtype}, expected {dtype}")
    return arrays
