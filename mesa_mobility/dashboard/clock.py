"""When the next step of a run is due, and how fast time goes by."""

from __future__ import annotations

import time

FULL_SPEED = 0.0
"""Speed that stands for "as fast as it goes"."""

LATE = 0.2
"""Seconds by which steps may be late and still be made up for."""

PACE_INTERVAL = 0.5
"""Least time over which a pace is measured, seconds."""


class Clock:
    """Time in a run, which goes by or does not.

    Attributes:
        playing: whether it goes by.
        pace: simulated seconds in a second since it was last asked for, or 0.
    """

    def __init__(self) -> None:
        self.playing = False
        self.pace = 0.0
        self._speed = 1.0
        self._due = self._pace_at = self._pace_from = 0.0

    def set_speed(self, speed: float) -> None:
        """Simulated seconds in a second, or ``FULL_SPEED``."""
        self._speed = speed
        self._due = time.perf_counter()

    def set_playing(self, playing: bool, elapsed: float) -> None:
        """Let time go by, or not, from ``elapsed`` simulated seconds on."""
        self.playing = playing
        self._due = self._pace_at = time.perf_counter()
        self.pace, self._pace_from = 0.0, elapsed

    def wait(self) -> float:
        """Seconds until the next step is due."""
        return max(self._due - time.perf_counter(), 0.0)

    def stepped(self, seconds: float) -> None:
        """A step of so many simulated seconds was made."""
        if self._speed != FULL_SPEED:
            # What a slow step has lost is not made up for beyond a moment.
            self._due = max(self._due + seconds / self._speed, time.perf_counter() - LATE)

    def measure(self, elapsed: float) -> None:
        """Work out the pace anew if it was not just done."""
        now = time.perf_counter()
        if self.playing and now - self._pace_at >= PACE_INTERVAL:
            self.pace = (elapsed - self._pace_from) / (now - self._pace_at)
            self._pace_at, self._pace_from = now, elapsed
