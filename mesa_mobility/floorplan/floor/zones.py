"""Zones of reduced speed: stairs drawn flat, soft ground, a crowded shop front."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_polygon


@dataclass(frozen=True)
class SpeedZone:
    """Part of the floor where people walk at a share of their preferred speed.

    A movement is decided on as a whole: one that leads into a zone or out of it has the mean speed
    of its way. So people slow down at most 1.5 s before a zone, speed up at most 1.5 s before its
    end, and come to its far side when they should. Where zones overlap, their factors multiply.
    People keep the same distances as elsewhere, at a lower speed (`Headway`).

    Args:
        polygon: shapely or WKT, metres.
        factor: more than 0, at most 1.
        name: for files and pictures.

    Raises:
        FloorPlanError: not a polygon, or a factor out of range.
    """

    polygon: Polygon | str
    factor: float
    name: str = ""

    def __post_init__(self) -> None:
        what = f"speed zone {self.name!r}" if self.name else "speed zone"
        object.__setattr__(self, "polygon", read_polygon(self.polygon, what))
        if not (is_number(self.factor) and 0.0 < self.factor <= 1.0):
            raise FloorPlanError(
                f"{what}: factor must be above 0, at most 1, found {self.factor!r}"
            )
        shapely.prepare(self.polygon)

    @property
    def area(self) -> Polygon:
        """The polygon as a shapely geometry."""
        assert isinstance(self.polygon, Polygon)
        return self.polygon


def check_zones(walkable: Polygon, zones: Sequence[SpeedZone]) -> None:
    """Zones must be SpeedZone objects that cover some floor; FloorPlanError otherwise."""
    for number, zone in enumerate(zones):
        if not isinstance(zone, SpeedZone):
            raise FloorPlanError(f"zones must be SpeedZone objects, found {type(zone).__name__}")
        if not zone.area.intersection(walkable).area > 0.0:
            raise FloorPlanError(f"speed zone {zone.name or number} has no floor in it")


def speed_factors(zones: Sequence[SpeedZone], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) share of the preferred speed at (n, 2) points."""
    factors = np.ones(len(points))
    for zone in zones:
        factors[shapely.intersects_xy(zone.area, points[:, 0], points[:, 1])] *= zone.factor
    return factors


_PARTS = 15
"""Parts of a way, each of which has one factor."""


def mean_factors(
    zones: Sequence[SpeedZone], starts: NDArray[np.float64], ends: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n,) mean share of the preferred speed of people on straight ways.

    A movement that leads into a zone or out of it is decided on as a whole. With the factor where
    it starts alone, people would be up to a movement late in slowing down, and in speeding up.

    Args:
        zones: the zones.
        starts: (n, 2) where people start, metres.
        ends: (n, 2) where they would be without zones when the movement ends, metres.
    """
    share = (np.arange(_PARTS) + 0.5) / _PARTS
    ahead = starts[:, None] + share[:, None] * (ends - starts)[:, None]
    factors = speed_factors(zones, ahead.reshape(-1, 2)).reshape(-1, _PARTS)
    # Each part takes 1 / factor of its time without zones; the movement ends within one of them.
    before = np.cumsum(1.0 / factors, axis=1) - 1.0 / factors
    passed = np.clip((_PARTS - before) * factors, 0.0, 1.0)
    mean: NDArray[np.float64] = passed.mean(axis=1)
    return mean
