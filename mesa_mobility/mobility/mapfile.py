"""The map file: one .npz with plain arrays and JSON metadata, the same bytes for the same map.

Paths are kept as whole steps of half a millimetre and 0.2 milliradians, each
sample as its difference from the one before, so that a file of some 200,000
options stays near ten megabytes.  End points and end headings stand beside
the paths: a reader replays each path and compares.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import MapError, MobilityError
from mesa_mobility.files.archives import reading
from mesa_mobility.mobility.map_data import MapData
from mesa_mobility.mobility.storing.archive import read_arrays, read_metadata, write_arrays
from mesa_mobility.mobility.storing.layouts import FAMILIES, OPTIONS
from mesa_mobility.mobility.storing.steps import COST_STEP, PATH_STEPS

Map = TypeVar("Map")
"""The object made from the arrays of a file."""

FORMAT_VERSION = 1

_INT16 = np.iinfo(np.int16).max
_PIECE = 1 << 16
_PLAIN = ("offsets", "durations", "path_clusters", "mean_poses", "centres", "sizes", "mean_speeds")


def shipped_maps() -> Path:
    """Folder of the maps that ship with the package."""
    return Path(str(files("mesa_mobility.maps")))


def shipped_map_path(name: str) -> Path:
    """Path of a map that ships with the package.

    Raises:
        MapError: there is no such map.
    """
    folder = shipped_maps()
    path = folder / f"{name}.npz"
    if not path.is_file():
        known = sorted(p.stem for p in folder.glob("*.npz"))
        raise MapError(
            f"no map named {name!r} ships with the package, expected one of {', '.join(known)}"
        )
    return path


def write_map(map_: MapData, path: str | Path) -> None:
    """Write a map to ``path``: complete or not at all.

    Raises:
        MapError: the file cannot be written, or a path is too long to be stored.
    """
    path = Path(path)
    whole = np.rint(map_.paths.astype(np.float64) / PATH_STEPS)
    starts = map_.path_offsets[:-1]
    steps = np.diff(whole, axis=0, prepend=0.0)
    steps[starts] = whole[starts]
    ends = whole[map_.path_offsets[1:] - 1]
    far = (np.maximum(np.abs(steps).max(axis=0), np.abs(ends).max(axis=0)) > _INT16).tolist()
    if any(far):
        what = "leads further than 16 m" if far[0] or far[1] else "turns by more than 6.5 rad"
        raise MapError(f"{path}: an option {what}, expected a person's movement")
    metadata = {"format_version": FORMAT_VERSION, **map_.metadata}
    arrays: dict[str, NDArray[Any]] = {name: getattr(map_, name) for name in _PLAIN}
    arrays["costs"] = np.rint(map_.costs.astype(np.float64) / COST_STEP)
    arrays["end_points"] = ends[:, :2]
    arrays["end_headings"] = ends[:, 2]
    arrays["end_clusters"] = map_.end_clusters
    arrays["path_steps"] = steps.T  # x, y and heading apart compress better
    write_arrays(path, OPTIONS, arrays, metadata)


def read_map(path: str | Path, make: Callable[..., Map], lender: Callable[[], MapData]) -> Map:
    """Read and check a map file, of all options or of families of options.

    Args:
        path: the file.
        make: builds the map from its fields, given by name.
        lender: the map of which a map of families borrows what it lacks.

    Raises:
        MapError: the file is missing or invalid; the message names it and the fault.
    """
    path = Path(path)
    arrays = read_arrays(path, (OPTIONS, FAMILIES))
    with reading(path, "mobility map", MapError):
        try:
            if "sources" not in arrays:
                return make(**_decode(arrays))
            from mesa_mobility.mobility.storing.families import read_families

            return make(**read_families(arrays).fields(lender))
        except MobilityError as error:
            raise MapError(f"{path}: {error}") from None
    raise AssertionError("the context lets no error by")


def _decode(arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """The fields of a map."""
    metadata = read_metadata(arrays["metadata"], FORMAT_VERSION)
    durations, steps = arrays["durations"], arrays["path_steps"]
    m = len(durations) if durations.ndim == 1 else -1
    samples = durations.astype(np.int64) // 3
    shapes = {
        "durations": (m,),
        "path_steps": (3, int(samples.sum()) if m >= 0 else -1),
        "end_points": (m, 2),
        "end_headings": (m,),
        "end_clusters": (m,),
    }
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            raise MapError(f"array {name!r}: shape {arrays[name].shape}, expected {shape}")
    if m < 1 or (samples < 1).any():
        raise MapError("array 'durations': expected at least one option, each of 3 frames or more")
    path_offsets = np.concatenate([[0], np.cumsum(samples)])
    whole = np.empty((len(steps[0]), 3), dtype=np.int32)
    for axis, each in enumerate(steps):
        # The running sum may wrap round, but differences of it are still correct.
        running = np.cumsum(each, dtype=np.int32)
        before = np.concatenate([[0], running[path_offsets[1:-1] - 1]]).astype(np.int32)
        np.subtract(running, np.repeat(before, samples), out=whole[:, axis])
    ends = np.column_stack([arrays["end_points"], arrays["end_headings"]])
    last = path_offsets[1:] - 1
    wrong = (whole[last] != ends).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise MapError(f"option {row}: its path ends elsewhere than its end point says")
    if arrays["path_clusters"].shape == (len(whole),):
        wrong = arrays["path_clusters"][last] != arrays["end_clusters"]
        if wrong.any():
            raise MapError(f"option {int(np.argmax(wrong))}: its path ends in another cluster")
    return {
        "costs": (arrays["costs"] * COST_STEP).astype(np.float32),
        "path_offsets": path_offsets,
        "paths": _metres(whole),
        "metadata": metadata,
        **{name: arrays[name] for name in _PLAIN},
    }


def _metres(whole: NDArray[np.int32]) -> NDArray[np.float32]:
    """(p, 3) samples of whole steps in metres and radians."""
    paths = np.empty(whole.shape, dtype=np.float32)
    # In pieces: double precision of all at once would take twice the memory of the map.
    for start in range(0, len(whole), _PIECE):
        piece = slice(start, start + _PIECE)
        paths[piece] = np.multiply(whole[piece], PATH_STEPS, dtype=np.float64)
    return paths
