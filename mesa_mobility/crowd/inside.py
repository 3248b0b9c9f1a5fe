"""Everybody inside, for behaviours that look at more than those who decide."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state import Crowd


class Inside:
    """Everybody inside when decisions are made, newcomers included: m people.

    Positions are those of now, distances those of each one's last decision.

    Args:
        pedestrians: (m,) their rows in the crowd.
        crowd: the crowd.
    """

    def __init__(self, pedestrians: NDArray[np.int64], crowd: Crowd) -> None:
        self.pedestrians = pedestrians
        self._crowd = crowd

    def places(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) where in the arrays of this class people with these rows are."""
        return np.searchsorted(self.pedestrians, pedestrians)

    def types_of(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) index of the pedestrian type of people with these rows."""
        return self._crowd.kind[pedestrians].astype(np.int64)

    @property
    def positions(self) -> NDArray[np.float64]:
        """(m, 2) where they are, metres."""
        return np.column_stack([self._crowd.x[self.pedestrians], self._crowd.y[self.pedestrians]])

    @property
    def preferred_speeds(self) -> NDArray[np.float64]:
        """(m,) how fast each would walk if nothing slowed it down, m/s."""
        speeds: NDArray[np.float64] = self._crowd.agenda["speed"][self.pedestrians]
        return speeds

    @property
    def destinations(self) -> NDArray[np.int32]:
        """(m,) number of the set of exits that each may leave by, or of the gate it goes to."""
        return self._crowd.destination[self.pedestrians]

    @property
    def distances(self) -> NDArray[np.float64]:
        """(m,) metres left to go when each last decided; inf without a way."""
        return self._crowd.route[self.pedestrians]

    @property
    def groups(self) -> NDArray[np.int64]:
        """(m,) number of each one's group, 0 for those who walk alone."""
        return self._crowd.agenda["group"][self.pedestrians].astype(np.int64)
