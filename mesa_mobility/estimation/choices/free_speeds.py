"""Free speeds of measured people: their own where they walked freely, else a distribution."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.distributions.base import Distribution
from mesa_mobility.estimation.choices.places import Places

AHEAD, BESIDE = 3.0, 0.8
"""Somebody is free who has nobody within so many metres ahead of them, and beside their way."""

LEAST_FREE = 2.0
"""Seconds that a person must be seen walking freely for a speed of their own."""

APART = 0.5
"""Seconds between a choice and the frames from which the person's free speed is taken."""


class FreeSpeeds:
    """What is known of the free speed of each person, away from a choice.

    Args:
        tracks: the tracks.
        history: seconds of which velocities are means.
        every: seconds between the instants looked at.
    """

    def __init__(self, tracks: Places, history: float, every: float = 0.2) -> None:
        step = max(round(every * tracks.rate), 1)
        self._every = step / tracks.rate
        self._rate = tracks.rate
        self._frames = np.arange(tracks.first, tracks.last + 1, step)
        self._speeds = np.full((len(tracks.people), len(self._frames)), np.nan)
        back = round(history * tracks.rate)
        for column, frame in enumerate(self._frames.tolist()):
            now, before = tracks.at(frame), tracks.at(frame - back)
            velocities = (now - before) / history
            free = _walk_freely(now, velocities)
            self._speeds[free, column] = np.hypot(*velocities[free].T)

    def own(self, frame: float, before: float, after: float) -> NDArray[np.float64]:
        """(k,) median free speed of each person, m/s, without the seconds ``before`` to ``after`` a
        choice; not a number for those who were not seen walking freely for long enough."""
        from_, to = frame - (before + APART) * self._rate, frame + (after + APART) * self._rate
        other = (self._frames < from_) | (self._frames > to)
        seen = self._speeds[:, other]
        known = np.sum(~np.isnan(seen), axis=1) * self._every >= LEAST_FREE
        speeds = np.full(len(seen), np.nan)
        if known.any():
            speeds[known] = np.nanmedian(seen[known], axis=1)
        return speeds


def _walk_freely(places: NDArray[np.float64], velocities: NDArray[np.float64]) -> NDArray[np.int64]:
    """Those who walk, with nobody ahead of them."""
    there = np.flatnonzero(~np.isnan(places[:, 0]))
    speeds = np.hypot(*velocities.T)
    moving = np.flatnonzero(speeds > 0.5)
    ways = velocities[moving] / speeds[moving, None]
    dx = places[there] - places[moving][:, None]
    along = dx[:, :, 0] * ways[:, None, 0] + dx[:, :, 1] * ways[:, None, 1]
    across = dx[:, :, 1] * ways[:, None, 0] - dx[:, :, 0] * ways[:, None, 1]
    ahead = (along > 1e-9) & (along < AHEAD) & (np.abs(across) < BESIDE)
    return moving[~ahead.any(axis=1)]


def nodes(distribution: Distribution | float, count: int) -> NDArray[np.float64]:
    """Speeds in m/s that represent a distribution, each of them equally likely.

    The expectation over the free speed is the mean over these speeds, the nodes.

    Args:
        distribution: of free speeds, m/s; or the one speed that everybody has.
        count: how many speeds represent a distribution.

    Returns:
        (count,) speeds; (1,) for a single speed.
    """
    if not isinstance(distribution, Distribution):
        return np.array([distribution])
    return distribution.quantile((np.arange(count) + 0.5) / count)
