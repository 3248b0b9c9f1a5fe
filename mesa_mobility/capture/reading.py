"""Read a recording; the file's suffix decides the format."""

from __future__ import annotations

from pathlib import Path

from mesa_mobility.capture.amc import FRAME_RATE, parse_amc
from mesa_mobility.capture.bvh import parse_bvh
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.text import read_bytes
from mesa_mobility.errors import CaptureError

SUFFIXES = (".bvh", ".bvh.xz", ".amc")
"""Supported suffixes, in lower case."""


def is_recording(path: Path) -> bool:
    """Whether a file has a supported suffix."""
    return path.name.lower().endswith(SUFFIXES)


def read_recording(
    path: str | Path, *, unit_to_m: float, frame_rate: float = FRAME_RATE
) -> Recording:
    """Read a ``.bvh``, ``.bvh.xz`` or ``.amc`` file, by the ending of its name.

    Args:
        path: the file.
        unit_to_m: metres in one unit of the file.
        frame_rate: frames a second of an AMC file, which does not store it.

    Raises:
        CaptureError: the name ends otherwise, or the file cannot be used.
    """
    path = Path(path)
    return parse_recording(read_bytes(path), path, unit_to_m=unit_to_m, frame_rate=frame_rate)


def parse_recording(data: bytes, path: Path, *, unit_to_m: float, frame_rate: float) -> Recording:
    """Read the uncompressed content of a recording; arguments as of :func:`read_recording`."""
    if not is_recording(path):
        raise CaptureError(f"{path}: unknown kind of file, expected {', '.join(SUFFIXES)}")
    if path.name.lower().endswith(".amc"):
        return parse_amc(data, path, unit_to_m=unit_to_m, frame_rate=frame_rate)
    return parse_bvh(data, path, unit_to_m=unit_to_m)
