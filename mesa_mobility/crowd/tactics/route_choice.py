"""Route choice: the behaviour that gives people the gates by which they go."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.lifts.lifts import NOBODY
from mesa_mobility.crowd.tactics.deciding import Deciding
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets
from mesa_mobility.plugins.annotations import Range
from mesa_mobility.schema import Array, Kind

AGAIN = Array("f8", high=1e9, infinite=True)
"""When each person chooses again, s, in a checkpoint: -inf before the first time."""


class RouteChoice(TargetChoice):
    """A target choice that gives each person a path: the gates that they cross before they leave.

    Subclasses set ``name`` and define ``routes``. Everybody chooses at their first decision, and
    again at random, every ``interval`` seconds on average. Between gates people take the shortest
    way. People with a route of their own keep it, and so do people on an escalator or in a lift,
    until they get out. An object of this class serves one model.

    Args:
        interval: mean seconds between two choices; by default people choose once.

    Raises:
        ModelError: an interval that is not positive.
    """

    def __init__(
        self, interval: Annotated[float, Range(0.0, unit="s", above=True, endless=True)] = math.inf
    ) -> None:
        self.interval = interval
        self._again = np.empty(0)

    _model: World

    def bind(self, model: World) -> None:
        """Keep the model, whose people this choice sends."""
        self._model = model

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are that are not a subclass's own."""
        return super().members() or {**self.setting_kinds(), "_again": AGAIN}

    @abstractmethod
    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> Sequence[Sequence[str] | None]:
        """Names of the gates that people cross, in order; none of them for the shortest way, and
        None for who goes on as before.

        Args:
            deciding: everybody who decides.
            who: (k,) indices among them of those who choose a route.

        Returns:
            k lists of names.
        """

    def targets(self, deciding: Deciding) -> Targets:
        """Targets on the chosen routes."""
        rows, destinations = deciding.pedestrians, deciding.destinations
        who = self._choosing(deciding)
        if len(who):
            given = self.routes(deciding, who)
            if len(given) != len(who):
                raise ModelError(
                    f"behaviour {self.name!r}: gave {len(given)} routes, expected {len(who)}"
                )
            people, frame = self._model.population, self._model.frame
            for row, gates in zip(rows[who].tolist(), given, strict=True):
                if gates is not None:
                    people.send(row, people.exits(row) or None, gates, frame)
            destinations = self._model.crowd.destination[rows].astype(np.int64)
        return deciding.site.targets(deciding.positions, destinations)

    def _choosing(self, deciding: Deciding) -> NDArray[np.int64]:
        """Indices of those who choose now; notes when they do so again."""
        rows = deciding.pedestrians
        more = int(rows.max(initial=-1)) + 1 - len(self._again)
        if more > 0:
            self._again = np.append(self._again, np.full(more, -np.inf))
        new = self._again[rows] == -np.inf
        self._again[rows[new & (self._model.crowd.agenda["journey"][rows] > 0)]] = np.inf
        due = (self._again[rows] <= deciding.elapsed) & ~self._ride(deciding)
        who: NDArray[np.int64] = np.flatnonzero(due)
        waits = np.full(len(who), math.inf)
        if math.isfinite(self.interval):
            waits = deciding.rng.exponential(self.interval, len(who))
        self._again[rows[who]] = deciding.elapsed + waits
        return who

    def _ride(self, deciding: Deciding) -> NDArray[np.bool_]:
        """(n,) whether each is in a lift, is to get into it, or waits on the first step of an
        escalator; those whom it carries take no decisions."""
        rows, lifts = deciding.pedestrians, self._model.lifts
        ride = np.zeros(len(rows), dtype=np.bool_)
        if len(lifts):
            ride |= (lifts.rides(rows) != NOBODY) | (lifts.car_of(deciding.positions) != NOBODY)
        if len(self._model.escalators):
            ride |= self._model.escalators.waits(rows, deciding.positions)
        return ride
