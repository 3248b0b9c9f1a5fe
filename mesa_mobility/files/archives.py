"""Zip archives of arrays: the same bytes for the same content, and errors of one line."""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import MobilityError

_CHUNK = 1 << 20


def add_array(archive: zipfile.ZipFile, name: str, array: NDArray[Any], level: int) -> None:
    """Add an array to an archive, as ``name.npy``; see ``add_bytes``."""
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.asarray(array, order="C"), allow_pickle=False)
    add_bytes(archive, f"{name}.npy", buffer.getvalue(), level)


def add_bytes(archive: zipfile.ZipFile, name: str, data: bytes, level: int) -> None:
    """Add a member to an archive, deflated with this level, 1 (fast) to 9 (small)."""
    # A fixed date: the same content gives the same bytes on any day.
    entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    archive.writestr(entry, data, zipfile.ZIP_DEFLATED, compresslevel=level)


def members_of(
    archive: zipfile.ZipFile, most: int, what: str, error: type[MobilityError]
) -> dict[str, zipfile.ZipInfo]:
    """The members of an archive by name, without ``.npy``.

    Args:
        archive: open for reading.
        most: bytes of all members together, unpacked.
        what: the file, for the error.
        error: raised where there is more, a name twice, or another method than deflate: others
            cannot be unpacked in bounded steps.
    """
    members: dict[str, zipfile.ZipInfo] = {}
    for entry in archive.infolist():
        name = entry.filename.removesuffix(".npy")
        if name in members:
            raise error(f"{what}: member {name!r:.60} is there twice, expected it once")
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise error(
                f"{what}: array {name!r:.60}: compressed by method {entry.compress_type}, "
                "expected deflate"
            )
        members[name] = entry
    total = sum(entry.file_size for entry in members.values())
    if total > most:
        raise error(f"{what}: arrays of {total / 1e6:.0f} MB, expected at most {most / 1e6:.0f} MB")
    return members


def read_array(
    archive: zipfile.ZipFile, entry: zipfile.ZipInfo, what: str, error: type[MobilityError]
) -> NDArray[Any]:
    """An array of an archive, read into place: with no more memory than its own.

    Args:
        archive: open for reading.
        entry: the member.
        what: the array, for the error.
        error: raised where its header does not say what follows.
    """
    with archive.open(entry) as stream:
        version = np.lib.format.read_magic(stream)
        if version != (1, 0):
            raise error(f"{what}: npy format {version}, expected (1, 0)")
        shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(stream)
        size = entry.file_size - stream.tell()
        # Check the header's size before allocating memory for it.
        fits = math.prod(shape) * dtype.itemsize == size and all(n >= 0 for n in shape)
        if dtype.hasobject or fortran_order or not fits or dtype.itemsize == 0:
            raise error(
                f"{what}: its header says {dtype} in shape {shape}, but {size} bytes follow"
            )
        array = np.empty(math.prod(shape), dtype)
        room = array.view(np.uint8) if array.size else np.empty(0, np.uint8)
        filled = 0
        # Reading one byte more reaches the end of the member, which triggers its checksum test.
        while chunk := stream.read(min(_CHUNK, size - filled + 1)):
            room[filled : filled + len(chunk)] = np.frombuffer(chunk, np.uint8)
            filled += len(chunk)
        if filled != size:
            raise error(f"{what}: {filled} bytes, expected {size}")
    return array.reshape(shape)


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
    except (
        ValueError,
        EOFError,
        KeyError,
        zipfile.BadZipFile,
        zlib.error,
        NotImplementedError,
        RuntimeError,
        MemoryError,
        TypeError,
        SyntaxError,
        LookupError,
        ArithmeticError,
        AttributeError,
    ) as cause:
        reason = next(iter(str(cause).splitlines()), type(cause).__name__)[:200]
        raise error(f"{path}: not a readable {kind} ({reason})") from cause
