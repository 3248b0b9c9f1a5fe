"""Escalators between two levels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.connections.flights import Flight, Landing, speed_factor
from mesa_mobility.buildings.connections.lines import Line, line_of, width_of
from mesa_mobility.buildings.level import Level, number_of, sheet_of
from mesa_mobility.errors import FloorPlanError

UP, DOWN = "up", "down"

SLOPES = 10.0, 35.0
"""Least and greatest inclination, degrees. EN 115-1 allows 35 degrees up to 0.5 m/s and 6 m of
rise, otherwise 30."""

STEP = 0.4
"""Metres along the slope from one step to the next, by which EN 115-1 counts people."""

_LEAST_BELT = 1.5
"""Least metres of an escalator in plan: people step on and off within a step each."""


@dataclass(frozen=True)
class Escalator:
    """An escalator from one level to another, on which people stand; `straight` makes it.

    Its speed is the nominal speed of EN 115-1: that of the steps in the direction in which they
    move, along the slope. In plan people are slower by the cosine of the inclination.

    Args:
        name: unique among the stairs, ramps, escalators, lifts, gates and exits of the building.
        upper: number of the upper level.
        lower: number of the lower level.
        head: its upper edge, two points (x, y) in metres on the upper level, the first on the left
            of somebody who looks down it. Its length is the width of the steps.
        length: metres from its upper to its lower edge, in plan.
        direction: "up" or "down", the way that it carries people; nobody walks the other way.
        speed: along the slope, 0.1 to 1 m/s; EN 115-1 has 0.5, 0.65 and 0.75 m/s. An escalator of
            speed 0 stands: people walk on it both ways, as on stairs with the same steps.
        capacity: people an hour whom it takes at most. The default is one person on each step 1 m
            wide, and in proportion for other widths: 6,750 at 0.75 m/s and 1 m. The nominal 13,500
            is not reached in practice.

    Raises:
        FloorPlanError: numbers out of range, or another direction.
    """

    name: str
    upper: int
    lower: int
    head: Line
    length: float
    direction: str = DOWN
    speed: float = 0.75
    capacity: float | None = None

    kind = "escalator"
    """How messages and files call it."""

    @classmethod
    def straight(
        cls,
        name: str,
        upper: Level | int,
        lower: Level | int,
        head: Sequence[Sequence[float]],
        *,
        length: float,
        direction: str = DOWN,
        speed: float = 0.75,
        capacity: float | None = None,
    ) -> Self:
        """A straight escalator; see the class for the arguments."""
        line = line_of("escalator", name, "head", head)
        ends = number_of(upper), number_of(lower)
        return cls(name, *ends, line, length, direction, speed, capacity)

    def __post_init__(self) -> None:
        object.__setattr__(self, "head", line_of(self.kind, self.name, "head", self.head))
        count = self.capacity
        if self.direction not in (UP, DOWN):
            self._refuse(f"the direction {UP!r} or {DOWN!r}", self.direction)
        for name, value, least, most, unit in (
            ("a width of", round(self.width, 9), 0.58, 1.1, " m"),
            ("a length of", self.length, _LEAST_BELT, 200.0, " m"),
            ("a speed of 0, or", 0.1 if self.speed == 0.0 else self.speed, 0.1, 1.0, " m/s"),
            ("a capacity of", 1.0 if count is None else count, 1.0, 20_000.0, " people an hour"),
        ):
            if not is_number(value) or not least <= value <= most:
                self._refuse(f"{name} {least:g} to {most:g}{unit}", value)

    @property
    def width(self) -> float:
        """Width of the steps, metres."""
        return width_of(self.head)

    @property
    def gap_s(self) -> float:
        """Least mean time in seconds from one person who steps on to the next, if it moves."""
        if self.capacity is not None:
            return 3600.0 / self.capacity
        return STEP / (self.speed * self.width)

    def parts(self, top: float, bottom: float) -> tuple[list[Flight], list[Landing]]:
        """The flight, and no landings.

        Args:
            top: elevation of the upper level, metres.
            bottom: elevation of the lower level, metres.

        Raises:
            FloorPlanError: it does not lead down, or is too flat or too steep.
        """
        rise = top - bottom
        angle = math.degrees(math.atan2(rise, self.length))
        if not SLOPES[0] <= angle <= SLOPES[1]:
            raise FloorPlanError(
                f"escalator {self.name!r}: {rise:g} m down over {self.length:g} m is an "
                f"inclination of {angle:.1f} degrees, expected {SLOPES[0]:g} to {SLOPES[1]:g}"
            )
        slope = math.hypot(rise, self.length)
        risers = max(round(slope / STEP), 2)
        tread = self.length / (risers - 1)
        ends = sheet_of(self.upper), sheet_of(self.lower)
        if not self.speed:
            factor = speed_factor(rise / risers, tread)
            return [
                Flight(self.name, self.head, self.length, top, bottom, *ends, factor, risers, tread)
            ], []
        moves = self.speed * self.length / slope * (1.0 if self.direction == DOWN else -1.0)
        own = Flight(
            self.name,
            self.head,
            self.length,
            top,
            bottom,
            *ends,
            1.0,
            risers,
            tread,
            moves=moves,
            gap_s=self.gap_s,
        )
        return [own], []

    def _refuse(self, expected: str, found: object) -> None:
        raise FloorPlanError(f"escalator {self.name!r}: expected {expected}, found {found!r:.60}")
