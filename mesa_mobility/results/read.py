"""Measured tracks from a file of any format that is known."""

from __future__ import annotations

import os
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mesa_mobility.bodies.velocities import headings
from mesa_mobility.errors import ResultsError
from mesa_mobility.plugins.formats import READ
from mesa_mobility.results.formats.output_format import OUTPUTS
from mesa_mobility.results.reading.faults import faults_of, sorted_once
from mesa_mobility.results.reading.pedpy_files import READERS, read_with_pedpy
from mesa_mobility.results.reading.rates import usual_rate
from mesa_mobility.results.reading.rows import Reading, Rows
from mesa_mobility.results.reading.units import UNITS, unit_of
from mesa_mobility.results.tracks import Tracks

LARGEST = 10_000_000
"""Largest number of a person or frame: arrays have an entry for each."""
NOMINAL_RATE = 20.0
"""Frames a second at which the unit is guessed before the frame rate is: units differ by more."""


def read_columns(
    path: str | os.PathLike[str], unit: str | None, frame_rate: float | None
) -> dict[str, Any]:
    """The fields of ``Trajectories`` by name; see ``Trajectories.read``."""
    source = Path(path)
    if not source.is_file():
        raise ResultsError(f"{source}: no such file")
    if frame_rate is not None and not 0.0 < frame_rate < np.inf:
        raise ResultsError(f"frame_rate is {frame_rate}, expected a positive number")
    found = _found_in(source)
    if isinstance(found, Tracks):
        return _as_stored(source, found, unit, frame_rate)
    rows, name = sorted_once(_checked(source, found)), str(path)
    rate, rate_from = _rate(source, rows, unit, frame_rate)
    unit, unit_from = unit_of(name, rows, unit, rate)
    rows = replace(rows, x=rows.x * UNITS[unit], y=rows.y * UNITS[unit])
    fields = {} if rows.z is None else {"z": rows.z * UNITS[unit]}
    reading = Reading(
        name,
        unit,
        unit_from,
        rate,
        rate_from,
        "way" if rows.heading is None else "file",
        (*rows.faults, *faults_of(rows, rate)),
    )
    for line in reading.warnings():
        warnings.warn(line, stacklevel=3)
    if rows.heading is None:
        places = np.column_stack([rows.x, rows.y])
        rows = replace(rows, heading=headings(rows.person, rows.frame, places, rate))
    columns = {name: getattr(rows, name) for name in ("frame", "person", "x", "y", "heading")}
    return {**columns, "fields": fields, "frame_rate": rate, "reading": reading}


def _found_in(source: Path) -> Rows | Tracks:
    """What the file's format reads from it.

    Raises:
        ResultsError: no format reads it.
    """
    ends = tuple(OUTPUTS.suffixes(READ))
    if source.name.lower().endswith(ends):
        return OUTPUTS.of(source, READ).read(source)
    if source.suffix.lower() in READERS:
        return read_with_pedpy(source)
    known = ", ".join(dict.fromkeys([*ends, *READERS]))
    raise ResultsError(f"{source}: expected tracks in a file whose name ends in {known}")


def _as_stored(
    source: Path, tracks: Tracks, unit: str | None, frame_rate: float | None
) -> dict[str, Any]:
    """Tracks of a file that says everything itself.

    Raises:
        ResultsError: the caller says otherwise.
    """
    if unit not in (None, "m"):
        raise ResultsError(f"{source}: it is in m, but unit={unit!r} was given")
    _agreed(source, tracks.frame_rate, frame_rate)
    reading = Reading(str(source), "m", "file", tracks.frame_rate, "file")
    stored = {name: getattr(tracks, name) for name in tracks.__dataclass_fields__}
    return {**stored, "reading": reading}


def _rate(source: Path, rows: Rows, unit: str | None, given: float | None) -> tuple[float, str]:
    """The frame rate, and how it is known.

    Raises:
        ResultsError: there is none, it is not positive, or the file's is another.
    """
    if rows.frame_rate is not None:
        if not 0.0 < rows.frame_rate < np.inf:
            raise ResultsError(f"{source}: its frame rate is {rows.frame_rate}, expected above 0")
        _agreed(source, rows.frame_rate, given)
        return rows.frame_rate, "file"
    if given is not None:
        return float(given), "argument"
    likely, _ = unit_of(str(source), rows, unit, NOMINAL_RATE)
    guessed = usual_rate(rows, UNITS[likely])
    if guessed is None:
        raise ResultsError(f"{source}: no frame rate in it: give it, as in frame_rate=16")
    rate, by_gait, pieces = guessed
    return rate, f"steps in {pieces} pieces of tracks suggest {by_gait:.1f}"


def _agreed(source: Path, rate: float, given: float | None) -> None:
    if given is not None and not np.isclose(given, rate):
        raise ResultsError(
            f"{source}: it has {rate:g} frames a second, but frame_rate={given:g} was given"
        )


def _checked(source: Path, rows: Rows) -> Rows:
    """Rows of whole numbers in range and finite places.

    Raises:
        ResultsError: others, with the row, the person and the frame.
    """
    columns: dict[str, Any] = {
        name: np.asarray(getattr(rows, name)) for name in ("person", "frame", "x", "y")
    }
    if not len(rows.person):
        raise ResultsError(f"{source}: no rows")
    for name, values in columns.items():
        whole = name in ("person", "frame")
        good = np.isfinite(values.astype(np.float64))
        if whole:
            good &= (values >= 0) & (values <= LARGEST)
        if not good.all():
            row = int(np.argmin(good))
            where = f"person {columns['person'][row]}, frame {columns['frame'][row]}"
            expected = f"expected 0 to {LARGEST}" if whole else "expected a number"
            raise ResultsError(f"{source}: {where}: {name} is {values[row]}, {expected}")
        columns[name] = values.astype(np.int64 if whole else np.float64)
    return replace(rows, **columns)
