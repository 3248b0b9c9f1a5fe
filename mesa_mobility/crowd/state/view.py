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
    """

    def __init__(self, pedestrians: NDArray[np.int64], crowd: Crowd) -> None:
        self.pedestrians = pedestrians
        self.crowd = crowd

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
        once in that of a copy, which ``person_of`` leads back to the person.
        """
        return build_grid(self.with_copies(self.pedestrians), self.crowd.x, self.crowd.y)

    def with_copies(self, pedestrians: NDArray[np.int64]) -> NDArray[np.int64]:
        """These rows, and those of the copies of the same people on other sheets, if any."""
        copies = self.crowd.copies
        if not len(copies):
            return pedestrians
        return np.concatenate([pedestrians, copies[np.isin(self.person_of(copies), pedestrians)]])

    def person_of(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) rows of the people who, or whose copies, are in these rows."""
        return self.crowd.person_of[rows] if len(self.crowd.person_of) else rows

    def seen_by(
        self, pedestrians: NDArray[np.int64], others: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """(n, 2) where each of n people sees one of the others, metres.

        That is where the other is, or where their copy is, if that is nearer.

        Args:
            pedestrians: (n,) rows of those who look.
            others: (n,) rows of those whom they look at.
        """
        crowd = self.crowd
        seen = np.column_stack([crowd.x[others], crowd.y[others]])
        here = np.column_stack([crowd.x[pedestrians], crowd.y[pedestrians]])
        for copy in crowd.copies[np.isin(self.person_of(crowd.copies), others)]:
            there = np.array([crowd.x[copy], crowd.y[copy]])
            nearer = np.hypot(*(there - here).T) < np.hypot(*(seen - here).T)
            seen[nearer & (others == crowd.person_of[copy])] = there
        return seen

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
