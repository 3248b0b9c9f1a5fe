"""Speeds, and changes of direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]


def speeds(trajectories: Tracks, window: float = 1.0) -> FloatArray:
    """Speed of everybody in every frame that has a position `window` seconds later.

    Returns:
        (k,) m/s, by person, then frame: straight displacement over the window, divided by it. A
        window of about a gait cycle leaves out the pelvis's side-to-side motion.
    """
    frames = frames_in(window, trajectories, "window")
    start, end = trajectories.steps(frames)
    dx = trajectories.x[end] - trajectories.x[start]
    dy = trajectories.y[end] - trajectories.y[start]
    return np.hypot(dx, dy) * (trajectories.frame_rate / frames)


@dataclass(frozen=True, eq=False)
class SpeedsAlong:
    """Speeds in one direction, by person, then frame.

    Attributes:
        time: (k,) seconds, in the middle of the window.
        person: (k,) int32.
        point: (k, 2) where the person was then, metres.
        speed: (k,) m/s, negative for those who went back.
    """

    time: FloatArray
    person: NDArray[np.int32]
    point: FloatArray
    speed: FloatArray


def speeds_along(
    trajectories: Tracks,
    direction: ArrayLike,
    *,
    window: float = 1.5,
    area: shapely.Polygon | None = None,
) -> SpeedsAlong:
    """Displacement in a direction over a window, divided by it: v = (x(t + w/2) - x(t - w/2)) / w.

    In every frame in which a person has positions half a window before and after, and is in the
    measuring area.  1.5 s are about a gait cycle: shorter windows count the swing of the pelvis.

    Args:
        trajectories: the run.
        direction: (2,) of any length.
        window: seconds.
        area: measuring polygon, metres; by default everywhere.

    Raises:
        ResultsError: a direction without length, or a window shorter than a frame.
    """
    along, length = checked_direction(direction, "speeds")
    frames = frames_in(window, trajectories, "window")
    order = trajectories.by_person
    start, end = order[:-frames], order[frames:]
    middle = order[frames // 2 : len(order) - frames + frames // 2]
    kept = (trajectories.person[start] == trajectories.person[end]) & (
        trajectories.frame[end] - trajectories.frame[start] == frames
    )
    if area is not None:
        shapely.prepare(area)
        kept &= shapely.contains_xy(area, trajectories.x[middle], trajectories.y[middle])
    start, middle, end = start[kept], middle[kept], end[kept]
    dx = trajectories.x[end] - trajectories.x[start]
    dy = trajectories.y[end] - trajectories.y[start]
    seconds = frames / trajectories.frame_rate
    return SpeedsAlong(
        time=trajectories.frame[start] / trajectories.frame_rate + seconds / 2,
        person=trajectories.person[middle],
        point=np.column_stack([trajectories.x[middle], trajectories.y[middle]]),
        speed=(dx * along[0] + dy * along[1]) / (length * seconds),
    )


def checked_direction(direction: ArrayLike, what: str) -> tuple[FloatArray, float]:
    """A direction as (2,) numbers, and its length.

    Args:
        direction: (2,) of any length.
        what: what is measured along it, for the error.

    Raises:
        ResultsError: the direction has no length, or is no direction.
    """
    along = np.asarray(direction, dtype=np.float64)
    length = float(np.hypot(*along)) if along.shape == (2,) else 0.0
    if not 0.0 < length < np.inf:
        raise ResultsError(f"{what} along {direction!r}: expected a direction (x, y)")
    return along, length


def mean_speed(trajectories: Tracks, window: float = 1.0) -> float | None:
    """Mean of :func:`speeds` over people and frames, m/s; None where nobody stayed that long."""
    values = speeds(trajectories, window)
    return float(values.mean()) if len(values) else None


def direction_changes(
    trajectories: Tracks, interval: float = 1.5, minimum_m: float = 0.3
) -> FloatArray:
    """Changes of people's direction of travel from one interval to the next.

    Each person's track is cut into steps of `interval` seconds from its first frame on. Works on
    positions alone, as measured tracks of heads do, not on headings.

    Args:
        trajectories: the run.
        interval: seconds.
        minimum_m: steps shorter than this have no direction and are left out, metres.

    Returns:
        (k,) radians in [-pi, pi), positive to the left.
    """
    frames = frames_in(interval, trajectories, "interval")
    start, end = trajectories.steps(frames)
    first_frame = np.full(int(trajectories.person.max(initial=-1)) + 1, -1, dtype=np.int64)
    backwards = slice(None, None, -1)
    first_frame[trajectories.person[backwards]] = trajectories.frame[backwards]
    on_grid = (trajectories.frame[start] - first_frame[trajectories.person[start]]) % frames == 0
    start, end = start[on_grid], end[on_grid]
    dx = trajectories.x[end] - trajectories.x[start]
    dy = trajectories.y[end] - trajectories.y[start]
    angle, long_enough = np.arctan2(dy, dx), np.hypot(dx, dy) >= minimum_m
    follows = (end[:-1] == start[1:]) & long_enough[:-1] & long_enough[1:]
    change = np.diff(angle)[follows]
    return wrapped(change)


def wrapped(angles: FloatArray) -> FloatArray:
    """The same angles in [-pi, pi), radians."""
    return (angles + np.pi) % (2 * np.pi) - np.pi


def frames_in(seconds: float, trajectories: Tracks, name: str) -> int:
    """How many frames a time has, rounded.

    Raises:
        ResultsError: less than one.
    """
    frames = round(seconds * trajectories.frame_rate)
    if frames < 1:
        raise ResultsError(
            f"{name} of {seconds} s is shorter than a frame at {trajectories.frame_rate} Hz"
        )
    return frames
