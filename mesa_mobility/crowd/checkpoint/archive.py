"""The file of a checkpoint: a zip of plain arrays and one JSON text, never pickle."""

from __future__ import annotations

import io
import json
import os
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.atomic_files import replacing
from mesa_mobility.errors import ModelError

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
        _write(archive, _CONTENT, json.dumps(content, allow_nan=False, indent=1).encode())
        for name, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
            _write(archive, f"{name}.npy", buffer.getvalue())


def _write(archive: zipfile.ZipFile, name: str, data: bytes) -> None:
    # A fixed date: the same model gives the same bytes on any day.
    entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    archive.writestr(entry, data, zipfile.ZIP_DEFLATED, compresslevel=6)


def read_archive(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The JSON object and the arrays of a checkpoint.

    Raises:
        ModelError: the file is missing, damaged, or of another format or version.
    """
    path = Path(path)
    try:
        with zipfile.ZipFile(path) as archive:
            content = json.loads(archive.read(_CONTENT))
            arrays = {
                entry.removesuffix(".npy"): np.lib.format.read_array(
                    io.BytesIO(archive.read(entry)), allow_pickle=False
                )
                for entry in archive.namelist()
                if entry.endswith(".npy")
            }
    except FileNotFoundError:
        raise ModelError(f"{path}: no such file, expected a checkpoint") from None
    except OSError as error:
        raise ModelError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError,
            RuntimeError, MemoryError, TypeError, SyntaxError) as error:  # fmt: skip
        reason = next(iter(str(error).splitlines()), type(error).__name__)[:200]
        raise ModelError(f"{path}: not a readable checkpoint ({reason})") from error
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ModelError(f"{path}: not a checkpoint of a model")
    if content.get("format_version") != FORMAT_VERSION:
        raise ModelError(
            f"{path}: format version {content.get('format_version')!r}, expected {FORMAT_VERSION}"
        )
    return content, arrays
