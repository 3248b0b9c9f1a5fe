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


def read_text(path: Path) -> Rows:
    """Read a text; unit and frame rate are those of its comment lines.

    Rows that cannot be read are left out and named in ``faults``.

    Raises:
        ResultsError: the file cannot be read, or most of its rows are not of this form.
    """
    person, frame, x, y = [], [], [], []
    faults, rate, unit = [], None, None
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            for number, line in enumerate(file, 1):
                if line.startswith("#"):
                    if found := RATE.search(line):
                        rate = rate or float(found[1])
                    if found := UNIT.search(line):
                        unit = unit or found[1].lower()
                    continue
                fields = line.split("#", 1)[0].split()
                if not fields:
                    continue
                row = _row(fields)
                if row is None:
                    said = " ".join(line.split())[:40]
                    faults.append(Fault(BAD_ROW, f"line {number}: {said!r}, {EXPECTED}"))
                    continue
                person.append(row[0])
                frame.append(row[1])
                x.append(row[2])
                y.append(row[3])
    except OSError as error:
        raise ResultsError(f"{path}: cannot be read: {error.strerror}") from error
    if len(faults) >= max(len(person), 1):
        raise ResultsError(f"{path}: {faults[0].what}")
    if not person:
        raise ResultsError(f"{path}: no rows, {EXPECTED}")
    return Rows(
        np.array(person),
        np.array(frame),
        np.array(x),
        np.array(y),
        unit=unit,
        frame_rate=rate,
        faults=tuple(faults),
    )


def _row(fields: list[str]) -> tuple[int, int, float, float] | None:
    """Person, frame and place; None if the fields are others."""
    try:
        person, frame, x, y = map(float, fields[:4])
    except ValueError:
        return None
    if not (person.is_integer() and frame.is_integer() and np.isfinite(x) and np.isfinite(y)):
        return None
    return int(person), int(frame), x, y
