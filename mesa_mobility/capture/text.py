"""Text of recordings: bytes, lines and numbers, with errors that say where."""

from __future__ import annotations

import lzma
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import CaptureError


def read_bytes(path: Path) -> bytes:
    """Content of a file; of an ``.xz`` file, what was compressed.

    Raises:
        CaptureError: the file is missing, cannot be read, is empty, or is not xz though named so.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read ({error.strerror or error})") from None
    if path.suffix.lower() == ".xz":
        try:
            data = lzma.decompress(data)
        except lzma.LZMAError as error:
            raise CaptureError(f"{path}: not a complete xz file ({error})") from None
    if not data.strip():
        raise CaptureError(f"{path}: empty file")
    return data


def text_lines(data: bytes, path: Path) -> list[str]:
    """Lines of a text file, in UTF-8 or else Latin-1; line n of the file is item n - 1.

    Raises:
        CaptureError: the bytes are not text.
    """
    at = data.find(b"\0")
    if at >= 0:
        line = data.count(b"\n", 0, at) + 1
        raise CaptureError(f"{path}, line {line}: zero byte, expected a text file")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    # Not str.splitlines, which also cuts at characters that no editor counts as line ends.
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
        value = float(text)
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


def table(rows: Sequence[tuple[int, list[str]]], width: int, where: str) -> NDArray[np.float64]:
    """(rows, width) finite numbers.

    Args:
        rows: (line number, words) of each row.
        width: numbers in each row.
        where: what stands before the line number in errors.

    Raises:
        CaptureError: a row has more or fewer, or a word is no finite number.
    """
    try:
        values = np.array([words for _, words in rows], dtype=np.float64)
    except ValueError:
        values = np.empty((0, 0))
    if values.shape == (len(rows), width) and (np.abs(values) <= LARGEST).all():
        return values
    # One conversion of everything is fast; the slow way finds the line that is at fault.
    return np.array([numbers(words, width, f"{where}, line {line}") for line, words in rows])


def whole_number(text: str, where: str) -> int:
    """A whole number.

    Raises:
        CaptureError: the text is no whole number.
    """
    try:
        return int(text)
    except ValueError:
        raise CaptureError(f"{where}: {quote(text)}, expected a whole number") from None


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
