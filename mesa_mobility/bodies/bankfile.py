"""The file of a pose bank: one .npz with plain arrays and JSON metadata."""

from __future__ import annotations

import io
import json
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
    from mesa_mobility.bodies.bank import PoseBank

Bank = TypeVar("Bank")

FORMAT_VERSION = 1

LARGEST_SIZE = 200_000_000
"""Bytes of all arrays in a file, uncompressed; the bank that ships has 6 million."""

SUFFIX = ".poses.npz"
"""End of the name of a bank's file: ``able_bodied.poses.npz`` belongs to ``able_bodied.npz``."""

_DTYPES: dict[str, str] = {
    "rotations": "int16",
    "heights": "int16",
    "contacts": "uint8",
    "clips": "int64",
    "offsets": "int64",
    "frames": "int16",
    "poses": "int32",
    "strides": "uint8",
    "cluster_poses": "int32",
    "metadata": "uint8",
}


def poses_path(map_path: str | Path) -> Path:
    """Where the pose bank of a map's file stands: beside it."""
    path = Path(map_path)
    return path.with_name(path.name.removesuffix(".npz") + SUFFIX)


def shipped_banks() -> list[Path]:
    """Files of the banks that ship with the package."""
    return sorted(Path(str(files("mesa_mobility.maps"))).glob("*" + SUFFIX))


def write_bank(bank: PoseBank, path: str | Path) -> None:
    """Write a bank to ``path``: complete or not at all, the same bytes for the same bank.

    Raises:
        MapError: the file cannot be written.
    """
    metadata = {"format_version": FORMAT_VERSION, **bank.metadata}
    text = json.dumps(metadata, sort_keys=True, ensure_ascii=False).encode()
    arrays: dict[str, NDArray[Any]] = {
        name: np.diff(getattr(bank, name), prepend=0) if name == "poses" else getattr(bank, name)
        for name in _DTYPES
        if name != "metadata"
    }
    # Changes from frame to frame compress better; they wrap round, and so do their sums.
    arrays["rotations"] = np.diff(bank.rotations, axis=0, prepend=np.int16(0)).transpose(1, 2, 0)
    arrays["metadata"] = np.frombuffer(text, dtype=np.uint8)
    with replacing(path, MapError) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, dtype in _DTYPES.items():
            buffer = io.BytesIO()
            array = np.ascontiguousarray(arrays[name].astype(dtype))
            np.lib.format.write_array(buffer, array, allow_pickle=False)
            # A fixed date: the same bank gives the same bytes on any day.
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            archive.writestr(entry, buffer.getvalue(), zipfile.ZIP_DEFLATED, compresslevel=9)


def read_bank_once(path: str | Path, make: Callable[..., Bank]) -> Bank:
    """Read a bank's file; return the cached bank if the file has not changed.

    Raises:
        MapError: as ``read_bank``.
    """
    path = Path(path)
    try:
        status = path.stat()
    except OSError:
        return read_bank(path, make)  # which raises the error
    return _read_version(path.resolve(), status.st_mtime_ns, status.st_size, make)


@cached_once(maxsize=4)
def _read_version(path: Path, changed: int, size: int, make: Callable[..., Bank]) -> Bank:
    return read_bank(path, make)


def read_bank(path: str | Path, make: Callable[..., Bank]) -> Bank:
    """Read and check a bank's file.

    Args:
        path: the file.
        make: builds the bank from its fields, given by name.

    Raises:
        MapError: the file is missing or invalid; the message names it and the fault.
    """
    path = Path(path)
    try:
        with zipfile.ZipFile(path) as archive:
            arrays = _read_arrays(archive, path)
    except MapError:
        raise
    except FileNotFoundError:
        raise MapError(f"{path}: no such file, expected poses of a map ({SUFFIX})") from None
    except OSError as error:
        raise MapError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError,
            RuntimeError, MemoryError, TypeError, SyntaxError) as error:  # fmt: skip
        reason = next(iter(str(error).splitlines()), type(error).__name__)[:200]
        raise MapError(f"{path}: not a readable pose bank ({reason})") from error
    try:
        return make(**_decode(arrays))
    except MapError as error:
        raise MapError(f"{path}: {error}") from None


def _read_arrays(archive: zipfile.ZipFile, path: Path) -> dict[str, NDArray[Any]]:
    entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
    missing = sorted(set(_DTYPES) - set(entries))
    if missing:
        raise MapError(f"{path}: not a pose bank, arrays missing: {', '.join(missing)}")
    total = sum(entries[name].file_size for name in _DTYPES)
    if total > LARGEST_SIZE:
        raise MapError(
            f"{path}: arrays of {total / 1e6:.0f} MB, expected at most {LARGEST_SIZE / 1e6:.0f} MB"
        )
    arrays = {}
    for name in _DTYPES:
        content = io.BytesIO(archive.read(entries[name]))
        array = np.lib.format.read_array(content, allow_pickle=False)
        if array.dtype != np.dtype(_DTYPES[name]):
            raise MapError(f"{path}: array {name!r}: type {array.dtype}, expected {_DTYPES[name]}")
        arrays[name] = array
    return arrays


def _decode(arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    fields = {name: array for name, array in arrays.items() if name != "metadata"}
    if fields["rotations"].ndim != 3:
        raise MapError(f"array 'rotations': shape {fields['rotations'].shape}, expected 3 axes")
    steps = fields["rotations"].transpose(2, 0, 1)
    fields["rotations"] = np.cumsum(steps, axis=0, dtype=np.int16)
    fields["poses"] = np.cumsum(fields["poses"], dtype=np.int32)
    try:
        metadata = json.loads(arrays["metadata"].tobytes().decode())
    except (ValueError, RecursionError):
        raise MapError("array 'metadata': not JSON, expected an object") from None
    version = metadata.pop("format_version", None) if isinstance(metadata, dict) else None
    if version != FORMAT_VERSION or isinstance(version, bool):
        raise MapError(f"format version {version!r}, expected {FORMAT_VERSION}")
    return {**fields, "metadata": metadata}
