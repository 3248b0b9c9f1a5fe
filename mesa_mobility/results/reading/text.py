"""The text form of the Juelich data archive: lines of id, frame, x, y and perhaps more."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.reading.rows import BAD_ROW, Fault, Rows

RATE = re.compile(r"frame\s*rate\D*?(\d+(?:\.\d*)?)", re.IGNORECASE)
UNIT = re.compile(r"(?:\b[xy]\s*/\s*|\bx\s*\[|\bin\s+)(mm|cm|m)\b", re.IGNORECASE)
EXPECTED = "expected id, frame, x, y"

ELEVATIONS = "z is the elevation of the floor"
"""A comment line that says so of the fifth column. In most files of measured tracks this column is
the height of heads, which nothing here uses."""


def read_text(path: Path) -> Rows:
    """Read a text; unit and frame rate are those of its comment lines.

    Rows that cannot be read are left out and named in ``faults``. The fifth column is read if a
    comment line before the rows says that it is the elevation of the floor.

    Raises:
        ResultsError: the file cannot be read, or most of its rows are not of this form.
    """
    rows = list[tuple[float, ...]]()
    faults, rate, unit, columns = [], None, None, 4
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            for number, line in enumerate(file, 1):
                if line.startswith("#"):
                    if found := RATE.search(line):
                        rate = rate or float(found[1])
                    if found := UNIT.search(line):
                        unit = unit or found[1].lower()
                    if line.strip("# \n") == ELEVATIONS and not rows:
                        columns = 5
                    continue
                fields = line.split("#", 1)[0].split()
                if not fields:
                    continue
                row = _row(fields, columns)
                if row is None:
                    said = " ".join(line.split())[:40]
                    faults.append(Fault(BAD_ROW, f"line {number}: {said!r}, {EXPECTED}"))
                    continue
                rows.append(row)
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror}") from error
    if len(faults) >= max(len(rows), 1):
        raise ResultsError(f"{path}: {faults[0].what}")
    if not rows:
        raise ResultsError(f"{path}: no rows, {EXPECTED}")
    person, frame, *places = map(np.array, zip(*rows, strict=True))
    return Rows(
        person,
        frame,
        places[0],
        places[1],
        unit=unit,
        frame_rate=rate,
        faults=tuple(faults),
        z=places[2] if columns == 5 else None,
    )


def _row(fields: list[str], columns: int) -> tuple[float, ...] | None:
    """Person, frame, x, y and, of five columns, z; None if the fields are others."""
    try:
        person, frame, *place = map(float, fields[:columns])
    except ValueError:
        return None
    if len(place) != columns - 2 or not np.isfinite(place).all():
        return None
    if not (person.is_integer() and frame.is_integer()):
        return None
    return int(person), int(frame), *place
