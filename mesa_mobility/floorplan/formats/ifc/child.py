"""Reads an IFC in a process of its own, within a time and a memory."""

import os
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from mesa_mobility import building_models
from mesa_mobility.errors import FloorPlanError, MobilityError
from mesa_mobility.files.apart import output_of
from mesa_mobility.floorplan.formats.assembling.texts import parsed

LARGEST_FILE = 512_000_000
"""Bytes of a file."""

LEAST_S, S_PER_MB, MOST_S = 8.0, 30.0, 110.0
"""Seconds that reading may take, by the size of the file."""

LEAST_BYTES, FACTOR = 1_000_000_000, 200
"""Memory of the process, and more of it for each byte of the file."""

MOST_OUTPUT = 256_000_000
"""Bytes of what the process prints."""


def extracted(path: Path, with_furniture: bool) -> dict[str, Any]:
    """All that is taken from a file, as ``mesa_mobility.building_models.extraction`` has it.

    Raises:
        FloorPlanError: the file cannot be read, within the time and the memory, or is no IFC.
        MobilityError: IfcOpenShell is not installed.
    """
    if find_spec("ifcopenshell") is None:
        raise MobilityError(
            f"{path}: needs IfcOpenShell: pip install 'mesa-mobility[ifc]' brings what it needs"
        )
    size = _size_of(path)
    seconds = min(LEAST_S + S_PER_MB * size / 1e6, MOST_S)
    memory = LEAST_BYTES + FACTOR * size
    words = [str(path.resolve()), str(memory), *(["furniture"] if with_furniture else [])]
    try:
        output, status = output_of(building_models.__name__, words, seconds)
    except TimeoutError:
        raise FloorPlanError(
            f"{path}: cannot be read within {seconds:.0f} s, expected a smaller or sound IFC"
        ) from None
    return _answer(output, path, status)


def _size_of(path: Path) -> int:
    try:
        with open(path, "rb") as file:
            begin = file.read(64)
            size = os.fstat(file.fileno()).st_size
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FloorPlanError(f"{path}: cannot be read ({reason})") from None
    if not begin.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"ISO-10303-21"):
        raise FloorPlanError(f"{path}: is no IFC, expected a text that begins with ISO-10303-21")
    if size > LARGEST_FILE:
        raise FloorPlanError(f"{path}: more than {LARGEST_FILE / 1e6:g} MB, expected at most that")
    return size


def _answer(output: bytes, path: Path, status: int) -> dict[str, Any]:
    if not output or len(output) > MOST_OUTPUT:
        reason = "holds too much" if output else f"IfcOpenShell ended with status {status}"
        raise FloorPlanError(f"{path}: cannot be read as IFC ({reason})")
    answer = parsed(output.decode("utf-8", "replace"), str(path))
    if not isinstance(answer, dict) or "error" in answer:
        reason = str(answer.get("error") if isinstance(answer, dict) else answer)[:160]
        raise FloorPlanError(f"{path}: cannot be read as IFC ({reason})")
    return answer
