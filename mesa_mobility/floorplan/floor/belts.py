"""Belts: the moving steps of escalators, which carry people over a seam of a floor plan."""

from dataclasses import dataclass

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError

_FASTEST = 5.0
"""Metres a second."""


@dataclass(frozen=True)
class Belt:
    """A belt that carries people over a seam, whose line is at its middle.

    Args:
        speed: of the belt in plan, m/s: above 0 from the first sheet to the second, below 0 back.
        length: metres in plan from where people step on to where they step off.
        gap_s: least mean time in seconds from one person who steps on to the next.

    Raises:
        FloorPlanError: numbers out of range.
    """

    speed: float
    length: float
    gap_s: float

    def __post_init__(self) -> None:
        if not is_number(self.speed) or not 0.0 < abs(self.speed) <= _FASTEST:
            raise FloorPlanError(
                f"belt: speed must be m/s, not 0 and {_FASTEST:g} at most, found {self.speed!r:.60}"
            )
        for name, value in (("length", self.length), ("gap_s", self.gap_s)):
            if not is_number(value) or not 0.0 < value < float("inf"):
                raise FloorPlanError(f"belt: {name} must be above 0, found {value!r:.60}")

    @property
    def way(self) -> int:
        """1 from the first sheet of the seam to the second, -1 back."""
        return 1 if self.speed > 0.0 else -1
