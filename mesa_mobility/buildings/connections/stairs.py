"""Stairs between two levels."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.connections.flights import (
    BOTH,
    HANDRAILS,
    Flight,
    Landing,
    speed_factor,
)
from mesa_mobility.buildings.connections.lines import Line, line_of, pair, width_of
from mesa_mobility.buildings.level import Level, number_of, sheet_of
from mesa_mobility.errors import FloorPlanError

STRAIGHT, DOG_LEG, FLIGHTS = SHAPES = "straight", "dog_leg", "flights"

ON, LEFT, RIGHT = TURNS = "on", "left", "right"
"""Ways on from a landing, as seen by somebody who walks down."""

_BACK = {LEFT: "back left", RIGHT: "back right"}

MOST_FLIGHTS = 20

LEAST_RISERS = 3
"""Least risers of one of several flights."""

NEWEL = 0.1
"""Metres from the foot of a flight to the head of the next, round the corner of a landing: the post
of the handrail."""

LEAST_WIDTH = 0.6
"""Least clear width of stairs, metres."""

RISERS = 0.10, 0.22
"""Least and greatest height of a riser, metres."""

TREADS = 0.20, 0.60
"""Least and greatest depth of a tread, metres."""

_ROUNDING = 1e-9
"""Metres."""


@dataclass(frozen=True)
class Stairs:
    """Stairs from one level down to another; `straight`, `dog_leg` and `of_flights` make them.

    The width of a flight is the clear width between its handrails, where building rules measure it.
    Handrails stand beside it and take nothing of it. They are drawn in three dimensions. People do
    not hold them. The effective width of the SFPE Handbook, 0.15 m less at each side, is not taken
    off.

    Args:
        name: unique among the stairs, ramps, escalators, lifts, gates and exits of the building.
        upper: number of the level from which they lead down.
        lower: number of the level to which they lead.
        head: their upper edge, two points (x, y) in metres on the upper level, the first on the
            left of somebody who walks down. Its length is the clear width.
        risers: number of all risers.
        tread: depth of a tread, metres.
        shape: "straight" for one flight, "dog_leg" for two, side by side, with a landing between,
            "flights" for several with landings on which the way turns by a right angle or not.
        turn: "left" or "right", where a dog-leg turns on the way down.
        well: metres between the flights of a dog-leg.
        landing: depth of its landing, or of landings straight on, metres; by default the clear
            width.
        flights: risers of each flight of the shape "flights", from the top.
        turns: "on", "left" or "right": the way on from each of its landings, from the top.
        handrails: the sides of each flight that have a handrail, as seen by somebody who walks
            down: "both", "left", "right" or "none".

    Raises:
        FloorPlanError: numbers out of range, or another shape, turn or side of handrails.
    """

    name: str
    upper: int
    lower: int
    head: Line
    risers: int
    tread: float = 0.29
    shape: str = STRAIGHT
    turn: str = "left"
    well: float = 0.2
    landing: float | None = None
    flights: tuple[int, ...] = ()
    turns: tuple[str, ...] = ()
    handrails: str = BOTH

    @classmethod
    def straight(
        cls,
        name: str,
        upper: Level | int,
        lower: Level | int,
        head: Sequence[Sequence[float]],
        *,
        risers: int,
        tread: float = 0.29,
        handrails: str = BOTH,
    ) -> Self:
        """Stairs of one straight flight; see the class for the arguments."""
        return cls(
            name,
            number_of(upper),
            number_of(lower),
            line_of("stairs", name, "head", head),
            risers,
            tread,
            handrails=handrails,
        )

    @classmethod
    def dog_leg(
        cls,
        name: str,
        upper: Level | int,
        lower: Level | int,
        head: Sequence[Sequence[float]],
        *,
        risers: int,
        tread: float = 0.29,
        turn: str = "left",
        well: float = 0.2,
        landing: float | None = None,
        handrails: str = BOTH,
    ) -> Self:
        """Stairs of two flights side by side, which lead in opposite directions, and a landing.

        Of an odd number of risers the lower flight has one more. See the class for the arguments.
        """
        return cls(
            name,
            number_of(upper),
            number_of(lower),
            line_of("stairs", name, "head", head),
            risers,
            tread,
            DOG_LEG,
            turn,
            well,
            landing,
            handrails=handrails,
        )

    @classmethod
    def of_flights(
        cls,
        name: str,
        upper: Level | int,
        lower: Level | int,
        head: Sequence[Sequence[float]],
        *,
        risers: Sequence[int],
        turns: Sequence[str],
        tread: float = 0.29,
        landing: float | None = None,
        handrails: str = BOTH,
    ) -> Self:
        """Stairs of several flights with landings between: straight on, quarter turns, or both.

        Four flights that all turn the same way lead once round a square well, as spiral stairs do.

        Args:
            risers: those of each flight, from the top.
            turns: "on", "left" or "right" for each landing, from the top.

        See the class for the other arguments.
        """
        flights = tuple(risers)
        known = all(isinstance(each, int) for each in flights)
        return cls(
            name,
            number_of(upper),
            number_of(lower),
            line_of("stairs", name, "head", head),
            sum(flights) if known else 0,
            tread,
            FLIGHTS,
            landing=landing,
            flights=flights,
            turns=tuple(turns),
            handrails=handrails,
        )

    kind = "stairs"
    """How messages and files call it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "head", line_of("stairs", self.name, "head", self.head))
        least = 2 if self.shape == STRAIGHT else 4
        if (
            not isinstance(self.risers, int)
            or isinstance(self.risers, bool)
            or not (least <= self.risers <= 200)
        ):
            self._refuse(f"{least} to 200 risers", self.risers)
        if not is_number(self.tread) or not TREADS[0] <= self.tread <= TREADS[1]:
            self._refuse(f"treads of {TREADS[0]} to {TREADS[1]} m", self.tread)
        if self.width < LEAST_WIDTH:
            self._refuse(f"a clear width of {LEAST_WIDTH} m or more", round(self.width, 3))
        if self.shape not in SHAPES:
            self._refuse(f"one of the shapes {', '.join(SHAPES)}", self.shape)
        self._check_flights()
        if self.turn not in (LEFT, RIGHT):
            self._refuse("a turn to the 'left' or 'right'", self.turn)
        if not is_number(self.well) or not 0.1 <= self.well <= 10.0:
            self._refuse("0.1 to 10 m between its flights", self.well)
        deep = self.landing
        if deep is not None and not (is_number(deep) and LEAST_WIDTH <= deep <= 10.0):
            self._refuse(f"a landing {LEAST_WIDTH} to 10 m deep", deep)
        if self.handrails not in HANDRAILS:
            self._refuse(f"handrails {', '.join(HANDRAILS)}", self.handrails)

    def _check_flights(self) -> None:
        """Raise FloorPlanError unless flights and turns are those of the shape."""
        flights, turns = self.flights, self.turns
        if self.shape != FLIGHTS:
            if flights or turns:
                self._refuse(f"flights and turns of the shape {FLIGHTS!r} alone", flights or turns)
            return
        if not 2 <= len(flights) <= MOST_FLIGHTS or not all(
            isinstance(each, int) and not isinstance(each, bool) and each >= LEAST_RISERS
            for each in flights
        ):
            self._refuse(f"2 to {MOST_FLIGHTS} flights of {LEAST_RISERS} risers or more", flights)
        if sum(flights) != self.risers:
            self._refuse(f"flights with {self.risers} risers in all", flights)
        if len(turns) != len(flights) - 1 or not all(each in TURNS for each in turns):
            self._refuse(f"a turn {', '.join(TURNS)} between each two flights", turns)

    @property
    def width(self) -> float:
        """Clear width, metres."""
        return width_of(self.head)

    def parts(self, top: float, bottom: float) -> tuple[list[Flight], list[Landing]]:
        """The flights, from the top, and the landings between them.

        Args:
            top: elevation of the upper level, metres.
            bottom: elevation of the lower level, metres.

        Raises:
            FloorPlanError: the rise does not fit the number of risers.
        """
        riser = (top - bottom) / self.risers
        if not RISERS[0] - _ROUNDING <= riser <= RISERS[1] + _ROUNDING:
            raise FloorPlanError(
                f"stairs {self.name!r}: {self.risers} risers for a rise of {top - bottom:g} m are "
                f"{riser:.3f} m each, expected {RISERS[0]:.2f} to {RISERS[1]:.2f} m"
            )
        factor, counts, turns = speed_factor(riser, self.tread), self.flights, self.turns
        if self.shape == STRAIGHT:
            counts = (self.risers,)
        elif self.shape == DOG_LEG:
            counts, turns = (self.risers // 2, (self.risers + 1) // 2), (_BACK[self.turn],)
        flights, landings = list[Flight](), list[Landing]()
        head, above, sheet = self.head, top, sheet_of(self.upper)
        for k, count in enumerate(counts):
            left = len(counts) - k
            name = f"{self.name} {left}" if len(counts) > 1 else self.name
            below = top - riser * sum(counts[: k + 1]) if left > 1 else bottom
            beyond = sheet_of(self.lower)
            if left > 1:
                number = f" {left - 1}" if len(counts) > 2 else ""
                beyond = f"landing{number} of {self.name}"
            flights.append(
                Flight(
                    name=name,
                    head=head,
                    going=(count - 1) * self.tread,
                    top=above,
                    bottom=below,
                    upper=sheet,
                    lower=beyond,
                    factor=factor,
                    risers=count,
                    tread=self.tread,
                    handrails=self.handrails,
                )
            )
            if left > 1:
                head, area = self._landing_behind(flights[-1], turns[k])
                landings.append(Landing(beyond, area, below))
            above, sheet = below, beyond
        return flights, landings

    def _landing_behind(self, flight: Flight, turn: str) -> tuple[Line, Polygon]:
        """The head of the flight that follows a landing, and the landing."""
        left, right = (np.array(each) for each in flight.foot)
        across, width = (left - right) / self.width, self.width
        deep, ends = self.landing or width, (right, left)
        if turn == ON:
            head = left + deep * flight.down, right + deep * flight.down
        elif turn in (LEFT, RIGHT):
            deep = NEWEL + width
            near, far = NEWEL * flight.down, deep * flight.down
            head = (left + near, left + far) if turn == LEFT else (right + far, right + near)
        elif turn == _BACK[LEFT]:
            head = left + self.well * across, left + (self.well + width) * across
            ends = right, head[1]
        else:
            head = right - (self.well + width) * across, right - self.well * across
            ends = head[0], left
        away = deep * flight.down
        area = Polygon([*ends, ends[1] + away, ends[0] + away])
        return (pair(head[0]), pair(head[1])), area

    def _refuse(self, expected: str, found: object) -> None:
        raise FloorPlanError(f"stairs {self.name!r}: expected {expected}, found {found!r:.60}")
