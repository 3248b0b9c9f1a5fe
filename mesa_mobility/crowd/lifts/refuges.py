"""Refuge areas: where people wait who cannot leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.ops import polylabel

from mesa_mobility.buildings import Refuge
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.schema import Array, Kind

NOWHERE = -1

APART = 0.3
"""Metres between two bodies at which somebody stands beside another who waits there already."""

THERE = 0.3
"""Metres from the middle of a refuge at which people stand."""

GIVES_UP = 10.0
"""Seconds without coming nearer after which people wait before a refuge."""

_EXACT = 0.05
"""Metres to which the middle of a refuge is found."""


class Refuges(Saved):
    """The refuge areas of a building, and who is bound for them. Rows are those of the crowd.

    People who do not use stairs and have no way out get the middle of the nearest refuge as their
    destination. They wait at the middle, or in the area beside others who wait and are nearer to
    the middle. If they come no nearer for a while, they wait beside others before the area, too.

    Args:
        refuges: the areas, in the plane.
        site: the routes.
        climbs: whether the people of each type use stairs.

    Attributes:
        refuges: the areas, in the plane.
    """

    def __init__(
        self, refuges: Sequence[Refuge], site: Environment, climbs: Sequence[bool]
    ) -> None:
        self.refuges = tuple(refuges)
        self._site, self._climbs = site, np.array(climbs, dtype=np.bool_)
        spots = [polylabel(each.shape, _EXACT) for each in self.refuges]
        self._middles = [(float(each.x), float(each.y)) for each in spots]
        self._there = np.empty(0, np.bool_)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {"there": Array("?", ("known",))}

    def state(self) -> dict[str, Any]:
        """Who has come to a refuge."""
        return {"there": self._there}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._there = state["there"]

    def __len__(self) -> int:
        return len(self.refuges)

    def bound_for(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) number of the refuge for which each person in ``rows`` is bound; -1 for none."""
        found = np.full(len(rows), NOWHERE)
        for kind in np.flatnonzero(~self._climbs).tolist():
            for number, middle in enumerate(self._middles):
                to = crowd.destination[rows] == self._site.point(middle, kind)
                found[to & (crowd.type_index[rows] == kind)] = number
        return found

    def send(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.bool_]:
        """Send those in ``rows`` who have no way out to the nearest refuge to which they have one.

        Args:
            rows: (n,) people who decide now.
            crowd: the crowd; destinations and routes are changed.

        Returns:
            (n,) who is sent now.
        """
        sent = np.zeros(len(rows), np.bool_)
        kinds = crowd.type_index[rows]
        for k in np.flatnonzero(~self._climbs[kinds] & np.isinf(crowd.route[rows])).tolist():
            place = np.array([[crowd.x[rows[k]], crowd.y[rows[k]]]])
            for middle in self._middles:
                to = self._site.point(middle, int(kinds[k]))
                way = float(self._site.targets(place, np.array([to])).distances[0])
                if way < crowd.route[rows[k]]:
                    crowd.destination[rows[k]], crowd.route[rows[k]] = to, way
                    sent[k] = True
        return sent

    def arrived(
        self, rows: NDArray[np.int64], inside: NDArray[np.int64], frame: int, crowd: Crowd
    ) -> NDArray[np.bool_]:
        """(n,) whether people in ``rows``, of those ``inside``, wait where they are from now on."""
        waits = self.waiting(inside, crowd)
        others, theirs = inside[waits != NOWHERE], waits[waits != NOWHERE]
        there = np.zeros(len(rows), np.bool_)
        for k, number in enumerate(self.bound_for(rows, crowd).tolist()):
            if number == NOWHERE:
                continue
            row, (x, y) = rows[k], self._middles[number]
            away = float(np.hypot(crowd.x[row] - x, crowd.y[row] - y))
            apart = np.hypot(crowd.x[others] - crowd.x[row], crowd.y[others] - crowd.y[row])
            ahead = np.hypot(crowd.x[others] - x, crowd.y[others] - y) < away
            near = apart < crowd.core[others] + crowd.core[row] + APART
            beside = bool((ahead & near & (theirs == number)).any())
            area = self.refuges[number].shape
            within = bool(shapely.intersects_xy(area, crowd.x[row], crowd.y[row]))
            stuck = frame * FRAME_SECONDS - crowd.agenda["since"][row] > GIVES_UP
            there[k] = away < THERE or (beside and (within or stuck))
        self._there[rows] = there
        return there

    def waiting(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) number of the refuge in which each person in ``rows`` waits; -1 for none."""
        more = int(rows.max(initial=-1)) + 1 - len(self._there)
        if more > 0:
            self._there = np.append(self._there, np.zeros(more, np.bool_))
        return np.where(self._there[rows], self.bound_for(rows, crowd), NOWHERE)
