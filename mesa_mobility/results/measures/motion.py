"""How people move inside a crowd: steps, accelerations, jumps of speed, ways back.

All work on positions alone, as measured tracks of heads do; only :func:`facing_angles` needs
headings. Definitions are those by which the reference figures were measured.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d

from mesa_mobility.results.measures.speeds import checked_direction, frames_in, wrapped
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]

SETTLED_S = 0.9
"""Ends of a track in which its smoothing is not settled yet: three deviations, seconds."""


@dataclass(frozen=True)
class Selection:
    """The part of a run that counts.

    Attributes:
        area: polygon in which tracks count, metres; by default everywhere.
        after: seconds from which on tracks count.
    """

    area: shapely.Polygon | None = None
    after: float = 0.0


WHOLE_RUN = Selection()


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps of equal duration, and how each differs from the one before.

    Attributes:
        across: (n,) component of each step across the direction of the crowd, metres.
        turns: (k,) change of direction between successive steps, radians in [-pi, pi).
        speed_changes: (k,) change of speed between successive steps, m/s.
        successive: (k, 2) ``across`` of successive steps, metres.
    """

    across: FloatArray
    turns: FloatArray
    speed_changes: FloatArray
    successive: FloatArray


def steps_between(
    trajectories: Tracks,
    direction: ArrayLike,
    *,
    interval: float = 1.5,
    selection: Selection = WHOLE_RUN,
) -> Steps:
    """Cut the part of each track inside an area into steps of equal duration.

    Args:
        trajectories: the run.
        direction: (2,) of the crowd, of any length.
        interval: duration of a step, seconds.
        selection: part of the run that counts; a step starts and ends in its area.

    Raises:
        ResultsError: an interval shorter than a frame, or a direction without length.
    """
    frames = frames_in(interval, trajectories, "interval")
    along, length = checked_direction(direction, "steps")
    ex, ey = along / length
    across, turns, changes, successive = [], [], [], []
    for places, _ in _tracks(trajectories, selection):
        dx, dy = np.diff(places[::frames], axis=0).T
        aside = ex * dy - ey * dx
        angle, speed = np.arctan2(dy, dx), np.hypot(dx, dy) / interval
        across.append(aside)
        turns.append(wrapped(np.diff(angle)))
        changes.append(np.diff(speed))
        successive.append(np.column_stack([aside[:-1], aside[1:]]))
    return Steps(_joined(across), _joined(turns), _joined(changes), _joined(successive, (0, 2)))


def lateral_correlation(successive: ArrayLike) -> float:
    """Correlation of the lateral component of successive steps; negative where people zigzag.

    Args:
        successive: (k, 2) metres, as in :class:`Steps`, of one run or of several together.
    """
    first, second = np.asarray(successive, dtype=np.float64).T
    return float(np.corrcoef(first, second)[0, 1])


def accelerations(
    trajectories: Tracks,
    *,
    smoothing: float = 0.3,
    selection: Selection = WHOLE_RUN,
) -> FloatArray:
    """Second derivative of positions smoothed by a Gaussian.

    Args:
        trajectories: the run.
        smoothing: standard deviation of the Gaussian, seconds.
        selection: part of the run that counts.

    Returns:
        (k,) m/s2, of every frame but the first and last 0.9 s of each track.
    """
    rate = trajectories.frame_rate
    edge = round(SETTLED_S * rate)
    found = []
    for places, _ in _tracks(trajectories, selection):
        smooth = gaussian_filter1d(places, smoothing * rate, axis=0, mode="nearest")
        second = np.diff(smooth, 2, axis=0)[edge:-edge] * rate**2
        found.append(np.hypot(second[:, 0], second[:, 1]))
    return _joined(found)


def speed_jumps(
    trajectories: Tracks,
    *,
    interval: float = 0.1,
    least_speed: float = 0.5,
    selection: Selection = WHOLE_RUN,
) -> FloatArray:
    """Norm of the change of mean velocity between successive intervals of people who walk.

    Args:
        trajectories: the run.
        interval: seconds.
        least_speed: in both intervals, m/s.
        selection: part of the run that counts.

    Returns:
        (k,) m/s.

    Raises:
        ResultsError: an interval shorter than a frame.
    """
    frames = frames_in(interval, trajectories, "interval")
    found = []
    for places, _ in _tracks(trajectories, selection):
        velocity = np.diff(places[::frames], axis=0) / interval
        fast = np.hypot(velocity[:, 0], velocity[:, 1]) > least_speed
        change = np.diff(velocity, axis=0)[fast[1:] & fast[:-1]]
        found.append(np.hypot(change[:, 0], change[:, 1]))
    return _joined(found)


def facing_angles(
    trajectories: Tracks,
    *,
    interval: float = 0.5,
    least_speed: float = 0.5,
    selection: Selection = WHOLE_RUN,
) -> FloatArray:
    """Angle between the direction of travel and the facing direction of people who walk.

    Args:
        trajectories: the run.
        interval: over which travel is measured, seconds; facing is that in its middle.
        least_speed: m/s.
        selection: part of the run that counts.

    Returns:
        (k,) radians from 0 to pi, one for each interval in which somebody walks.
    """
    frames = frames_in(interval, trajectories, "interval")
    found = []
    for places, headings in _tracks(trajectories, selection):
        dx, dy = np.diff(places[::frames], axis=0).T
        facing = headings[frames // 2 :: frames][: len(dx)]
        fast = np.hypot(dx, dy) > least_speed * interval
        off = np.arctan2(dy, dx) - facing
        found.append(np.abs(wrapped(off))[fast])
    return _joined(found)


def walked_back(trajectories: Tracks, point: ArrayLike) -> FloatArray:
    """How far each person has walked back from a point that they had come nearer to.

    Args:
        trajectories: the run.
        point: (2,) metres, for instance the middle of a door.

    Returns:
        (people,) metres, in order of persons: the greatest distance regained after coming nearer.
    """
    x, y = np.asarray(point, dtype=np.float64)
    found = []
    for places, _ in _tracks(trajectories, WHOLE_RUN):
        away = np.hypot(places[:, 0] - x, places[:, 1] - y)
        # Once through, people move away from the door because they have passed it.
        until = int(np.argmin(away)) + 1
        found.append(float(np.max(away[:until] - np.minimum.accumulate(away[:until]))))
    return np.array(found)


def _tracks(trajectories: Tracks, selection: Selection) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Places (n, 2) and headings (n,) of each unbroken piece of a track in the selection."""
    rows = trajectories.by_person
    kept = trajectories.frame[rows] >= selection.after * trajectories.frame_rate
    if selection.area is not None:
        shapely.prepare(selection.area)
        kept &= shapely.contains_xy(selection.area, trajectories.x[rows], trajectories.y[rows])
    rows = rows[kept]
    breaks = np.flatnonzero(
        (np.diff(trajectories.person[rows]) != 0) | (np.diff(trajectories.frame[rows]) != 1)
    )
    for piece in np.split(rows, breaks + 1):
        if len(piece):
            places = np.column_stack([trajectories.x[piece], trajectories.y[piece]])
            yield places, trajectories.heading[piece]


def _joined(parts: list[FloatArray], empty: tuple[int, ...] = (0,)) -> FloatArray:
    return np.concatenate(parts) if parts else np.empty(empty)
