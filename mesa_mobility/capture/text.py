"""Text of recordings: bytes, lines and numbers, with errors that say where."""

from __future__ import annotations

import lzma
import math
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import CaptureError

LARGEST_FILE = 64_000_000
"""Bytes of text in a file, uncompressed: some ten minutes of 31 joints at 120 Hz."""

MOST_LINES = 3_000_000
"""Lines of a file; an AMC file has one for each bone in each frame."""

_XZ_MEMORY = 200_000_000
"""Bytes that unpacking may take; the highest preset of xz takes 65 million."""


def read_bytes(path: Path) -> bytes:
    """Content of a file, decompressed if it is an ``.xz`` file.

    Raises:
        CaptureError: the file is missing, cannot be read, is empty, holds more than
            :data:`LARGEST_FILE`, or is not xz though named so.
    """
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read ({error.strerror or error})") from None
    if path.suffix.lower() == ".xz" and len(data) <= LARGEST_FILE:
        try:
            data = _unpack(data)
        except lzma.LZMAError as error:
            raise CaptureError(f"{path}: not a complete xz file ({error})") from None
    if len(data) > LARGEST_FILE:
        raise CaptureError(
            f"{path}: more than {LARGEST_FILE // 10**6} MB of text, expected a shorter recording"
        )
    if not data or data.isspace():
        raise CaptureError(f"{path}: empty file")
    return data


def _unpack(data: bytes) -> bytes:
    """Content of xz streams, cut off behind ``LARGEST_FILE`` bytes and one more."""
    unpacked = bytearray()
    while data and len(unpacked) <= LARGEST_FILE:
        stream = lzma.LZMADecompressor(memlimit=_XZ_MEMORY)
        unpacked += stream.decompress(data, LARGEST_FILE + 1 - len(unpacked))
        if not stream.eof and len(unpacked) <= LARGEST_FILE:
            raise lzma.LZMAError("it ends too soon")
        data = stream.unused_data.lstrip(b"\0")
    return bytes(unpacked)


def text_lines(data: bytes, path: Path) -> list[str]:
    """Lines of a text file, in UTF-8 or else Latin-1; line n of the file is item n - 1.

    Raises:
        CaptureError: the bytes are not text, or of more than :data:`MOST_LINES` lines.
    """
    at = data.find(b"\0")
    if at >= 0:
        line = data.count(b"\n", 0, at) + 1
        raise CaptureError(f"{path}, line {line}: zero byte, expected a text file")
    if max(data.count(b"\n"), data.count(b"\r")) > MOST_LINES:
        raise CaptureError(f"{path}: more than {MOST_LINES} lines, expected a shorter recording")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    # str.splitlines would also split at characters that no editor counts as line ends.
    return text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\n").split("\n")


LARGEST = 1e9
"""Numbers beyond this are no coordinates or angles, and overflow when computed with."""


def quote(text: str) -> str:
    """A short, printable form of part of a file, for one line of an error."""
    return ascii(text if len(text) <= 40 else text[:37] + "...")


def number(text: str, where: str) -> float:
    """A finite number, of a size that coordinates and angles have.

    Raises:
        CaptureError: the text is no such number; ``where`` says what file and line.
    """
    try:
        # Python accepts underscores between digits; no file format does.
        value = math.nan if "_" in text else float(text)
    except ValueError:
        value = math.nan
    if not abs(value) <= LARGEST:
        raise CaptureError(f"{where}: {quote(text)}, expected a finite number")
    return value


def numbers(texts: Sequence[str], count: int, where: str) -> list[float]:
    """Exactly ``count`` finite numbers.

    Raises:
        CaptureError: there are more or fewer, or one is no finite number.
    """
    if len(texts) != count:
        raise CaptureError(f"{where}: {len(texts)} values, expected {count}")
    return [number(text, where) for text in texts]


def table(rows: Sequence[tuple[int, str]], width: int, where: str) -> NDArray[np.float64]:
    """(rows, width) finite numbers.

    Args:
        rows: line number and text of each row.
        width: numbers in each row.
        where: text before the line number in errors.

    Raises:
        CaptureError: a row has more or fewer, or a word is no finite number.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)  # rows that are all empty
            values = np.loadtxt([text for _, text in rows], ndmin=2, comments=None)
    except (ValueError, UserWarning):
        values = np.empty((0, 0))
    if values.shape == (len(rows), width) and (np.abs(values) <= LARGEST).all():
        return values
    # Converting everything at once is fast. If it fails, go line by line to find the bad one.
    return np.array([numbers(text.split(), width, f"{where}, line {line}") for line, text in rows])


def whole_number(text: str, where: str) -> int:
    """A whole number.

    Raises:
        CaptureError: the text is no whole number.
    """
    try:
        if "_" not in text:
            return int(text)
    except ValueError:
        pass
    raise CaptureError(f"{where}: {quote(text)}, expected a whole number")


def check_unit(unit_to_m: float, where: str) -> None:
    """Refuse a length unit that is not a positive, finite number of metres.

    Raises:
        CaptureError: as said.
    """
    if not (math.isfinite(unit_to_m) and unit_to_m > 0):
        raise CaptureError(f"{where}: unit of {unit_to_m} m, expected a positive length")


def stem(path: Path) -> str:
    """Name of a clip: the file's name without ``.bvh``, ``.amc`` or ``.bvh.xz``."""
    name = path.name.removesuffix(".xz") if path.suffix.lower() == ".xz" else path.name
    return Path(name).stem
