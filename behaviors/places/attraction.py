"""Stopping at shop windows and screens."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility import (
    Deciding,
    Desired,
    ListOf,
    Range,
    Tactic,
    Visit,
    World,
    check_fields,
)
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Array, Kind, Several, Whole

# Metres from an attraction's place within which somebody counts as one who looks.
_LOOKS = 0.5


@dataclass(frozen=True)
class Attraction:
    """A shop window, a screen or a performer, for which some of those who pass by stop.

    Attributes:
        place: where people stand to look: an area, a polygon (shapely or WKT), or a point (x, y) in
            metres.
        stay: seconds for which they look, or a distribution of them.
        share: of those who pass by, how many stop if nobody is looking.
        influence: by how much each person who is looking raises the odds of stopping.
        distance: metres from the place within which people notice it.

    Raises:
        ModelError: a number out of range.
        FloorPlanError: a place that is neither a point nor a polygon.
    """

    place: Any
    stay: float | Distribution
    share: Annotated[float, Range(0.0, 1.0)] = 0.0
    influence: Annotated[float, Range(0.0)] = 0.0
    distance: Annotated[float, Range(0.0, unit="m", above=True)] = 5.0

    def __post_init__(self) -> None:
        check_fields(self, "attraction")
        Visit(self.place, stay=self.stay)  # refuses what is no place or no time

    @cached_property
    def visit(self) -> Visit:
        """The place to visit."""
        return Visit(self.place, stay=self.stay)

    @cached_property
    def shape(self) -> shapely.Polygon | shapely.Point:
        """The place as a geometry, metres."""
        place = self.visit.place
        return shapely.Point(place) if isinstance(place, tuple) else place

    def chance(self, looking: int) -> float:
        """Probability that somebody stops where so many people are looking."""
        if self.share == 1.0:
            return 1.0
        odds = self.share / (1.0 - self.share) + self.influence * looking
        return odds / (1.0 + odds)


class Attractions(Tactic):
    """Some of those who pass a shop window or a screen stop to look, and then go on.

    Each person has one chance to stop at each attraction: when they first walk within ``distance``
    of it, with no wall between. Those who stop visit the place and then go on with their route. The
    odds of stopping grow in proportion to the number of people who look already. That others'
    interest draws people to attractions is the social influence of Kwak, Jo, Luttinen and Kosonen
    (2014, Transportation Research Procedia 2: 612-617). Of those who passed one person looking up
    4 % stopped, and 40 % of those who passed 15 (Milgram, Bickman and Berkowitz 1969, Journal of
    Personality and Social Psychology 13: 79-82). A ``share`` of 0 and an ``influence`` of 1/24 give
    4 and 38.5 %.

    People whose route goes round for ever do not stop.

    Args:
        attractions: the attractions.
    """

    name = "attraction"
    after = "speed_rules"
    saved: ClassVar[Mapping[str, Kind]] = {  # attractions are given again
        "_passed": Array("?", (None, "attractions")),
        "_stopped": Several(Several(Whole(below="people")), length="attractions"),
    }

    _model: World

    def __init__(
        self, attractions: Annotated[Iterable[Attraction], ListOf(Attraction, once=True)] = ()
    ) -> None:
        self.attractions: tuple[Attraction, ...] = attractions  # type: ignore[assignment]
        self._passed = np.zeros((0, len(self.attractions)), dtype=np.bool_)
        self._stopped: list[list[int]] = [[] for _ in self.attractions]

    def bind(self, model: World) -> None:
        """Keep the model, whose people stop."""
        self._model = model

    def stopped(self, attraction: Attraction) -> list[int]:
        """Rows of all who have been drawn to an attraction so far, in order."""
        return list(self._stopped[self.attractions.index(attraction)])

    def passed(self, attraction: Attraction) -> NDArray[np.int64]:
        """Rows of all who have had their chance at an attraction so far."""
        return np.flatnonzero(self._passed[:, self.attractions.index(attraction)])

    def looking(self, attraction: Attraction) -> int:
        """How many people stand at an attraction and look, however they have come there."""
        crowd, rows = self._model.crowd, self._model.population.present
        near = shapely.dwithin(
            shapely.points(crowd.x[rows], crowd.y[rows]), attraction.shape, _LOOKS
        )
        stands = self._model.journeys.stays.stands
        return sum(bool(stands(row)) for row in rows[near].tolist())

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send some of those who notice an attraction there, from their next decision on."""
        rows = deciding.pedestrians
        if desired.newcomers or not self.attractions:
            return
        more = int(rows.max()) + 1 - len(self._passed)
        if more > 0:
            new = np.zeros((more, len(self.attractions)), dtype=np.bool_)
            self._passed = np.concatenate([self._passed, new])
        walks = ~deciding.waiting
        places = shapely.points(deciding.positions)
        for number, attraction in enumerate(self.attractions):
            fresh = walks & ~self._passed[rows, number]
            who = np.flatnonzero(
                fresh & shapely.dwithin(places, attraction.shape, attraction.distance)
            )
            middle = attraction.shape.representative_point()
            there = np.tile((middle.x, middle.y), (len(who), 1))
            who = who[lines_of_sight(deciding.site.plan, deciding.positions[who], there)]
            if not len(who):
                continue
            self._passed[rows[who], number] = True
            chance = attraction.chance(self.looking(attraction))
            for k in who[deciding.rng.random(len(who)) < chance].tolist():
                if self._send(int(rows[k]), attraction.visit):
                    self._stopped[number].append(int(rows[k]))

    def _send(self, row: int, visit: Visit) -> bool:
        """Send somebody to a place before the rest of their route; whether that is possible."""
        model, agenda = self._model, self._model.crowd.agenda
        number, crossed = int(agenda["journey"][row]), int(agenda["crossed"][row])
        stops = model.journeys.stops(number)[crossed:]
        exits = model.population.exits(row)
        if not exits or (stops and stops[0] == visit) or model.journeys.stays.stands(row):
            return False
        try:
            model.population.send(row, exits, [visit, *stops], model.frame)
        except FloorPlanError:  # no room for their body there, or no way
            return False
        return True
