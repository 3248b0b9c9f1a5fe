"""Has an evacuation stalled?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

STALL_SECONDS = 60.0
"""An evacuation has stalled when for so long nobody left and nobody came nearer to an exit."""

STALL_PROGRESS = 1.0
"""Metres of route, summed over everybody, that count as coming nearer."""


class StallWatch:
    """Watches people inside and the way they still have to go."""

    def __init__(self) -> None:
        self._since = 0.0
        self._mark: tuple[int, int, int, float] = (-1, 0, 0, 0.0)

    def stalled(
        self, elapsed: float, routes: NDArray[np.float64], crossed: int, awaited: bool
    ) -> bool:
        """Whether nothing has got better for a minute.

        Args:
            elapsed: simulated seconds.
            routes: (n,) metres that each person inside still has to go, inf without a way out.
            crossed: gates that people have crossed on their journeys so far.
            awaited: somebody inside is yet to set off, and others may stand because of that.
        """
        finite = routes[np.isfinite(routes)]
        now, left = (len(routes), len(finite), crossed), float(finite.sum())
        # More way to go is news as well: a door closed, and people are on another way.
        if awaited or now != self._mark[:3] or abs(left - self._mark[3]) > STALL_PROGRESS:
            self._since, self._mark = elapsed, (*now, left)
        return len(routes) > 0 and elapsed - self._since >= STALL_SECONDS - 1e-9
