"""Zip archives of arrays: the same bytes for the same content, and errors of one line."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import MobilityError


def add_array(archive: zipfile.ZipFile, name: str, array: NDArray[Any], level: int) -> None:
    """Add an array to an archive, as ``name.npy``; see ``add_bytes``."""
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
    add_bytes(archive, f"{name}.npy", buffer.getvalue(), level)


def add_bytes(archive: zipfile.ZipFile, name: str, data: bytes, level: int) -> None:
    """Add a member to an archive, deflated with this level, 1 (fast) to 9 (small)."""
    # A fixed date: the same content gives the same bytes on any day.
    entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    archive.writestr(entry, data, zipfile.ZIP_DEFLATED, compresslevel=level)


@contextmanager
def reading(path: Path, kind: str, error: type[MobilityError], suffix: str = "") -> Iterator[None]:
    """Raise one error of one line for whatever a file that is read may be.

    Args:
        path: the file.
        kind: what it is to be.
        error: raised where the file is missing, cannot be read, or is something else.
        suffix: end of the names of such files, for the message.
    """
    try:
        yield
    except MobilityError:
        raise
    except FileNotFoundError:
        expected = f"{kind} ({suffix})" if suffix else kind
        raise error(f"{path}: no such file, expected a {expected}") from None
    except OSError as cause:
        raise error(f"{path}: cannot be read ({cause.strerror or cause})") from cause
    except (ValueError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError,
            RuntimeError, MemoryError, TypeError, SyntaxError) as cause:  # fmt: skip
        reason = next(iter(str(cause).splitlines()), type(cause).__name__)[:200]
        raise error(f"{path}: not a readable {kind} ({reason})") from cause
