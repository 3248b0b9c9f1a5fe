"""A cache of what has been read from files: maps and pose banks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from mesa_mobility._once import cached_once

Content = TypeVar("Content")
"""What is made of a file."""


def read_once(path: str | Path, read: Callable[[Path], Content]) -> Content:
    """What `read` makes of a file, or what it made before if the file has not changed since.

    Args:
        path: the file.
        read: reads the file; a function or a class method, by which the content is kept.

    Raises:
        MobilityError: as `read`.
    """
    path = Path(path)
    try:
        status = path.stat()
    except OSError:
        return read(path)  # which raises the error
    found: Content = _read_version(path.resolve(), status.st_mtime_ns, status.st_size, read)
    return found


@cached_once(maxsize=20)
def _read_version(path: Path, changed: int, size: int, read: Callable[[Path], Any]) -> Any:
    return read(path)
