"""Velocities and directions of measured tracks, from earlier frames alone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

WINDOW_S = 0.8
"""Seconds over which velocities are taken: most of a step of 1.1 s, in which a head sways once."""
LEAST_WAY = 0.1
"""Displacement over the window that shows a direction, metres; a swaying head makes less."""


def velocities(
    person: NDArray[np.int64],
    frame: NDArray[np.int64],
    places: FloatArray,
    frame_rate: float,
    *,
    ahead: bool = False,
) -> tuple[FloatArray, FloatArray]:
    """Mean velocity of everybody in the 0.8 s before each row.

    Args:
        person: (n,) sorted.
        frame: (n,) rising for each person.
        places: (n, 2) metres.
        frame_rate: frames a second.
        ahead: in the 0.8 s after each row instead.

    Returns:
        (n, 2) m/s, 0 in the first row of each person, and the (n,) seconds over which each was
        taken, less than 0.8 at the begin of a track (``ahead``: the last row, and the end).
    """
    if ahead:
        found, seconds = velocities(-person[::-1], -frame[::-1], places[::-1], frame_rate)
        return -found[::-1], seconds[::-1]
    key = (person.astype(np.int64) << 32) + frame
    starts = np.flatnonzero(np.diff(person, prepend=person[:1] - 1))
    own = np.repeat(starts, np.diff(starts, append=len(person)))
    earlier = np.searchsorted(key, key - max(round(WINDOW_S * frame_rate), 1))
    earlier = np.maximum(earlier, own)
    seconds = (frame - frame[earlier]) / frame_rate
    way = places - places[earlier]
    velocity = np.zeros_like(way)
    np.divide(way, seconds[:, None], where=seconds[:, None] > 0, out=velocity)
    return velocity, seconds


def headings(
    person: NDArray[np.int64], frame: NDArray[np.int64], places: FloatArray, frame_rate: float
) -> FloatArray:
    """Direction in which everybody has been walking, radians.

    The direction is that of the displacement over the last 0.8 s. A person who stands keeps the
    direction in which they came; before a person has walked, it is the direction in which they
    will. A person who never walks has 0.

    Args:
        person: (n,) sorted.
        frame: (n,) rising for each person.
        places: (n, 2) metres.
        frame_rate: frames a second.
    """
    velocity, seconds = velocities(person, frame, places, frame_rate)
    way = velocity * seconds[:, None]
    known = np.hypot(*way.T) >= LEAST_WAY
    rows = np.arange(len(person))
    last = np.maximum.accumulate(np.where(known, rows, -1))
    backwards = np.where(known, rows, len(rows))[::-1]
    following = np.minimum.accumulate(backwards)[::-1]
    before = (last >= 0) & (person[last] == person)
    after = (following < len(rows)) & (person[np.minimum(following, len(rows) - 1)] == person)
    source = np.where(before, last, np.where(after, following, rows))
    angle = np.arctan2(way[source, 1], way[source, 0])
    return np.where(before | after, angle, 0.0)
