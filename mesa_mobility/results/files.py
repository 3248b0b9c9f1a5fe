"""Folders of results, of which all files are written or none, and JSON."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.interrupts import cleaning_up, putting_in_place


@contextmanager
def all_or_none(directory: str | os.PathLike[str], files: Sequence[str]) -> Iterator[Path]:
    """Give a temporary folder for these files; on success they go to `directory`, else none does.

    The last of them goes first, if it is there from before, and is put in place last. Whatever
    ends the process meanwhile, a folder that has the last file has all of them, of one run.

    Args:
        directory: folder that the files go to, created if need be.
        files: their names; those that are not in the temporary folder at the end are left out, and
            removed where they are from before.

    Raises:
        ResultsError: the folder or a file cannot be written, or the disk is full.
    """
    folder = check_writable(directory, files)
    try:
        with tempfile.TemporaryDirectory(prefix=".writing-", dir=folder) as name:
            temporary = Path(name)
            with cleaning_up(lambda: shutil.rmtree(temporary, ignore_errors=True)):
                yield temporary
                check_writable(folder, files)
                with putting_in_place():
                    (folder / files[-1]).unlink(missing_ok=True)
                    for file in files:
                        if (temporary / file).exists():
                            os.replace(temporary / file, folder / file)
                        else:
                            (folder / file).unlink(missing_ok=True)
    except OSError as error:
        raise ResultsError(f"{folder}: cannot be written: {error.strerror or error}") from error


def check_writable(directory: str | os.PathLike[str], files: Sequence[str] = ()) -> Path:
    """Create the folder if need be and make sure that files can be made in it.

    Args:
        directory: the folder.
        files: names of files that will be written to it; a folder may have none of them.

    Raises:
        ResultsError: the path is a file, the folder cannot be created or written, or a file's name
            is taken.
    """
    folder = Path(directory)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except FileExistsError as error:
        raise ResultsError(f"{folder}: is not a folder, nothing can be written there") from error
    except OSError as error:
        raise ResultsError(f"{folder}: cannot be written: {error.strerror or error}") from error
    for file in files:
        if (folder / file).is_dir():
            raise ResultsError(f"{folder / file}: is a folder, expected a file or nothing there")
    return folder


def json_text(values: Mapping[str, Any], *, indent: int | None = None) -> str:
    """One JSON object; NumPy numbers become plain ones, numbers that are not finite null."""
    return json.dumps(_plain(values), indent=indent, allow_nan=False, ensure_ascii=False)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"{type(value).__name__} has no place in a summary")
