"""The map file: one .npz with plain arrays and JSON metadata, the same bytes for the same map.

Paths are kept as whole steps of half a millimetre and 0.2 milliradians, each
sample as its difference from the one before, so that a file of some 200,000
options stays near ten megabytes.  End points and end headings stand beside
the paths: a reader replays each path and compares.
"""

from __future__ import annotations

import io
import json
import math
import zipfile
import zlib
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._once import cached_once
from mesa_mobility.atomic_files import replacing
from mesa_mobility.errors import MapError

if TYPE_CHECKING:
    from mesa_mobility.mobility.map import MobilityMap

Map = TypeVar("Map")
"""The object made from the arrays of a file."""

POSITION_STEP = 0.0005
"""Paths are stored in steps of half a millimetre ..."""

HEADING_STEP = 0.0002
"""... and of 0.2 milliradians, an eightieth of a degree."""

FORMAT_VERSION = 1

COST_STEP = 1e-4

LARGEST_SIZE = 100_000_000
"""Bytes of all arrays in a file, uncompressed; the map that ships has 25 million."""

_INT16 = np.iinfo(np.int16).max
_STEPS = np.array([POSITION_STEP, POSITION_STEP, HEADING_STEP])
_PLAIN = ("offsets", "durations", "path_clusters", "mean_poses", "centres", "sizes", "mean_speeds")
_DTYPES: dict[str, str] = {
    "offsets": "int64",
    "durations": "int16",
    "costs": "uint16",
    "end_points": "int16",
    "end_headings": "int16",
    "end_clusters": "uint16",
    "path_steps": "int16",
    "path_clusters": "uint16",
    "mean_poses": "float32",
    "centres": "float32",
    "sizes": "int64",
    "mean_speeds": "float32",
    "metadata": "uint8",
}


def shipped_map_path(name: str) -> Path:
    """Path of a map that ships with the package.

    Raises:
        MapError: there is no such map.
    """
    folder = Path(str(files("mesa_mobility.maps")))
    path = folder / f"{name}.npz"
    if not path.is_file():
        known = sorted(p.stem for p in folder.glob("*.npz") if "." not in p.stem)
        raise MapError(f"no map named {name!r} ships with the package, expected one of {known}")
    return path


def quantise_paths(paths: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round (p, 3) samples to the steps of the file, so that a saved map reads back unchanged."""
    return (np.rint(np.asarray(paths, dtype=np.float64) / _STEPS) * _STEPS).astype(np.float32)


def quantise_costs(costs: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round costs to the step of the file."""
    return (np.rint(np.asarray(costs, dtype=np.float64) / COST_STEP) * COST_STEP).astype(np.float32)


def write_map(map_: MobilityMap, path: str | Path) -> None:
    """Write a map to ``path``: complete or not at all.

    Raises:
        MapError: the file cannot be written, or a path is too long to be stored.
    """
    path = Path(path)
    whole = np.rint(map_.paths.astype(np.float64) / _STEPS)
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
    text = json.dumps(metadata, sort_keys=True, ensure_ascii=False).encode()
    arrays["metadata"] = np.frombuffer(text, dtype=np.uint8)

    with replacing(path, MapError) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, dtype in _DTYPES.items():
            _write_array(archive, name, arrays[name].astype(dtype))


def _write_array(archive: zipfile.ZipFile, name: str, array: NDArray[Any]) -> None:
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
    # A fixed date: the same map gives the same bytes on any day.
    entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
    archive.writestr(entry, buffer.getvalue(), zipfile.ZIP_DEFLATED, compresslevel=9)


def read_map_once(path: str | Path, make: Callable[..., Map]) -> Map:
    """Read a map file; return the cached map if the file has not changed.

    Args:
        path: the file.
        make: builds the map from its fields, given by name.

    Raises:
        MapError: as ``read_map``.
    """
    path = Path(path)
    try:
        status = path.stat()
    except OSError:
        return read_map(path, make)  # which raises the error
    return _read_version(path.resolve(), status.st_mtime_ns, status.st_size, make)


@cached_once(maxsize=4)
def _read_version(path: Path, changed: int, size: int, make: Callable[..., Map]) -> Map:
    return read_map(path, make)


def read_map(path: str | Path, make: Callable[..., Map]) -> Map:
    """Read and check a map file.

    Args:
        path: the file.
        make: builds the map from its fields, given by name.

    Raises:
        MapError: the file is missing or invalid; the message names it and the fault.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            if file.read(len(np.lib.format.MAGIC_PREFIX)) == np.lib.format.MAGIC_PREFIX:
                raise MapError(f"{path}: a single array, expected a mobility map (.npz)")
            with zipfile.ZipFile(file) as archive:
                arrays = _read_arrays(archive, path)
    except MapError:
        raise
    except FileNotFoundError:
        raise MapError(f"{path}: no such file, expected a mobility map (.npz)") from None
    except OSError as error:
        raise MapError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError,
            RuntimeError, MemoryError, TypeError, SyntaxError) as error:  # fmt: skip
        reason = next(iter(str(error).splitlines()), type(error).__name__)[:200]
        raise MapError(f"{path}: not a readable mobility map ({reason})") from error
    try:
        return make(**_decode(arrays))
    except MapError as error:
        raise MapError(f"{path}: {error}") from None


def _read_arrays(archive: zipfile.ZipFile, path: Path) -> dict[str, NDArray[Any]]:
    entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
    missing = sorted(set(_DTYPES) - set(entries))
    if missing:
        raise MapError(f"{path}: not a mobility map, arrays missing: {', '.join(missing)}")
    total = sum(entries[name].file_size for name in _DTYPES)
    if total > LARGEST_SIZE:
        raise MapError(
            f"{path}: arrays of {total / 1e6:.0f} MB, expected at most {LARGEST_SIZE / 1e6:.0f} MB"
        )
    arrays = {}
    for name in _DTYPES:
        entry = entries[name]
        what = f"{path}: array {name!r}"
        # Other compression methods cannot be unpacked in bounded steps.
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise MapError(f"{what}: compressed by method {entry.compress_type}, expected deflate")
        with archive.open(entry) as stream:
            # Reading one byte more reaches the end of the member, which triggers its checksum test.
            arrays[name] = _read_array(io.BytesIO(stream.read(entry.file_size + 1)), what)
    return arrays


def _read_array(file: io.BytesIO, what: str) -> NDArray[Any]:
    version = np.lib.format.read_magic(file)
    if version != (1, 0):
        raise MapError(f"{what}: npy format {version}, expected (1, 0)")
    shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(file)
    content = file.read()
    # Check the header's size before allocating memory for it.
    if dtype.hasobject or fortran_order or math.prod(shape) * dtype.itemsize != len(content):
        raise MapError(
            f"{what}: its header says {dtype} in shape {shape}, but {len(content)} bytes follow"
        )
    return np.frombuffer(content, dtype=dtype).reshape(shape)


def _decode(arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """The fields of a map."""
    for name, dtype in _DTYPES.items():
        if arrays[name].dtype != np.dtype(dtype):
            raise MapError(f"array {name!r}: type {arrays[name].dtype}, expected {dtype}")
    metadata = _decode_metadata(arrays["metadata"])
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
        "paths": np.multiply(whole, _STEPS, dtype=np.float64).astype(np.float32),
        "metadata": metadata,
        **{name: arrays[name] for name in _PLAIN},
    }


def _decode_metadata(raw: NDArray[np.uint8]) -> dict[str, Any]:
    try:
        metadata = json.loads(raw.tobytes().decode())
    except (ValueError, RecursionError):
        raise MapError("array 'metadata': not JSON, expected an object") from None
    version = metadata.pop("format_version", None) if isinstance(metadata, dict) else None
    if version != FORMAT_VERSION or isinstance(version, bool):
        raise MapError(f"format version {version!r}, expected {FORMAT_VERSION}")
    return metadata
