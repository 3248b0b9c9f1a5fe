"""The file of a checkpoint: a zip of plain arrays and one JSON text, never pickle."""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.files.archives import add_array, add_bytes, members_of, read_array, reading
from mesa_mobility.files.atomic import replacing

FORMAT = "mesa-mobility checkpoint"

FORMAT_VERSION = 1

_CONTENT = "checkpoint.json"


def _most(packed: int) -> int:
    """Most bytes of all members of a file of so many bytes.

    A hundred times as many are more than numbers of a run ever pack to; a file made to fill the
    memory packs to a thousandth.
    """
    return 64_000_000 + 100 * packed


def _most_text(packed: int) -> int:
    """Most bytes of the text, of which each takes up to ten in memory, likewise."""
    return 8_000_000 + 20 * packed


def write_archive(
    path: str | os.PathLike[str], content: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
) -> None:
    """Write a checkpoint, complete or not at all.

    Raises:
        ModelError: the file cannot be written.
    """
    content = {"format": FORMAT, "format_version": FORMAT_VERSION, **content}
    text = json.dumps(content, allow_nan=False, indent=1).encode()
    with replacing(path, ModelError) as temporary:
        for level in (6, 0):
            with zipfile.ZipFile(temporary, "w") as archive:
                add_bytes(archive, _CONTENT, text, level=level)
                for name, array in arrays.items():
                    add_array(archive, name, array, level=level)
                total = sum(entry.file_size for entry in archive.infolist())
                packed = archive.getinfo(_CONTENT).compress_size
            size = temporary.stat().st_size
            if total <= _most(size) and len(text) <= _most_text(packed):
                break  # otherwise nobody could read it: packed less, it can be read


def read_archive(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The JSON object and the arrays of a checkpoint.

    Raises:
        ModelError: the file is missing, damaged, or of another format or version.
    """
    path = Path(path)
    with reading(path, "checkpoint", ModelError), zipfile.ZipFile(path) as archive:
        members = members_of(archive, _most(path.stat().st_size), str(path), ModelError)
        text = members.pop(_CONTENT)
        if text.file_size > _most_text(text.compress_size):
            raise ModelError(
                f"{path}: {_CONTENT} of {text.file_size / 1e6:.0f} MB, expected at most "
                f"{_most_text(text.compress_size) / 1e6:.0f} MB"
            )
        content = json.loads(archive.read(text))
        arrays = {
            name: read_array(archive, entry, f"{path}: array {name!r:.60}", ModelError)
            for name, entry in members.items()
        }
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ModelError(f"{path}: not a checkpoint of a model")
    if content.get("format_version") != FORMAT_VERSION:
        raise ModelError(
            f"{path}: format version {content.get('format_version')!r}, expected {FORMAT_VERSION}"
        )
    return content, arrays
