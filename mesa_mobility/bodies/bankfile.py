"""The file of a pose bank: one .npz with plain arrays and JSON metadata."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.bank_data import BankData
from mesa_mobility.errors import MapError, MobilityError
from mesa_mobility.files.archives import reading
from mesa_mobility.mobility.storing.archive import Kind, read_arrays, read_metadata, write_arrays

Bank = TypeVar("Bank")

FORMAT_VERSION = 1

SUFFIX = ".poses.npz"
"""End of the name of a bank's file: ``able_bodied.poses.npz`` belongs to ``able_bodied.npz``."""

KIND = Kind("pose bank", SUFFIX, 200_000_000)
"""The bank that ships has 6 million bytes."""

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
    """Where the pose bank of a map's file is written: beside it."""
    path = Path(map_path)
    return path.with_name(path.name.removesuffix(".npz") + SUFFIX)


def shipped_banks() -> list[Path]:
    """Files of the banks that ship with the package, in ``poses`` beside the maps."""
    return sorted((Path(str(files("mesa_mobility.maps"))) / "poses").glob("*" + SUFFIX))


def write_bank(bank: BankData, path: str | Path) -> None:
    """Write a bank to ``path``: complete or not at all, the same bytes for the same bank.

    Raises:
        MapError: the file cannot be written.
    """
    metadata = {"format_version": FORMAT_VERSION, **bank.metadata}
    arrays: dict[str, NDArray[Any]] = {
        name: np.diff(getattr(bank, name), prepend=0) if name == "poses" else getattr(bank, name)
        for name in _DTYPES
        if name != "metadata"
    }
    # Changes from frame to frame compress better; they wrap round, and so do their sums.
    arrays["rotations"] = np.diff(bank.rotations, axis=0, prepend=np.int16(0)).transpose(1, 2, 0)
    write_arrays(Path(path), _DTYPES, arrays, metadata)


def read_bank(path: str | Path, make: Callable[..., Bank]) -> Bank:
    """Read and check a bank's file.

    Args:
        path: the file.
        make: builds the bank from its fields, given by name.

    Raises:
        MapError: the file is missing or invalid; the message names it and the fault.
    """
    path = Path(path)
    arrays = read_arrays(path, (_DTYPES,), KIND)
    with reading(path, KIND.name, MapError):
        try:
            return make(**_decode(arrays))
        except MobilityError as error:
            raise MapError(f"{path}: {error}") from None
    raise AssertionError("the context lets no error by")


def _decode(arrays: dict[str, NDArray[Any]]) -> dict[str, Any]:
    fields = {name: array for name, array in arrays.items() if name != "metadata"}
    if fields["rotations"].ndim != 3:
        raise MapError(f"array 'rotations': shape {fields['rotations'].shape}, expected 3 axes")
    steps = fields["rotations"].transpose(2, 0, 1)
    fields["rotations"] = np.cumsum(steps, axis=0, dtype=np.int16)
    fields["poses"] = np.cumsum(fields["poses"], dtype=np.int32)
    metadata = read_metadata(arrays["metadata"], FORMAT_VERSION)
    return {**fields, "metadata": metadata}
