"""Giving way in corridors too narrow for two: those who have less far to go back do so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from mesa_mobility.behaviors.corridors import Corridor, find_corridors
from mesa_mobility.behaviors.negotiation import OFF, Negotiation, Party, agree, courses_of
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Range, Tactic, World
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import (
    Array,
    Flag,
    Kind,
    Maybe,
    Members,
    Several,
    check,
    check_shape,
)

REACH = 3.0
"""Metres before an end at which people heed a negotiation; no movement is longer."""

ARRIVED = 0.15
"""Metres from its place at which somebody stands."""

FACING = 0.1
"""Metres in front of a person who stands, towards its target: people turn round while they
wait, for which there is no room at a jamb."""

ASIDE = 0.8
"""Highest speed of those who step aside, m/s."""

SAME_WAY = 0.3
"""Cosine of the angle from which on another tactic sends somebody aside, not just a little to the
left or right."""

ENTERED = 0.3
"""Metres from a place, aside of the way, within which somebody leaves the way free."""

ROOM_TO_ENTER = 2.5
"""Metres before a place at which others stop to let people in."""

SECONDS_TO_STOP = 1.5
"""Time in which people come to a halt: the longest movement."""

BERTH = 0.5
"""Share of the narrowest body's radius that lines of sight along the way keep from walls: people
who stand close to a wall see them, too."""

LOOK = 0.5
"""Metres between the points of the way to which people who go back look."""


class Yielding(Tactic):
    """Where two parties meet in a corridor in which they cannot pass, one goes back to let the
    other through.

    A corridor is floor too narrow for two people, at least 2 m long, that leads from one room of
    20 m2 to another; niches and bays belong to it. A party is all who go the same way through it.
    Two parties meet when somebody sees somebody of the other, ``sight`` metres ahead along the way.
    Each person can clear the way at a place that is ``room`` metres aside of it: in a niche, or in
    the room behind the own party.

    The rule: the party gives way whose members together have fewer metres to walk to such places.
    So few give way to many, and those who are near a niche or their end of the corridor to those
    who are far from theirs. If both have as far, the smaller party gives way. Those who give way
    wait until the others have passed; then they have precedence until they are through, and who
    meets them gives way. Meanwhile nobody else enters. If nobody makes progress for 10 s, the other
    party gives way.

    Add it to ``model.tactics``, after those that the model has. Ends of corridors at exits, and
    corridors with more than two ends, are left to the other tactics.

    Args:
        sight: metres along the way at which people see each other come.
        room: metres between the middles of two people who pass each other; each takes 0.6 m
            (Fruin, Pedestrian Planning and Design, 1971). Wide bodies need more, and get it.

    Raises:
        ModelError: a sight or room that is not finite and positive.
    """

    name = "yielding"

    def __init__(
        self,
        sight: Annotated[float, Range(0.0, unit="m", above=True)] = 6.0,
        room: Annotated[float, Range(0.0, unit="m", above=True)] = 0.6,
    ) -> None:
        self.sight, self.room = sight, room
        self._version = -1
        self._corridors: list[Corridor] = []
        self._negotiations: list[Negotiation | None] = []
        # For each corridor, the way that each person goes through it: 1, -1, or 0 for neither.
        self._courses = np.zeros((0, 0), dtype=np.int8)

    def bind(self, model: World) -> None:
        """Keep the model, whose orders to wait are heeded."""
        self._model = model
        self._widest = max(each.half_width for each in model.pedestrian_types)
        self._narrowest = min(each.least_core for each in model.pedestrian_types)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            **self.setting_kinds(),
            "courses": Array("i1", ("corridors", None), -1, 1),
            "negotiations": Several(Maybe(Members(Negotiation.members())), length="corridors"),
            "current": Flag(),
        }

    def state(self) -> dict[str, Any]:
        """Who gives way to whom where; corridors follow from the floor plan."""
        return {
            "sight": self.sight,
            "room": self.room,
            "courses": self._courses,
            "negotiations": [None if each is None else each.state() for each in self._negotiations],
            "current": self._version == self._model.floor_plan.version,
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self.sight, self.room = state["sight"], state["room"]
        if state["current"]:
            self._survey()
        self._courses = state["courses"]
        self._negotiations = [
            None if each is None else Negotiation(**each) for each in state["negotiations"]
        ]
        if state["current"]:
            check_shape((len(self._courses),), (len(self._corridors),), "courses", {})
            for corridor, each in zip(self._corridors, self._negotiations, strict=True):
                most = len(corridor.places) - 1
                if each is not None:
                    check(each.places, Array("i8", (len(each.giving),), 0, most), "places")

    @property
    def giving_way(self) -> list[int]:
        """Rows of those who give way now."""
        return sorted(int(row) for each in self._negotiations if each for row in each.giving)

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Lead those who give way back, those who pass on, and keep others out meanwhile."""
        if desired.newcomers:
            return
        if self._version != deciding.site.plan.version:
            self._survey()
        more = int(deciding.inside.pedestrians.max()) + 1 - self._courses.shape[1]
        if more > 0:
            self._courses = np.pad(self._courses, ((0, 0), (0, more)))
        waiting = deciding.waiting
        for number, corridor in enumerate(self._corridors):
            along, aside, within = corridor.locate(deciding.positions)
            here = np.flatnonzero(~np.isnan(along))
            self._courses[number, deciding.pedestrians[np.isnan(along)]] = 0
            if len(here) == 0:
                continue
            rows = deciding.pedestrians[here]
            courses = courses_of(
                corridor,
                deciding.positions[here],
                desired.targets.points[here],
                along[here],
                within[here],
                self._courses[number, rows],
            )
            self._courses[number, rows] = np.where(waiting[here], 0, courses)
            party = self._people(number, deciding)
            negotiation = agree(
                self._negotiations[number], corridor, party, deciding.elapsed, self.sight
            )
            self._negotiations[number] = negotiation
            if negotiation is not None:
                free = here[~waiting[here]]
                self._lead(number, deciding, desired, free, along[free], aside[free], within[free])

    def _survey(self) -> None:
        """Look for corridors."""
        plan = self._model.floor_plan
        self._version = plan.version
        self._corridors = find_corridors(
            plan, self._narrowest, self._widest, max(self.room, 2.0 * self._widest + 0.1)
        )
        self._negotiations = [None] * len(self._corridors)
        self._courses = np.zeros((len(self._corridors), self._courses.shape[1]), dtype=np.int8)

    def _people(self, number: int, deciding: Deciding) -> Party:
        """Those inside who go through a corridor, or negotiate there."""
        inside = deciding.inside.pedestrians
        concerned = self._courses[number, inside] != 0
        negotiation = self._negotiations[number]
        if negotiation is not None:
            concerned |= np.isin(inside, negotiation.going) | np.isin(inside, negotiation.giving)
        rows = inside[concerned]
        places = np.column_stack([self._model.crowd.x[rows], self._model.crowd.y[rows]])
        courses = self._courses[number, rows].astype(np.int64)
        return Party(rows, courses, *self._corridors[number].locate(places))

    def _lead(
        self,
        number: int,
        deciding: Deciding,
        desired: Desired,
        here: NDArray[np.int64],
        along: NDArray[np.float64],
        aside: NDArray[np.float64],
        within: NDArray[np.bool_],
    ) -> None:
        """Set points and speeds of those deciding people who are ``here`` (indices)."""
        corridor, negotiation = self._corridors[number], self._negotiations[number]
        assert negotiation is not None
        rows, positions = deciding.pedestrians[here], deciding.positions[here]
        courses = self._courses[number, rows]
        going, giving = np.isin(rows, negotiation.going), np.isin(rows, negotiation.giving)
        outside = np.maximum(-along, along - corridor.length)
        held = ~(going | giving | within) & (courses != 0) & (outside < REACH)
        if len(negotiation.giving) == 0:
            held &= courses == -negotiation.sense  # those who go the same way may follow
        points, speeds = desired.points.copy(), desired.speeds.copy()
        # Those who go may have been stopped by other tactics, or sent aside.
        on = here[going | giving]
        paces = deciding.inside.preferred_speeds[
            deciding.inside.places(deciding.pedestrians[on])
        ] * deciding.site.plan.speed_factors(deciding.positions[on])
        speeds[on] = np.where(speeds[on] > 0.0, speeds[on], paces)
        to, wanted = (each[here] - positions for each in (desired.targets.points, points))
        stopped = (to * wanted).sum(axis=1) <= SAME_WAY * np.hypot(*to.T) * np.hypot(*wanted.T)
        stopped &= going
        points[here[stopped]] = desired.targets.points[here[stopped]]
        # They leave niches to those who give way.
        for k in np.flatnonzero(going & within & (len(negotiation.giving) > 0)).tolist():
            points[here[k]] = self._on_way(
                corridor, positions[k], along[k], along[k] + negotiation.sense * REACH
            )
        self._keep_behind(corridor, negotiation, deciding, going, here, along, points, speeds)
        for k in np.flatnonzero(giving).tolist():
            [place] = negotiation.places[negotiation.giving == rows[k]]
            points[here[k]] = self._way_back(corridor, positions[k], along[k], int(place))
            if np.hypot(*(corridor.places[place] - positions[k])) < ARRIVED:
                points[here[k]] = positions[k] + FACING * _unit(to[k])
                speeds[here[k]] = 0.0
        free = np.ones(len(corridor.places), dtype=np.bool_)
        free[negotiation.places] = False
        for k in np.flatnonzero(held).tolist():
            side = free & ((corridor.places_along < 0.0) == (along[k] < 0.0))
            side &= (corridor.places_along < 0.0) | (corridor.places_along > corridor.length)
            if aside[k] >= self.room or not side.any():
                points[here[k]], speeds[here[k]] = positions[k], 0.0
                continue
            away = np.hypot(*(corridor.places - positions[k]).T)
            place = int(np.where(side, away, np.inf).argmin())
            free[place] = False
            points[here[k]] = corridor.places[place]
            speeds[here[k]] = min(speeds[here[k]] or ASIDE, ASIDE)
        desired.points, desired.speeds = points, speeds

    def _keep_behind(
        self,
        corridor: Corridor,
        negotiation: Negotiation,
        deciding: Deciding,
        going: NDArray[np.bool_],
        here: NDArray[np.int64],
        along: NDArray[np.float64],
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> None:
        """Let those who have precedence stop before places to which others still come towards
        them, and keep behind those who go back."""
        where = np.column_stack(
            [self._model.crowd.x[negotiation.giving], self._model.crowd.y[negotiation.giving]]
        )
        at, aside, within = corridor.locate(where)
        goals, sense = corridor.places_along[negotiation.places], negotiation.sense
        coming = within & (sense * (at - goals) > 0.0)
        coming &= aside < corridor.places_aside[negotiation.places] - ENTERED
        nearest = (sense * goals[coming]).min(initial=np.inf)
        before = (sense * along < nearest) & (sense * along > nearest - ROOM_TO_ENTER)
        stop = here[going & before]
        points[stop], speeds[stop] = deciding.positions[stop], 0.0
        on_way = within & (aside < OFF)
        gaps = sense * (at[on_way][None, :] - along[:, None])
        gap = np.where(gaps > 0.0, gaps, np.inf).min(axis=1, initial=np.inf)
        most = np.maximum(gap - self.room, 0.0) / SECONDS_TO_STOP
        speeds[here[going]] = np.minimum(speeds[here[going]], most[going])

    def _way_back(
        self, corridor: Corridor, position: NDArray[np.float64], along: float, place: int
    ) -> NDArray[np.float64]:
        """(2,) where somebody goes next on the way to a place: there, or as far as it can see."""
        goal = corridor.places[place]
        if lines_of_sight(self._model.floor_plan, [position], [goal], self._narrowest)[0]:
            return goal
        return self._on_way(corridor, position, along, float(corridor.places_along[place]))

    def _on_way(
        self, corridor: Corridor, position: NDArray[np.float64], along: float, to: float
    ) -> NDArray[np.float64]:
        """(2,) the point of the way nearest to ``to``, metres along it, that somebody sees."""
        wanted = np.linspace(to, along, max(int(abs(to - along) / LOOK), 1) + 1)
        at = np.searchsorted(corridor.way_along, wanted).clip(max=len(corridor.way) - 1)
        points = corridor.way[at]
        starts = np.tile(position, (len(points), 1))
        seen = lines_of_sight(self._model.floor_plan, starts, points, BERTH * self._narrowest)
        found: NDArray[np.float64] = points[int(seen.argmax())] if seen.any() else points[-1]
        return found


def _unit(way: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) the direction of a way; 0 if there is none."""
    unit: NDArray[np.float64] = way / max(float(np.hypot(*way)), 1e-9)
    return unit
