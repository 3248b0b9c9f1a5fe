"""Refuge areas of a level."""

from dataclasses import dataclass

from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_polygon


@dataclass(frozen=True)
class Refuge:
    """A refuge area: a part of a level in which people who cannot leave wait.

    Args:
        name: unique in the building.
        area: its floor; shapely or WKT, metres.

    Raises:
        FloorPlanError: no name, or no polygon.
    """

    name: str
    area: Polygon | str

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise FloorPlanError(
                f"refuge: expected a name of at least one letter, found {self.name!r:.60}"
            )
        object.__setattr__(self, "area", read_polygon(self.area, f"refuge {self.name!r}"))

    @property
    def shape(self) -> Polygon:
        """The area as a shapely geometry."""
        assert isinstance(self.area, Polygon)
        return self.area
