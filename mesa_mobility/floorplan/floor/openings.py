"""Gates and exits: the straight lines that people cross."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from shapely import LineString

from mesa_mobility.errors import FloorPlanError


@dataclass(frozen=True)
class Opening:
    """A straight line from `a` to `b` (x, y in metres) with a name.

    Raises FloorPlanError for an empty name, ends that are not two finite
    numbers, or ends that coincide.
    """

    name: str
    a: tuple[float, float]
    b: tuple[float, float]

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise FloorPlanError(
                f"{self.kind} name must be a text of at least one letter, found {self.name!r}"
            )
        for end in ("a", "b"):
            object.__setattr__(self, end, self._point(end, getattr(self, end)))
        if self.length == 0.0:
            raise FloorPlanError(
                f"{self.kind} {self.name!r} has no length: a and b are both {self.a}"
            )

    @property
    def kind(self) -> str:
        """The word for this kind of opening: `gate` or `exit`."""
        return type(self).__name__.lower()

    @property
    def length(self) -> float:
        """Width of the opening in metres."""
        return math.hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])

    @property
    def midpoint(self) -> tuple[float, float]:
        """The middle of the line, (x, y) in metres."""
        return ((self.a[0] + self.b[0]) / 2, (self.a[1] + self.b[1]) / 2)

    @property
    def line(self) -> LineString:
        """The line as a shapely geometry."""
        return LineString([self.a, self.b])

    def _point(self, end: str, value: Sequence[float]) -> tuple[float, float]:
        try:
            if any(isinstance(coordinate, str | bool) for coordinate in value):
                raise TypeError
            x, y = (float(coordinate) for coordinate in value)
        except (TypeError, ValueError, OverflowError):
            raise FloorPlanError(
                f"{self.kind} {self.name!r}: {end} must be two numbers (x, y), found {value!r}"
            ) from None
        if not (math.isfinite(x) and math.isfinite(y)):
            raise FloorPlanError(
                f"{self.kind} {self.name!r}: {end} must be finite, found ({x}, {y})"
            )
        return (x, y)


@dataclass(frozen=True)
class Gate(Opening):
    """A door, or another line inside the plan, that people cross and walk on."""


@dataclass(frozen=True)
class Exit(Opening):
    """A way out on the edge of the plan: people leave the model when they cross its line."""
