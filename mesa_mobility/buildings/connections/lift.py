"""Lifts between levels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.connections.lines import Line, line_of, strip, width_of
from mesa_mobility.buildings.level import Level, number_of
from mesa_mobility.errors import FloorPlanError

DOORWAY = 0.1
"""Metres from the floor of a level to the car: the wall of the shaft."""

CALLS = 4.0
"""Metres from the middle of the door within which people call a lift."""

_LEAST_DOOR, _LEAST_CAR = 0.7, 0.8
"""Least clear width of a door, and least width and depth of a car, metres."""


@dataclass(frozen=True)
class Lift:
    """A lift: a car that stops at several levels, with its door at the same place on all of them.

    The car comes to the level where a person has waited longest. It lets in as many people as have
    room. It leaves 3 s after it let in the last of them, or later, when all are in. A person who is
    not in after 20 s waits for the next ride. Each person rides to the level from which their way
    out is shortest. The car does not stop for others in between.

    Args:
        name: unique among the stairs, ramps, escalators, lifts, gates and exits of the building.
        levels: at least two, or their numbers.
        door: two points (x, y) in metres, the first on the left of somebody who walks in. Their
            distance is the clear width.
        capacity: most people in the car. Fewer get in where their bodies do not fit.
        speed: of the car, m/s.
        door_s: seconds in which the doors open, and in which they close.
        width: of the car, metres; at least as wide as the door. The default, with the default
            depth, is that of a car for eight people (EN 81-20, ISO 8100-30).
        depth: of the car, metres.
        everybody: whether people who use stairs use the lift, too. By default only others do, as
            in an evacuation.

    Raises:
        FloorPlanError: numbers out of range, fewer than two levels, or a level twice.
    """

    name: str
    levels: Sequence[Level | int]
    door: Line
    capacity: int = 8
    speed: float = 1.0
    door_s: float = 3.0
    width: float = 1.1
    depth: float = 1.4
    everybody: bool = False

    kind = "lift"
    """How messages and files call it."""

    def __post_init__(self) -> None:
        what = f"lift {self.name!r}"
        object.__setattr__(self, "door", line_of("lift", self.name, "door", self.door))
        numbers = tuple(number_of(each) for each in self.levels)
        object.__setattr__(self, "levels", numbers)
        if len(numbers) < 2 or len(set(numbers)) < len(numbers):
            raise FloorPlanError(f"{what}: expected two levels or more, each once, found {numbers}")
        clear, count = width_of(self.door), self.capacity
        for name, value, least, most, unit in (
            ("a door", round(clear, 3), _LEAST_DOOR, 10.0, "m wide"),
            ("a car", self.width, max(_LEAST_CAR, clear), 10.0, "m wide"),
            ("a car", self.depth, _LEAST_CAR, 10.0, "m deep"),
            ("a speed", self.speed, 0.1, 20.0, "m/s"),
            ("doors that open in", self.door_s, 0.0, 60.0, "s"),
        ):
            if not is_number(value) or not least - 1e-9 <= value <= most:
                raise FloorPlanError(
                    f"{what}: expected {name} {least:g} to {most:g} {unit}, found {value!r:.60}"
                )
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= 100:
            raise FloorPlanError(f"{what}: expected a capacity of 1 to 100, found {count!r:.60}")

    @property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of its levels."""
        return tuple(number_of(each) for each in self.levels)

    @property
    def car(self) -> Polygon:
        """The floor of the car, in the building's coordinates."""
        return self.part(DOORWAY, DOORWAY + self.depth, self.width / 2.0)

    @property
    def shape(self) -> Polygon:
        """The car and its doorway, as wide as the car, in the building's coordinates."""
        return self.part(0.0, DOORWAY + self.depth, self.width / 2.0)

    def part(self, first: float, last: float, half: float) -> Polygon:
        """The rectangle from ``first`` to ``last`` metres behind the door.

        Args:
            first: metres; below 0 before the door.
            last: metres.
            half: half its width, metres.
        """
        return strip(self.door, first, last, half)
