"""The clock of a run: when the next step is due, and the pace of time."""

from __future__ import annotations

import time

FULL_SPEED = 0.0
"""Speed that stands for "as fast as possible"."""

LATE = 0.2
"""Seconds of delay that are made up for."""

PACE_INTERVAL = 0.5
"""Least time over which a pace is measured, seconds."""


class Clock:
    """The clock of a run.

    Attributes:
        playing: whether time goes by.
        pace: simulated seconds a second since the last measurement, or 0.
    """

    def __init__(self) -> None:
        self.playing = False
        self.pace = 0.0
        self._speed = 1.0
        self._due = self._pace_at = self._pace_from = 0.0

    @property
    def speed(self) -> float:
        """Simulated seconds in a second, or ``FULL_SPEED``."""
        return self._speed

    def set_speed(self, speed: float) -> None:
        """Simulated seconds in a second, or ``FULL_SPEED``."""
        self._speed = speed
        self._due = time.perf_counter()

    def set_playing(self, playing: bool, elapsed: float) -> None:
        """Play or pause, from ``elapsed`` simulated seconds on."""
        self.playing = playing
        self._due = self._pace_at = time.perf_counter()
        self.pace, self._pace_from = 0.0, elapsed

    def wait(self) -> float:
        """Seconds until the next step is due."""
        return max(self._due - time.perf_counter(), 0.0)

    def stepped(self, seconds: float) -> None:
        """Record a step of some simulated seconds."""
        if self._speed != FULL_SPEED:
            # A longer delay by a slow step is not made up for.
            self._due = max(self._due + seconds / self._speed, time.perf_counter() - LATE)

    def measure(self, elapsed: float) -> None:
        """Measure the pace, unless it was measured just before."""
        now = time.perf_counter()
        if self.playing and now - self._pace_at >= PACE_INTERVAL:
            self.pace = (elapsed - self._pace_from) / (now - self._pace_at)
            self._pace_at, self._pace_from = now, elapsed
