"""Has an evacuation stalled?"""

from __future__ import annotations

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.overview import Overview

STALL_SECONDS = 60.0
"""An evacuation has stalled when for so long nobody left and nobody came nearer to an exit."""

STALL_PROGRESS = 1.0
"""Metres of route, summed over everybody, that count as coming nearer."""


class StallWatch:
    """Watches people inside and the way they still have to go."""

    def __init__(self) -> None:
        self._since = 0.0
        self._mark: tuple[int, int, int, float] = (-1, 0, 0, 0.0)

    def stalled(self, frame: int, seen: Overview, crossed: int) -> bool:
        """Whether nothing has got better for a minute.

        Args:
            frame: now.
            seen: what the people inside are about.
            crossed: gates that people have crossed on their journeys so far.
        """
        elapsed = frame * FRAME_SECONDS
        inside, left = seen.people, seen.left
        now = (inside, seen.going, crossed)
        # Others may stand because of somebody who is yet to set off. More way to go is news as
        # well: a door closed, and people are on another way.
        if seen.awaited or now != self._mark[:3] or abs(left - self._mark[3]) > STALL_PROGRESS:
            self._since, self._mark = elapsed, (*now, left)
        return inside > 0 and elapsed - self._since >= STALL_SECONDS - 1e-9
