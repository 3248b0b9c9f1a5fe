"""Measures of trajectories: occupancy, egress, speed, crossings, flow and density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.trajectories import Trajectories

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Crossings:
    """Passages over a line, in order of time.

    Attributes:
        time: (k,) float64, seconds, interpolated between frames.
        person: (k,) int32.
        direction: (k,) int8: +1 from the right-hand to the left-hand side of the line as seen
            from its first end, -1 the other way.
    """

    time: FloatArray
    person: NDArray[np.int32]
    direction: NDArray[np.int8]


def occupancy(trajectories: Trajectories, every: float = 1.0) -> list[list[float]]:
    """How many people are inside, as [[t, inside], ...].

    Args:
        trajectories: the run.
        every: seconds between the entries; the first is at 0, the last not after the end.

    Raises:
        ResultsError: `every` is shorter than a frame.
    """
    inside = trajectories.inside()
    return [[time, int(inside[frame])] for time, frame in frames_at(trajectories, every)]


def frames_at(trajectories: Trajectories, every: float) -> list[tuple[float, int]]:
    """(seconds, frame) from the start on, ``every`` seconds apart, none of them after the end.

    Raises:
        ResultsError: `every` is shorter than a frame.
    """
    if not every * trajectories.frame_rate >= 1.0:
        raise ResultsError(
            f"measures every {every} s asked of {trajectories.frame_rate} frames a second"
        )
    ticks = np.arange(int(trajectories.duration / every + 1e-9) + 1)
    frames = np.rint(ticks * every * trajectories.frame_rate).astype(np.int64)
    return list(zip((ticks * every).tolist(), frames.tolist(), strict=True))


def departures(trajectories: Trajectories) -> FloatArray:
    """Exit times, (k,) seconds in rising order: each is the first frame with the person outside."""
    frames = trajectories.exit_frames
    return np.sort(frames[frames >= 0]) / trajectories.frame_rate


def egress_time(trajectories: Trajectories) -> float | None:
    """Seconds until the floor was empty; None when it was not, or nobody was ever inside."""
    if not len(trajectories) or len(trajectories.remaining):
        return None
    return float(departures(trajectories)[-1])


def speeds(trajectories: Trajectories, window: float = 1.0) -> FloatArray:
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
    trajectories: Trajectories,
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
        ResultsError: it has no length, or is no direction.
    """
    along = np.asarray(direction, dtype=np.float64)
    length = float(np.hypot(*along)) if along.shape == (2,) else 0.0
    if not 0.0 < length < np.inf:
        raise ResultsError(f"{what} along {direction!r}: expected a direction (x, y)")
    return along, length


def mean_speed(trajectories: Trajectories, window: float = 1.0) -> float | None:
    """Mean of :func:`speeds` over people and frames, m/s; None where nobody stayed that long."""
    values = speeds(trajectories, window)
    return float(values.mean()) if len(values) else None


def direction_changes(
    trajectories: Trajectories, interval: float = 1.5, minimum_m: float = 0.3
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


def crossings(trajectories: Trajectories, a: ArrayLike, b: ArrayLike) -> Crossings:
    """Passages of people over the segment from a to b.

    A position exactly on the line counts as on its left, so that nobody is counted twice.

    Args:
        trajectories: the run.
        a: (2,) metres.
        b: (2,) metres.

    Raises:
        ResultsError: the two ends coincide.
    """
    start, end = trajectories.steps()
    places = np.column_stack([trajectories.x, trajectories.y])
    share, change = passages(places[start], places[end], a, b)
    on = change != 0
    time = (trajectories.frame[start[on]] + share[on]) / trajectories.frame_rate
    order = np.argsort(time, kind="stable")
    return Crossings(time[order], trajectories.person[start[on]][order], change[on][order])


def passages(
    start: ArrayLike, end: ArrayLike, a: ArrayLike, b: ArrayLike
) -> tuple[FloatArray, NDArray[np.int8]]:
    """Find the straight steps that cross the segment from a to b, and where they cross it.

    Args:
        start: (n, 2) where each step starts, metres.
        end: (n, 2) where it ends.
        a: (2,) metres.
        b: (2,) metres.

    Returns:
        (n,) share of the step that lies before the line, and (n,) the direction as in
        :class:`Crossings`, 0 for steps that do not pass.

    Raises:
        ResultsError: the two ends of the segment coincide.
    """
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    along = b - a
    length2 = float(along @ along)
    if not length2 > 0:
        raise ResultsError(f"a line to cross needs two ends, both are {tuple(a.tolist())}")

    def beside(points: ArrayLike) -> tuple[FloatArray, FloatArray]:
        dx, dy = (np.asarray(points, dtype=np.float64).reshape(-1, 2) - a).T
        return along[0] * dy - along[1] * dx, (along[0] * dx + along[1] * dy) / length2

    (side, at), (side_end, at_end) = beside(start), beside(end)
    change = (side_end >= 0).astype(np.int8) - (side >= 0).astype(np.int8)
    crossing = change != 0
    share = np.zeros(len(side))
    share[crossing] = side[crossing] / (side[crossing] - side_end[crossing])
    where = at + share * (at_end - at)
    change[(where < 0) | (where > 1)] = 0
    return share, change


def flow(times: ArrayLike) -> float | None:
    """Mean flow of passages at the given times, people a second.

    J = (N - 1) / (t_N - t_1): the time before the first person arrives does not count. None for
    fewer than two passages.
    """
    ordered = np.sort(np.asarray(times, dtype=np.float64))
    if len(ordered) < 2 or ordered[-1] == ordered[0]:
        return None
    return float((len(ordered) - 1) / (ordered[-1] - ordered[0]))


def density(
    trajectories: Trajectories, area: shapely.Polygon, every: float = 1.0
) -> list[list[float]]:
    """People in an area divided by its size, as [[t, people / m2], ...].

    The classic density N / A; see `voronoi_density` for one without its jumps.

    Args:
        trajectories: the run.
        area: measuring polygon, metres.
        every: seconds between the entries.

    Raises:
        ResultsError: an area without size.
    """
    if not area.area > 0:
        raise ResultsError("the measuring area of a density has no size")
    shapely.prepare(area)
    offsets = trajectories.frame_offsets
    result: list[list[float]] = []
    for tick, frame in frames_at(trajectories, every):
        rows = slice(offsets[frame], offsets[frame + 1])
        inside = shapely.contains_xy(area, trajectories.x[rows], trajectories.y[rows])
        result.append([tick, float(np.count_nonzero(inside) / area.area)])
    return result


def frames_in(seconds: float, trajectories: Trajectories, name: str) -> int:
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
