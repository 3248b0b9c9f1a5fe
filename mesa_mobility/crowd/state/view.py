"""View of everybody inside, for behaviours that look beyond the deciding pedestrians."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state.people_grid import Grid, build_grid
from mesa_mobility.crowd.state.records import Crowd


class CrowdView:
    """The m people inside when decisions are made, newcomers included.

    Positions are current; distances are those of each one's last decision.

    Args:
        pedestrians: (m,) their rows in the crowd.
        crowd: the crowd.
        copies: (k,) rows of copies of people on other sheets of the floor plan, if there are any.
    """

    def __init__(
        self,
        pedestrians: NDArray[np.int64],
        crowd: Crowd,
        copies: NDArray[np.int64] | None = None,
    ) -> None:
        self.pedestrians = pedestrians
        self.crowd = crowd
        self._copies = copies

    def places(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) indices of people with these rows in the arrays of this class."""
        return np.searchsorted(self.pedestrians, pedestrians)

    def types_of(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) index of the pedestrian type of people with these rows."""
        return self.crowd.type_index[pedestrians].astype(np.int64)

    @property
    def positions(self) -> NDArray[np.float64]:
        """(m, 2) metres."""
        return np.column_stack([self.crowd.x[self.pedestrians], self.crowd.y[self.pedestrians]])

    @cached_property
    def grid(self) -> Grid:
        """The people by cell, where they were when it was first asked for: tactics share it.

        In a building, people on stairs are there on both sheets, once in a row of their own and
        once in that of a copy, which ``crowd.person_of`` leads back to the person.
        """
        rows = self.pedestrians
        if self._copies is not None:
            rows = np.concatenate([rows, self._copies])
        return build_grid(rows, self.crowd.x, self.crowd.y)

    @property
    def preferred_speeds(self) -> NDArray[np.float64]:
        """(m,) unhindered preferred speeds, m/s."""
        speeds: NDArray[np.float64] = self.crowd.agenda["speed"][self.pedestrians]
        return speeds

    @property
    def destinations(self) -> NDArray[np.int32]:
        """(m,) number of the set of exits by which each may leave, or of the gate to cross."""
        return self.crowd.destination[self.pedestrians]

    @property
    def distances(self) -> NDArray[np.float64]:
        """(m,) length of the route when each last decided, metres; inf without one."""
        return self.crowd.route[self.pedestrians]

    @property
    def fields(self) -> dict[str, NDArray[Any]]:
        """(m,) values of each field that the model declares for its people."""
        return {name: values[self.pedestrians] for name, values in self.crowd.fields.items()}

    @property
    def groups(self) -> NDArray[np.int64]:
        """(m,) number of each one's group, 0 for those who walk alone."""
        return self.crowd.agenda["group"][self.pedestrians].astype(np.int64)
