"""One checksum over all bytes of a Parquet file, kept in its own metadata.

Checksums of pages do not cover their headers nor the footer.  The seal is a sha256 of the whole
file. It replaces 64 zeros in the JSON of the footer's key-value metadata; to check
it, they are set to zero again.
"""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import BinaryIO

from mesa_mobility.errors import ResultsError

FIELD = "sha256"
"""Name of the field of the JSON object that holds the seal."""

UNSEALED = "0" * 64
"""Content of the field until the file is sealed."""

_MAGIC = b"PAR1"
_MARK = re.compile(rf'"{FIELD}": "([0-9a-f]{{64}})"'.encode())
_CHUNK = 1 << 20


def seal(path: Path) -> None:
    """Write the checksum of a Parquet file into its metadata, where :data:`UNSEALED` stands."""
    with path.open("r+b") as file:
        seal_open(file, path)


def seal_open(file: BinaryIO, name: object) -> None:
    """As ``seal``, of an open file that messages call ``name``."""
    at = _find(file, name)
    digest = _digest(file, at)
    file.seek(at)
    file.write(digest)


def check_seal(path: Path) -> None:
    """Refuse a Parquet file of which any byte has changed since it was sealed.

    Raises:
        OSError: the file cannot be read.
        ResultsError: the file is no Parquet file, has no seal, or does not match its seal.
    """
    with path.open("rb") as file:
        check_open(file, path)


def check_open(file: BinaryIO, name: object) -> None:
    """As ``check_seal``, of an open file that messages call ``name``."""
    at = _find(file, name)
    file.seek(at)
    said = file.read(len(UNSEALED))
    if _digest(file, at) != said:
        raise ResultsError(f"{name}: damaged: its content is not what its sha256 says")


def _find(file: BinaryIO, name: object) -> int:
    """Offset of the seal in the file."""
    size = file.seek(0, 2)
    file.seek(max(0, size - 8))
    tail = file.read(8)
    length = int.from_bytes(tail[:4], "little")
    if size < 12 or tail[4:] != _MAGIC or length > size - 12:
        raise ResultsError(f"{name}: not a readable Parquet file: expected PAR1 at its end")
    start = size - 8 - length
    file.seek(start)
    marks = list(_MARK.finditer(file.read(length)))
    if len(marks) != 1:
        raise ResultsError(
            f"{name}: no {FIELD} in mesa_mobility metadata, expected a file of mesa-mobility"
        )
    return start + marks[0].start(1)


def _digest(file: BinaryIO, at: int) -> bytes:
    """Checksum of all bytes in hexadecimal digits, with zeros in place of the seal."""
    found = hashlib.sha256()
    file.seek(0)
    left = at
    while left:
        chunk = file.read(min(left, _CHUNK))
        found.update(chunk)
        left -= len(chunk)
    file.seek(at + len(UNSEALED))
    found.update(UNSEALED.encode())
    while chunk := file.read(_CHUNK):
        found.update(chunk)
    return found.hexdigest().encode()
