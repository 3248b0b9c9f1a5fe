"""Measuring lines: crossings, N-t curves and flow."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]

_NEAR = 0.01
"""Metres beyond the bounds of a line, more than rounding, within which steps may cross it."""


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


def crossings(trajectories: Tracks, a: ArrayLike, b: ArrayLike) -> Crossings:
    """Passages of people over the segment from a to b.

    A position exactly on the line counts as on its left, so that nobody is counted twice.

    Args:
        trajectories: the run.
        a: (2,) metres.
        b: (2,) metres.

    Raises:
        ResultsError: the two ends coincide.
    """
    return crossings_of_lines(trajectories, [(a, b)])[0]


def crossings_of_lines(
    trajectories: Tracks, lines: Iterable[tuple[ArrayLike, ArrayLike]]
) -> list[Crossings]:
    """`crossings` of several lines, each given by its two ends.

    Raises:
        ResultsError: the two ends of a line coincide.
    """
    start, end = trajectories.steps()
    x, y = trajectories.x, trajectories.y
    begins, ends = np.column_stack([x[start], y[start]]), np.column_stack([x[end], y[end]])
    low, high = np.minimum(begins, ends).T.copy(), np.maximum(begins, ends).T.copy()
    found = []
    for a, b in lines:
        x0, y0 = np.minimum(a, b) - _NEAR
        x1, y1 = np.maximum(a, b) + _NEAR
        near = np.flatnonzero((high[0] >= x0) & (low[0] <= x1) & (high[1] >= y0) & (low[1] <= y1))
        share, change = passages(begins[near], ends[near], a, b)
        on = change != 0
        rows = start[near[on]]
        time = (trajectories.frame[rows] + share[on]) / trajectories.frame_rate
        order = np.argsort(time, kind="stable")
        found.append(Crossings(time[order], trajectories.person[rows][order], change[on][order]))
    return found


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


def passed_by(found: Crossings, direction: int | None = None) -> list[list[float]]:
    """The N-t curve of a line: [[t, people who have crossed it by then], ...].

    There is an entry for each person, at their first passage.

    Args:
        found: passages, from `crossings`.
        direction: +1 or -1 for one direction only, as `Crossings.direction`.

    Raises:
        ResultsError: another direction.
    """
    times = _first_passages(found, direction)
    return [[float(time), n] for n, time in enumerate(times, start=1)]


def flow_over_time(
    found: Crossings,
    duration: float,
    *,
    window: float = 10.0,
    direction: int | None = None,
) -> list[list[float]]:
    """Flow over a line in successive windows: [[middle of the window, people a second], ...].

    Args:
        found: passages, from `crossings`; everybody counts once, at their first passage.
        duration: seconds measured (`Trajectories.duration`); a last window that is not full is
            left out.
        window: seconds.
        direction: +1 or -1 for one direction only, as `Crossings.direction`.

    Raises:
        ResultsError: another direction, or a window that is not positive.
    """
    if not window > 0.0:
        raise ResultsError(f"flow over time: window {window}, expected more than 0 s")
    windows = int(duration / window + 1e-9)
    edges = window * np.arange(windows + 1)
    # A passage on the edge of two windows belongs to the later one, also at the end.
    times = _first_passages(found, direction)
    counts = np.diff(np.searchsorted(times, edges))
    middles = edges[:-1] + window / 2
    return [[float(t), float(n / window)] for t, n in zip(middles, counts, strict=True)]


def _first_passages(found: Crossings, direction: int | None) -> np.ndarray:
    if direction not in (None, 1, -1):
        raise ResultsError(f"direction {direction!r}, expected +1, -1 or None for both")
    counted = found.direction == direction if direction else np.ones(len(found.time), bool)
    # Passages are in order of time: the first of each person is the one that np.unique finds.
    first = np.unique(found.person[counted], return_index=True)[1]
    return np.sort(found.time[counted][first])
