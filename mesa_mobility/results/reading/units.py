"""The unit of coordinates, by how near people are to each other and how fast they walk."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.errors import ResultsError
from mesa_mobility.human_limits import FASTEST_SPRINT
from mesa_mobility.results.reading.rows import Rows

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
"""Metres of each unit that files have."""
TYPICAL_SPACING, TYPICAL_SPEED = 0.9, 1.2
# Crowds may be slow or sparse, but neither much faster nor much nearer: how far the logarithm of a
# figure is below and above the typical one.
SPACING_SCATTER, SPEED_SCATTER = (0.6, 1.2), (1.5, 0.4)
NEAREST_HEADS = 0.1
"""Median distance between nearest heads that no crowd has, metres."""
SAMPLED_FRAMES = 200


@dataclass(frozen=True)
class Scale:
    """What shows the unit of coordinates, in that unit.

    Attributes:
        spacing: median distance to the nearest other person; None if nobody is together.
        speed: 90th percentile of speeds over a second, a second; None if nobody moves.
        fastest: person and frame with the highest of these speeds, and the speed.
    """

    spacing: float | None
    speed: float | None
    fastest: tuple[int, int, float]

    def wrong_by(self, metres: float) -> float:
        """How unlikely a unit of so many metres is: sum of squared deviations."""
        return _off(self.spacing, metres / TYPICAL_SPACING, SPACING_SCATTER) + _off(
            self.speed, metres / TYPICAL_SPEED, SPEED_SCATTER
        )

    def said(self, metres: float) -> str:
        """The figures in metres, for a message."""
        parts = []
        if self.spacing:
            parts.append(f"nearest people are then {self.spacing * metres:.2g} m apart")
        if self.speed:
            parts.append(f"walk at {self.speed * metres:.2g} m/s")
        return " and ".join(parts)

    def impossible(self, metres: float) -> str:
        """Why the unit cannot be one of so many metres; nothing if it can."""
        person, frame, speed = self.fastest
        if self.speed and self.speed * metres > FASTEST_SPRINT:
            return f"person {person} goes {speed * metres:.3g} m/s in the second from frame {frame}"
        if self.spacing and self.spacing * metres < NEAREST_HEADS:
            return f"heads are {self.spacing * metres:.2g} m apart (person {person}, frame {frame})"
        return ""


def unit_of(path: str, rows: Rows, given: str | None, frame_rate: float) -> tuple[str, str]:
    """The unit of rows, and how it is known.

    Args:
        path: the file, for messages.
        rows: sorted by (person, frame).
        given: the unit that the caller names.
        frame_rate: frames a second.

    Raises:
        ResultsError: another unit than the file's, or one that people's spacing or speeds rule
            out.
    """
    if given is not None and given not in UNITS:
        raise ResultsError(f"unit {given!r}: expected one of {', '.join(UNITS)}")
    if given and rows.unit and given != rows.unit:
        raise ResultsError(f"{path}: its header says {rows.unit}, but unit={given!r} was given")
    scale = scale_of(rows, frame_rate)
    likely = min(UNITS, key=lambda unit: scale.wrong_by(UNITS[unit]))
    unit = given or rows.unit or likely
    if wrong := scale.impossible(UNITS[unit]):
        better = f"; unit={likely!r} would fit" if likely != unit else ""
        raise ResultsError(f"{path}: not in {unit}: {wrong}{better}")
    if given or rows.unit:
        return unit, "argument" if given else "file"
    if not (scale.spacing or scale.speed):
        raise ResultsError(f"{path}: nobody moves or is near others: give unit='m' or unit='cm'")
    return unit, scale.said(UNITS[unit])


def scale_of(rows: Rows, frame_rate: float) -> Scale:
    """Spacing and speeds of rows, which are sorted by (person, frame)."""
    first, last = pairs_apart(rows.person, rows.frame, max(round(frame_rate), 1))
    if not len(first):  # nobody stays for a second
        first = np.flatnonzero(np.diff(rows.person) == 0)
        last = first + 1
    seconds = (rows.frame[last] - rows.frame[first]) / frame_rate
    speeds = np.hypot(rows.x[last] - rows.x[first], rows.y[last] - rows.y[first]) / seconds
    fastest = (int(rows.person[0]), int(rows.frame[0]), 0.0)
    if len(speeds):
        row = first[np.argmax(speeds)]
        fastest = (int(rows.person[row]), int(rows.frame[row]), float(speeds.max()))
    speed = float(np.percentile(speeds, 90)) if len(speeds) else 0.0
    return Scale(_spacing(rows), speed or None, fastest)


def pairs_apart(
    person: NDArray[np.int64], frame: NDArray[np.int64], frames: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of rows of one person exactly so many frames apart; rows by (person, frame)."""
    key = (person.astype(np.int64) << 32) + frame
    later = np.searchsorted(key, key + frames)
    found = np.flatnonzero(key[np.minimum(later, len(key) - 1)] == key + frames)
    return found, later[found]


def _off(figure: float | None, factor: float, scatter: tuple[float, float]) -> float:
    """Squared deviation of a figure from the typical one, on a scale of logarithms."""
    if not figure:
        return 0.0
    off = log(figure * factor)
    return (off / scatter[off > 0.0]) ** 2


def _spacing(rows: Rows) -> float | None:
    """Median distance to the nearest other person in some frames."""
    frames, counts = np.unique(rows.frame, return_counts=True)
    together = frames[counts > 1]
    if not len(together):
        return None
    chosen = together[:: max(1, len(together) // SAMPLED_FRAMES)]
    order = np.argsort(rows.frame, kind="stable")
    starts = np.searchsorted(rows.frame[order], chosen)
    ends = np.searchsorted(rows.frame[order], chosen, side="right")
    nearest = []
    columns = [rows.x, rows.y] if rows.z is None else [rows.x, rows.y, rows.z]
    for start, end in zip(starts, ends, strict=True):
        places = np.column_stack(columns)[order[start:end]]
        nearest.append(cKDTree(places).query(places, k=2)[0][:, 1])
    return float(np.median(np.concatenate(nearest))) or None
