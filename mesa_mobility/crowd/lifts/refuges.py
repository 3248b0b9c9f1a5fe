"""Refuge areas: where people wait who cannot leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry
from shapely.ops import polylabel

from mesa_mobility.buildings import Refuge
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import FARTHEST, Crowd
from mesa_mobility.errors import ContentError
from mesa_mobility.schema import Array, Kind

NOWHERE = -1

APART = 0.3
"""Metres between two bodies at which somebody stands beside another who waits there already."""

THERE = 0.3
"""Metres from their spot, or from the middle of a refuge, at which people stand."""

GIVES_UP = 10.0
"""Seconds without coming nearer after which people wait before a refuge."""

SLOWEST = 0.2
"""Metres a second at which people come to their spot, unless others keep them out."""

_BETWEEN = 0.1
"""Metres between two bodies, and between a body and walls, as in the car of a lift."""

_STEP = 0.2
"""Metres from one spot that is tried to the next."""

_EXACT = 0.05
"""Metres to which the middle of a refuge is found."""


class Refuges(Saved):
    """The refuge areas of a building, and who is bound for them. Rows are those of the crowd.

    People who do not use stairs and have no way out, while others have one, get the middle of the
    nearest refuge as their destination. In the area they go to the free spot that is farthest from
    where they have come in. If others keep them out, or there is no spot left, they wait beside
    others, in the area or before it. When the plan changes, those who have not arrived are free to
    go where they wanted to go.

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
        self._survey()
        self._there = np.empty(0, np.bool_)
        self._number, self._goal, self._meant, self._until = np.empty((4, 0), np.int64)
        self._spot = np.empty((0, 2))

    def _survey(self) -> None:
        """Find the floor of each refuge without obstacles, and its middle."""
        self._free = [
            shapely.intersection(each.shape, self._site.plan.free) for each in self.refuges
        ]
        self._middles = [_middle(each) for each in self._free]

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        rows = ("known",)
        return {
            "_there": Array("?", rows),
            "_number": Array("i8", rows, NOWHERE, len(self.refuges) - 1),
            "_goal": Array("i8", rows, NOWHERE),
            "_meant": Array("i8", rows, NOWHERE),
            "_until": Array("i8", rows, NOWHERE),
            "_spot": Array("f8", ("known", 2), -FARTHEST, FARTHEST),
        }

    def state(self) -> dict[str, Any]:
        """The refuge and place for which each person is bound, and whether they are there."""
        return {name: getattr(self, name) for name in self.members()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given.

        Raises:
            ContentError: a destination that the routes do not have.
        """
        if (state["_meant"] >= self._site.destinations).any():
            raise ContentError("refuges, _meant: has a destination that there is not")
        for name in self.members():
            setattr(self, name, state[name])
        self._survey()

    def __len__(self) -> int:
        return len(self.refuges)

    def bound_for(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) number of the refuge for which each person in ``rows`` is bound; -1 for none."""
        self._make_room(rows)
        still = self._goal[rows] == crowd.destination[rows]
        return np.where(still, self._number[rows], NOWHERE)

    def cut_off(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.bool_]:
        """(n,) whether people in ``rows`` have no way only because they do not use stairs."""
        found = ~self._climbs[crowd.type_index[rows]] & np.isinf(crowd.route[rows])
        lost = rows[found]
        if len(lost):
            places = np.column_stack([crowd.x[lost], crowd.y[lost]])
            to = crowd.destination[lost].astype(np.int64)
            found[found] = self._site.leads_over_stairs(places, to)
        return found

    def look_over(self, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Note that the plan has changed: those in ``rows``, who are inside, and have not arrived
        are to go where they wanted to go before."""
        if not self.refuges:
            return
        self._make_room(rows)
        self.free(rows[~self._there[rows]], crowd)
        self._survey()

    def free(self, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Let those in ``rows`` who are bound for a refuge, or wait there, go where they wanted to
        go before."""
        bound = rows[self.bound_for(rows, crowd) != NOWHERE]
        crowd.destination[bound] = self._meant[bound]
        self._number[bound], self._until[bound] = NOWHERE, NOWHERE

    def send(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.bool_]:
        """Send those in ``rows`` who are cut off to the nearest refuge to which they have a way.

        Args:
            rows: (n,) people who decide now.
            crowd: the crowd; destinations and routes are changed.

        Returns:
            (n,) who is sent now.
        """
        sent = np.zeros(len(rows), np.bool_)
        self._make_room(rows)
        lost = np.flatnonzero(self.cut_off(rows, crowd))
        who = rows[lost]
        places = np.column_stack([crowd.x[who], crowd.y[who]])
        kinds, meant = crowd.type_index[who].tolist(), crowd.destination[who]
        for number, middle in enumerate(self._middles if len(lost) else ()):
            if middle is None:
                continue
            to = np.array([self._site.point(middle, kind) for kind in kinds], dtype=np.int64)
            ways = self._site.targets(places, to).distances
            nearer = ways < crowd.route[who]
            own = who[nearer]
            crowd.destination[own], crowd.route[own] = to[nearer], ways[nearer]
            self._number[own], self._goal[own], self._meant[own] = number, to[nearer], meant[nearer]
            self._there[own], self._until[own], sent[lost[nearer]] = False, NOWHERE, True
        return sent

    def spots(
        self, rows: NDArray[np.int64], inside: NDArray[np.int64], frame: int, crowd: Crowd
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The spots of those in ``rows`` who are in their refuge and have not come to one yet.

        Args:
            rows: (n,) people who decide now.
            inside: everybody inside.
            frame: now.
            crowd: the crowd.

        Returns:
            (k,) which of ``rows``, and (k, 2) metres.
        """
        number = self.bound_for(rows, crowd)
        for k in np.flatnonzero((number != NOWHERE) & (self._until[rows] == NOWHERE)).tolist():
            row, area = int(rows[k]), self._free[number[k]]
            if shapely.intersects_xy(area, crowd.x[row], crowd.y[row]):
                self._give_spot(row, int(number[k]), inside, frame, crowd)
        has = (number != NOWHERE) & (self._until[rows] != NOWHERE) & ~self._there[rows]
        who = np.flatnonzero(has)
        return who, self._spot[rows[who]]

    def _give_spot(
        self, row: int, number: int, inside: NDArray[np.int64], frame: int, crowd: Crowd
    ) -> None:
        """Give somebody the free spot that is farthest from where they are, if there is one."""
        core, here = crowd.core[row], np.array([crowd.x[row], crowd.y[row]])
        room = shapely.buffer(self._free[number], -(core + _BETWEEN))
        if room.is_empty:
            return
        low, high = np.array(room.bounds[:2]), np.array(room.bounds[2:])
        axes = [
            low[k] + _STEP * np.arange(int((high[k] - low[k]) / _STEP + 1e-9) + 1) for k in (0, 1)
        ]
        places = np.column_stack([each.ravel() for each in np.meshgrid(*axes)])
        # A place on the edge of what is left of a small area counts.
        places = places[shapely.dwithin(room, shapely.points(places), 1e-6)]
        others = inside[(self.bound_for(inside, crowd) == number) & (inside != row)]
        others = others[self._there[others] | (self._until[others] != NOWHERE)]
        stands = np.column_stack([crowd.x[others], crowd.y[others]])
        taken = np.where(self._there[others][:, None], stands, self._spot[others])
        away = np.hypot(*np.moveaxis(places[:, None] - taken, -1, 0))
        places = places[(away >= crowd.core[others] + core + _BETWEEN).all(axis=1)]
        if not len(places):
            return
        way = np.hypot(*(places - here).T)
        best = int(np.argmax(way))
        self._spot[row] = places[best]
        seconds = GIVES_UP + float(way[best]) / SLOWEST
        self._until[row] = frame + round(seconds / FRAME_SECONDS)

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
            row, middle = rows[k], self._middles[number]
            if self._there[row] or middle is None:
                there[k] = self._there[row]
                continue
            here = np.array([crowd.x[row], crowd.y[row]])
            if self._until[row] != NOWHERE:
                left = np.hypot(*(self._spot[row] - here))
                there[k] = left < THERE or frame >= self._until[row]
                continue
            away = float(np.hypot(*(here - middle)))
            apart = np.hypot(crowd.x[others] - here[0], crowd.y[others] - here[1])
            ahead = np.hypot(crowd.x[others] - middle[0], crowd.y[others] - middle[1]) < away
            near = apart < crowd.core[others] + crowd.core[row] + APART
            beside = bool((ahead & near & (theirs == number)).any())
            within = bool(shapely.intersects_xy(self._free[number], *here))
            stuck = frame * FRAME_SECONDS - crowd.agenda["since"][row] > GIVES_UP
            there[k] = away < THERE or (beside and (within or stuck))
        self._there[rows] = there
        return there

    def waiting(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) number of the refuge in which each person in ``rows`` waits; -1 for none."""
        number = self.bound_for(rows, crowd)
        return np.where(self._there[rows], number, NOWHERE)

    def _make_room(self, rows: NDArray[np.int64]) -> None:
        more = int(rows.max(initial=-1)) + 1 - len(self._there)
        if more <= 0:
            return
        self._there = np.append(self._there, np.zeros(more, np.bool_))
        for name in ("_number", "_goal", "_meant", "_until"):
            setattr(self, name, np.append(getattr(self, name), np.full(more, NOWHERE)))
        self._spot = np.append(self._spot, np.zeros((more, 2)), axis=0)


def _middle(area: BaseGeometry) -> tuple[float, float] | None:
    """The place of an area that is farthest from its edge; None if nothing is left of it."""
    parts = [each for each in shapely.get_parts(area) if each.geom_type == "Polygon" and each.area]
    spots = [polylabel(each, _EXACT) for each in parts]
    if not spots:
        return None
    best = max(spots, key=lambda spot: float(spot.distance(area.boundary)))
    return float(best.x), float(best.y)
