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

DTYPES: dict[str, np.dtype[Any]] = {
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
    "metadata": np.dtype("u1"),
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
    origin = " ".join(digests)

    def read() -> tuple[Map, Mapping[str, NDArray[Any]]]:
        found = read_map(path, make, lend)
        # A file that has been replaced meanwhile is not that of the digest.
        if _digests(path, lender) != digests:
            return found, {}
        object.__setattr__(found, "origin", origin)
        return found, _arrays(found)

    def take(arrays: Mapping[str, NDArray[Any]]) -> Map:
        metadata = json.loads(arrays["metadata"].tobytes())
        found = make(**{**arrays, "metadata": metadata})
        object.__setattr__(found, "origin", origin)
        return found

    return kept_arrays("map", digests, DTYPES, read, take)


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
    arrays = {name: getattr(map_, name) for name in DTYPES if name != "metadata"}
    told = json.dumps(dict(map_.metadata))
    if json.loads(told) == map_.metadata:
        arrays["metadata"] = np.frombuffer(told.encode(), np.uint8)
    return arrays
