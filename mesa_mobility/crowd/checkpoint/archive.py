"""The file of a checkpoint: a zip of plain arrays and one JSON text, never pickle."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.files.archives import add_array, add_bytes, reading
from mesa_mobility.files.atomic import replacing

FORMAT = "mesa-mobility checkpoint"

FORMAT_VERSION = 1

_CONTENT = "checkpoint.json"


def write_archive(
    path: str | os.PathLike[str], content: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
) -> None:
    """Write a checkpoint, complete or not at all.

    Raises:
        ModelError: the file cannot be written.
    """
    content = {"format": FORMAT, "format_version": FORMAT_VERSION, **content}
    with replacing(path, ModelError) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        text = json.dumps(content, allow_nan=False, indent=1).encode()
        add_bytes(archive, _CONTENT, text, level=6)
        for name, array in arrays.items():
            add_array(archive, name, array, level=6)


def read_archive(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The JSON object and the arrays of a checkpoint.

    Raises:
        ModelError: the file is missing, damaged, or of another format or version.
    """
    path = Path(path)
    with reading(path, "checkpoint", ModelError), zipfile.ZipFile(path) as archive:
        content = json.loads(archive.read(_CONTENT))
        arrays = {
            entry.removesuffix(".npy"): np.lib.format.read_array(
                io.BytesIO(archive.read(entry)), allow_pickle=False
            )
            for entry in archive.namelist()
            if entry.endswith(".npy")
        }
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ModelError(f"{path}: not a checkpoint of a model")
    if content.get("format_version") != FORMAT_VERSION:
        raise ModelError(
            f"{path}: format version {content.get('format_version')!r}, expected {FORMAT_VERSION}"
        )
    return content, arrays
