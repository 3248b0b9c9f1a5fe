"""Ramps between two levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.connections.flights import Flight, Landing
from mesa_mobility.buildings.connections.lines import Line, line_of, width_of
from mesa_mobility.buildings.level import Level, number_of, sheet_of
from mesa_mobility.errors import FloorPlanError

LEAST_WIDTH = 0.8
"""Least clear width of a ramp, metres: a wheelchair has to pass."""

STEEPEST = 0.25
"""Greatest rise of a ramp, metres for each metre in plan."""

_LENGTHS = 0.5, 200.0
"""Least and greatest length of a ramp, metres."""


@dataclass(frozen=True)
class Ramp:
    """A ramp from one level down to another, which everybody uses; `straight` makes it.

    Args:
        name: unique among the stairs, ramps, escalators, lifts, gates and exits of the building.
        upper: number of the level from which it leads down.
        lower: number of the level to which it leads.
        head: its upper edge, two points (x, y) in metres on the upper level, the first on the left
            of somebody who walks down. Its length is the clear width.
        length: metres from its upper to its lower edge, in plan.
        factor: the share of their speed on a level floor at which people walk. By default they
            walk as fast: the SFPE Handbook (chapter on employing the hydraulic model) gives the
            same speed for ramps as for corridors.

    Raises:
        FloorPlanError: numbers out of range.
    """

    name: str
    upper: int
    lower: int
    head: Line
    length: float
    factor: float = 1.0

    kind = "ramp"
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
        factor: float = 1.0,
    ) -> Self:
        """A straight ramp; see the class for the arguments."""
        line = line_of("ramp", name, "head", head)
        return cls(name, number_of(upper), number_of(lower), line, length, factor)

    def __post_init__(self) -> None:
        what = f"ramp {self.name!r}"
        object.__setattr__(self, "head", line_of("ramp", self.name, "head", self.head))
        for name, value, least, most, unit in (
            ("a clear width of", round(self.width, 9), LEAST_WIDTH, 100.0, " m"),
            ("a length of", self.length, *_LENGTHS, " m"),
            ("a factor of", self.factor, 0.05, 1.0, ""),
        ):
            if not is_number(value) or not least <= value <= most:
                raise FloorPlanError(
                    f"{what}: expected {name} {least:g} to {most:g}{unit}, found {value!r:.60}"
                )

    @property
    def width(self) -> float:
        """Clear width, metres."""
        return width_of(self.head)

    def parts(self, top: float, bottom: float) -> tuple[list[Flight], list[Landing]]:
        """The flight, and no landings.

        Args:
            top: elevation of the upper level, metres.
            bottom: elevation of the lower level, metres.

        Raises:
            FloorPlanError: it does not lead down, or is too steep.
        """
        slope = (top - bottom) / self.length
        if not 0.0 < slope <= STEEPEST:
            raise FloorPlanError(
                f"ramp {self.name!r}: {top - bottom:g} m down over {self.length:g} m is a slope of "
                f"{slope:.3f}, expected more than 0 and {STEEPEST:g} at most"
            )
        upper, lower = sheet_of(self.upper), sheet_of(self.lower)
        flight = Flight(self.name, self.head, self.length, top, bottom, upper, lower, self.factor)
        return [flight], []
