"""Maps that have been read before, mapped from a file beside the compiled code."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.kept_arrays import kept_arrays
from mesa_mobility.mobility.map_data import MapData
from mesa_mobility.mobility.mapfile import read_map

Map = TypeVar("Map", bound=MapData)
"""The class of the map."""

_FIELDS: dict[str, np.dtype[Any]] = {
    "offsets": np.dtype("i8"),
    "durations": np.dtype("i2"),
    "costs": np.dtype("f4"),
    "path_offsets": np.dtype("i8"),
    "paths": np.dtype("f4"),
    "path_clusters": np.dtype("u2"),
    "mean_poses": np.dtype("f4"),
    "centres": np.dtype("f4"),
    "sizes": np.dtype("i8"),
    "mean_speeds": np.dtype("f4"),
}


def read_kept_map(path: Path, make: type[Map], lender: Path, lend: Callable[[], MapData]) -> Map:
    """A map as ``read_map`` reads it, or as it was when it was read before.

    Args:
        path: the file.
        make: the class of the map.
        lender: the file of the map of which a map of families borrows what it lacks.
        lend: that map.

    Raises:
        MapError: as ``read_map``.
    """
    digests = _digests(path, lender)
    if digests is None:
        return read_map(path, make, lend)
    made: list[Map] = []

    def read() -> Mapping[str, NDArray[Any]]:
        made.append(read_map(path, make, lend))
        # A file that has been replaced meanwhile is not that of the digest.
        return _arrays(made[0]) if _digests(path, lender) == digests else {}

    arrays = kept_arrays("map", digests, {**_FIELDS, "metadata": np.dtype("u1")}, read)
    if made:
        found = made[0]
    else:
        metadata = json.loads(arrays["metadata"].tobytes())
        found = make.of_checked({**arrays, "metadata": metadata})
    if arrays:
        object.__setattr__(found, "origin", " ".join(digests))
    return found


def _digests(*paths: Path) -> list[str] | None:
    """The sha256 of each file, or None where one of them is no file that can be read."""
    found = []
    for path in paths:
        try:
            if not path.is_file():
                return None
            with open(path, "rb") as file:
                found.append(hashlib.file_digest(file, "sha256").hexdigest())
        except OSError:
            return None
    return found


def _arrays(map_: MapData) -> dict[str, NDArray[Any]]:
    """The fields of a map; without metadata if JSON does not give back the same."""
    arrays = {name: getattr(map_, name) for name in _FIELDS}
    told = json.dumps(dict(map_.metadata))
    if json.loads(told) == map_.metadata:
        arrays["metadata"] = np.frombuffer(told.encode(), np.uint8)
    return arrays
