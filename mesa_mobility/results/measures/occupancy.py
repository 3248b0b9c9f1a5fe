"""Occupancy: how many people are inside, and when they leave."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]


def occupancy(trajectories: Tracks, every: float = 1.0) -> list[list[float]]:
    """How many people are inside, as [[t, inside], ...].

    Args:
        trajectories: the run.
        every: seconds between the entries; the first is at 0, the last not after the end.

    Raises:
        ResultsError: `every` is shorter than a frame.
    """
    inside = trajectories.inside()
    return [[time, int(inside[frame])] for time, frame in frames_at(trajectories, every)]


def frames_at(trajectories: Tracks, every: float) -> list[tuple[float, int]]:
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


def departures(trajectories: Tracks) -> FloatArray:
    """Exit times of the k people who have left, (k,) seconds in rising order.

    A person's exit time is the time of the first frame in which they are outside.
    """
    frames = trajectories.exit_frames
    return np.sort(frames[frames >= 0]) / trajectories.frame_rate


def egress_time(trajectories: Tracks) -> float | None:
    """Seconds until the floor was empty; None when it was not, or nobody was ever inside."""
    if not len(trajectories) or len(trajectories.remaining):
        return None
    return float(departures(trajectories)[-1])
