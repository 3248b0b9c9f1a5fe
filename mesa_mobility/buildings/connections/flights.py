"""Flights, which lead from one level or landing down to another, and landings."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility.buildings.connections.lines import Line, moved, right_angle, strip, width_of

UPWARDS = 0.8
"""Speed up stairs as a share of that down: 0.8 and 1.0 m/s in IMO MSC.1/Circ.1533. The speeds of
Fruin (1971) give 0.71 to 0.77, by age."""

_FLAT = 1.40
"""Speed on a level floor without others, m/s: SFPE Handbook, chapter on employing the hydraulic
model."""

_ON_STAIRS = 0.861
"""Speed along the slope of stairs without others, m/s, where treads are as deep as risers are high;
it grows with the root of their ratio. The same: 1.00, 1.08, 1.16 and 1.23 m/s on stairs of 7.5/10,
7/11, 6.5/12 and 6.5/13 inches."""

BOTH, NONE = "both", "none"

HANDRAILS = BOTH, "left", "right", NONE
"""Sides of a flight that have a handrail, as seen by somebody who walks down."""


def speed_factor(riser: float, tread: float) -> float:
    """The share of their speed on a level floor at which people cover ground down stairs.

    It is for ground as a plan shows it. The SFPE Handbook does not tell down from up; see
    ``Flight.uphill``.

    Args:
        riser: height of a riser, metres.
        tread: depth of a tread, metres.
    """
    along_slope = min(_ON_STAIRS * math.sqrt(tread / riser) / _FLAT, 1.0)
    return along_slope * tread / math.hypot(tread, riser)


@dataclass(frozen=True)
class Flight:
    """A flight of stairs, a ramp or an escalator.

    Attributes:
        name: unique in the building.
        head: its upper edge, (left, right) as seen by somebody who walks down.
        going: metres from its upper to its lower edge, in plan.
        top: elevation of the upper edge, metres.
        bottom: elevation of the lower edge, metres.
        upper: name of the sheet from which it leads down.
        lower: name of the sheet to which it leads.
        factor: the share of their speed on a level floor at which people walk down.
        risers: number of its risers; 0 for a ramp.
        tread: depth of a tread, metres; 0 for a ramp.
        moves: m/s in plan at which its treads carry people down, below 0 up; 0 for all but
            escalators.
        gap_s: least mean time in seconds from one person who steps on an escalator to the next.
        handrails: the sides that have a handrail beside the clear width, one of `HANDRAILS`.
    """

    name: str
    head: Line
    going: float
    top: float
    bottom: float
    upper: str
    lower: str
    factor: float
    risers: int = 0
    tread: float = 0.0
    moves: float = 0.0
    gap_s: float = 0.0
    handrails: str = NONE

    @property
    def width(self) -> float:
        """Clear width, metres."""
        return width_of(self.head)

    @property
    def down(self) -> NDArray[np.float64]:
        """(2,) unit vector in which people walk down."""
        return right_angle(self.head)

    @property
    def foot(self) -> Line:
        """Its lower edge, (left, right) as seen by somebody who walks down."""
        return moved(self.head, self.going * self.down)

    @property
    def riser(self) -> float:
        """Height of a riser, metres; 0 for a ramp."""
        return (self.top - self.bottom) / self.risers if self.risers else 0.0

    @property
    def uphill(self) -> float:
        """The share of their speed on a level floor at which people walk up."""
        return UPWARDS * self.factor if self.risers and not self.moves else self.factor

    @property
    def what(self) -> str:
        """The kind of the whole, "stairs", "ramp" or "escalator", for messages."""
        if self.moves:
            return "escalator"
        return "stairs" if self.risers else "ramp"

    def part(self, first: float, last: float, wider: float = 0.0) -> Polygon:
        """The strip from `first` to `last` metres below the upper edge, measured in plan.

        Args:
            first: metres; below 0 before the edge.
            last: metres.
            wider: metres by which it is wider to either side.
        """
        return strip(self.head, first, last, self.width / 2.0 + wider)


@dataclass(frozen=True)
class Landing:
    """A landing between two flights.

    Attributes:
        name: unique in the building.
        area: its floor.
        elevation: metres.
    """

    name: str
    area: Polygon
    elevation: float
