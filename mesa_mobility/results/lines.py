"""Measuring lines: cumulative crossings and flow over time."""

from __future__ import annotations

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures import Crossings


def passed_by(found: Crossings, direction: int | None = None) -> list[list[float]]:
    """The N-t curve of a line: [[t, people who have crossed it by then], ...].

    An entry for each person, at its first passage.

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
        found: passages, from `crossings`; everybody counts once, at its first passage.
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
