"""Texts and JSON of files, checked for their size."""

import json
import os
from typing import Any

from mesa_mobility.errors import FloorPlanError

LARGEST_FILE = 64_000_000
"""Bytes of a file of a floor plan."""


def read_bytes(path: "str | os.PathLike[str]", most: int = LARGEST_FILE) -> bytes:
    """The bytes of a file.

    Raises:
        FloorPlanError: the file cannot be read, or has more than ``most`` bytes.
    """
    try:
        with open(path, "rb") as file:
            data = file.read(most + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FloorPlanError(f"{path}: cannot be read ({reason})") from None
    if len(data) > most:
        raise FloorPlanError(f"{path}: more than {most / 1e6:g} MB, expected at most that")
    return data


def decoded(data: bytes, where: str, expected: str) -> str:
    """Bytes as text in UTF-8, with or without a byte order mark.

    Raises:
        FloorPlanError: they are no text.
    """
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FloorPlanError(f"{where}: is not text, expected {expected}") from None


def read_text(path: "str | os.PathLike[str]", most: int, expected: str) -> str:
    """A file's text; see ``read_bytes`` and ``decoded``."""
    return decoded(read_bytes(path, most), str(path), expected)


def parsed(text: str, where: str) -> Any:
    """The JSON of a text.

    Raises:
        FloorPlanError: it is not JSON.
    """
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise FloorPlanError(f"{where}: is not JSON (line {error.lineno}: {error.msg})") from None
    except RecursionError:
        raise FloorPlanError(f"{where}: is not a floor plan (nested too deeply)") from None
    except ValueError:  # Python refuses integers of thousands of digits
        raise FloorPlanError(f"{where}: has a number of thousands of digits") from None
