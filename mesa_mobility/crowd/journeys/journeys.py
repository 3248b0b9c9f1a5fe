"""Journeys: people cross gates and visit places in a given order, then leave or start over.

When a pedestrian decides, the gates that they have crossed are found from the path that they have
just walked, and a place is reached if they decide at it. Between decisions nothing has to be
checked, and people without a journey cost nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.crossings import find_crossings
from mesa_mobility.crowd.journeys.place import Place
from mesa_mobility.crowd.journeys.stays import Stays
from mesa_mobility.crowd.journeys.visit import Route, Visit
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import FARTHEST, Crowd
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.schema import (
    Array,
    Each,
    Either,
    Flag,
    Kind,
    Maybe,
    Members,
    Object,
    Several,
    Text,
    Whole,
    check,
    check_shape,
)


@dataclass(frozen=True)
class Journey:
    """The gates and places of one route.

    Attributes:
        stops: names of the gates, and the places to visit, in order.
        loop: whether the first stop follows the last.
        body: index of the core radius of those who go there.
        legs: destination number of each leg.  Unless it is a loop, one more leg leads from the last
            stop to the exits.
        lines: (legs, 4) line of the gate that ends each leg, metres; nan for places and exits. Of a
            gate of a seam it is that on its own sheet; its copy on the other sheet counts as well.
    """

    stops: tuple[str | Visit, ...]
    loop: bool
    body: int
    legs: NDArray[np.int32]
    lines: NDArray[np.float64]


_STOP = Either(Object(Visit), Text("gates"))


class Journeys(Saved):
    """The journeys of a model's people.

    Attributes:
        crossed: gates that all people together have crossed so far, and places they have visited.
        stays: who is at a place of their route.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_numbers": Several(
            Each(
                Several(_STOP, tuple),
                Flag(),
                Maybe(Several(Text("exits"), tuple)),
                Whole(below="bodies"),
            ),
            dict,
            values=Whole(1),
        ),
        "crossed": Whole(),
    }

    def __init__(self, plan: FloorPlan, site: Environment) -> None:
        self._plan = plan
        self._site = site
        self._known: list[Journey] = []
        self._places: list[tuple[Visit, int, Place]] = []
        # Numbers of the same place for people of other core radii, after its own.
        self._alike: list[list[int]] = []
        self.stays = Stays()
        self._take_stock()
        self._numbers: dict[tuple[object, ...], int] = {}
        self.crossed = 0

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        known = Each(
            Several(_STOP, tuple),
            Flag(),
            Whole(below="bodies"),
            Array("i4", ("legs",), 0, below="destinations"),
            Array("f8", ("legs", 4), -FARTHEST, FARTHEST, missing=True),
        )
        stays = Members(self.stays.members())
        return {**self.saved, "known": Several(known), "stays": stays}

    def state(self) -> dict[str, Any]:
        """The journeys, who stays where, and how many gates have been crossed."""
        known = [tuple(vars(each).values()) for each in self._known]
        return {**super().state(), "known": known, "stays": self.stays.state()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        self.stays.restore(state["stays"])
        self._known = [Journey(*each) for each in state["known"]]
        most = max(self._numbers.values(), default=0)
        check(most, Whole(high=len(self._known)), "_numbers")
        for each in self._known:
            legs = (len(each.stops) + (not each.loop),)
            check_shape(each.legs.shape, legs, "known, legs", {})
        self._places.clear()
        self._alike.clear()
        self._take_stock()
        check(self.stays.places, Array("i8", low=-1, high=len(self._places) - 1), "stays, _place")

    def __len__(self) -> int:
        return len(self._known)

    def add(self, route: Route, loop: bool, exits: tuple[str, ...] | None, kind: int) -> int:
        """Number, above 0, of this route for people of one pedestrian type.

        Raises:
            ModelError: not a list of gates and places, one of them twice in a row, or a loop that
                ends at exits.
            FloorPlanError: an unknown gate, a place without room, or no way from one to the next.
        """
        stops, body = tuple(route), self._site.body(kind)
        key = stops, loop, exits, body
        if key in self._numbers:
            return self._numbers[key]
        if isinstance(route, str) or not all(isinstance(each, str | Visit) for each in stops):
            raise ModelError(f"route: got {route!r}, expected a list of names of gates and visits")
        following = [*stops[1:], stops[0]] if loop else stops[1:]
        for one, next_one in zip(stops, following, strict=False):
            if one == next_one:
                what = str(one) if isinstance(one, Visit) else f"gate {one!r}"
                raise ModelError(f"route: {what} follows itself, expected another one next")
        if loop and exits is not None:
            raise ModelError("exits: got some for a route that goes round for ever, expected none")
        legs = [self._leg(stop, kind) for stop in stops]
        if not loop:
            legs.append(self._site.destination(exits, kind))
        for leg, next_leg in zip(legs, [*legs[1:], legs[0]] if loop else legs[1:], strict=False):
            self._site.check_way_on(leg, next_leg)
        lines = [self._line(stop) for stop in stops]
        self._known.append(
            Journey(
                stops=stops,
                loop=loop,
                body=body,
                legs=np.array(legs, dtype=np.int32),
                lines=np.array([*lines, *[(np.nan,) * 4] * (not loop)]),
            )
        )
        self._take_stock()
        self._numbers[key] = len(self._known)
        return len(self._known)

    def start(
        self, exits: Sequence[str] | None, route: Route, loop: bool, type_index: int
    ) -> tuple[int, int]:
        """Numbers of the first destination and of the journey, 0 for none.

        Args:
            exits: names of the exits by which people leave; None stands for all.
            route: the gates that they cross before, and the places that they visit.
            loop: whether they start over after the last of these.
            type_index: index of their type.

        Raises:
            ModelError: see ``add``.
            FloorPlanError: an unknown exit or gate, or no way from one to the next.
        """
        names = None if exits is None else tuple(exits)
        if not len(route):
            return self._site.destination(names, type_index), 0
        number = self.add(route, loop, names, type_index)
        return int(self._known[number - 1].legs[0]), number

    def stops(self, number: int) -> tuple[str | Visit, ...]:
        """Names of the gates, and the places, of the journey with this number, in order."""
        return self._known[number - 1].stops if number else ()

    def next_stop(self, row: int, crowd: Crowd) -> str | Visit | None:
        """The gate or place to which somebody goes now, or at which they stay; None for exits."""
        number, crossed = (int(crowd.agenda[name][row]) for name in ("journey", "crossed"))
        if not number:
            return None
        journey = self._known[number - 1]
        over = crossed >= len(journey.stops) and not journey.loop
        return None if over else journey.stops[crossed % len(journey.stops)]

    def beyond(self, row: int, gate: str, crowd: Crowd) -> int:
        """Number of somebody's destination once they have crossed a gate: if that is their next
        stop, the one after it."""
        leg = int(self._now(np.array([row]), crowd)[0])
        if self.next_stop(row, crowd) != gate:
            return int(crowd.destination[row])
        number = int(crowd.agenda["journey"][row])
        first, count = int(self._firsts[number]), int(self._counts[number])
        return int(self._legs[first + (leg + 1 - first) % count])

    def to_stay(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.bool_]:
        """(n,) whether each in ``rows`` is bound for a place at which they stay, or is there."""
        if not self._places:
            return np.zeros(len(rows), dtype=bool)
        found: NDArray[np.bool_] = self._to_stay[self._now(rows, crowd)]
        return found

    def exits(self, number: int) -> tuple[str, ...]:
        """Names of the exits at the end of the journey with this number; none if it is a loop."""
        journey = self._known[number - 1]
        return () if journey.loop else self._site.exits(int(journey.legs[-1]))

    def endless(self, rows: NDArray[np.int64], crowd: Crowd) -> bool:
        """Whether the journey of somebody in ``rows`` is a loop."""
        numbers = np.unique(crowd.agenda["journey"][rows]).tolist()
        return any(number > 0 and self._known[number - 1].loop for number in numbers)

    def _take_stock(self) -> None:
        """Lay out the legs of all journeys one after the other."""
        none = Journey((), False, 0, np.zeros(1, dtype=np.int32), np.full((1, 4), np.nan))
        known = [none, *self._known]
        self._counts = np.array([len(each.legs) for each in known], dtype=np.int64)
        self._firsts = np.cumsum(self._counts) - self._counts
        self._legs = np.concatenate([each.legs for each in known])
        lines = np.concatenate([each.lines for each in known])
        copies = np.full_like(lines, np.nan)
        # Index of the place at the end of each leg, -1 for gates and exits.
        self._place_of = np.full(len(self._legs), -1, dtype=np.int64)
        # Whether people stay at the end of each leg.
        self._to_stay = np.zeros(len(self._legs), dtype=bool)
        for journey, first in zip(known, self._firsts.tolist(), strict=True):
            for k, stop in enumerate(journey.stops):
                if isinstance(stop, Visit):
                    self._place_of[first + k] = self._place(stop, journey.body)
                    self._to_stay[first + k] = stop.stay != 0.0
                else:
                    for copy in self._plan.drawings(stop)[1:]:
                        copies[first + k] = *copy.a, *copy.b
        # On which lines of gates crossings are looked for.
        self._drawn = [lines, copies][: 1 + bool(np.isfinite(copies).any())]

    def _place(self, visit: Visit, body: int) -> int:
        """Index of a place for people of one core radius."""
        alike = []
        for number, (known, whose, _) in enumerate(self._places):
            if known == visit:
                if whose == body:
                    return number
                alike.append(number)
        place, own = Place(self._plan, visit, self._site.core_radius(body)), len(self._places)
        for number in alike:
            self._alike[number].append(own)
        self._places.append((visit, body, place))
        self._alike.append([own, *alike])
        return own

    def _leg(self, stop: str | Visit, kind: int) -> int:
        """Number of the destination of a stop."""
        if isinstance(stop, str):
            return self._site.crossing(self._plan.drawings(stop)[0].name, kind)
        place = self._places[self._place(stop, self._site.body(kind))][2]
        return self._site.point(place.way_point(), kind)

    def _line(self, stop: str | Visit) -> tuple[float, ...]:
        """(4,) the line of a gate, metres; nan for a place."""
        if isinstance(stop, Visit):
            return (np.nan,) * 4
        gate = self._plan.drawings(stop)[0]
        return *gate.a, *gate.b

    def _now(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) index of each person's current leg among the legs of all journeys."""
        journey, crossed = crowd.agenda["journey"][rows], crowd.agenda["crossed"][rows]
        legs: NDArray[np.int64] = self._firsts[journey] + crossed % self._counts[journey]
        return legs

    def advance(
        self,
        rows: NDArray[np.int64],
        frame: int,
        crowd: Crowd,
        table: OptionTable,
        rng: np.random.Generator,
    ) -> None:
        """Send those in ``rows`` who have crossed their gate, or stayed at their place, to the next
        one."""
        if not self._known:
            return
        agenda = crowd.agenda
        on = rows[agenda["journey"][rows] > 0]
        stayed = self._stayed(on, frame, crowd, rng)
        while len(on):
            legs, when = self._now(on, crowd), np.full(len(on), np.inf)
            for lines in self._drawn:
                found = np.full(len(on), np.inf)
                since = agenda["checked"][on]
                find_crossings(on, lines[legs], frame, since, table, crowd.records, found)
                when = np.minimum(when, found)
            over = np.isfinite(when)
            agenda["checked"][on] = np.where(over, when, frame)
            if len(stayed):
                over |= np.isin(on, stayed)
                agenda["nearest"][stayed] = np.inf
                stayed = stayed[:0]
            on = on[over]
            agenda["crossed"][on] += 1
            self.crossed += len(on)
            crowd.destination[on] = self._legs[self._now(on, crowd)]

    def _stayed(
        self, on: NDArray[np.int64], frame: int, crowd: Crowd, rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """(k,) rows of those ``on`` a journey whose stay at a place is over."""
        if not self._places or len(on) == 0:
            return on[:0]
        numbers = self._place_of[self._now(on, crowd)]
        over = []
        for row, number in zip(on.tolist(), numbers.tolist(), strict=True):
            if number >= 0:
                place = self._places[number][2]
                if self.stays.over(row, self._alike[number], place, frame, crowd, rng):
                    over.append(row)
        return np.array(over, dtype=np.int64)
