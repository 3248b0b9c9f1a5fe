"""Zones of reduced speed: stairs, soft ground, a crowded shop front."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_polygon

MOST_TREAD = 1.0
"""Greatest tread of a zone, metres."""


@dataclass(frozen=True)
class SpeedZone:
    """Part of the floor where people walk at a share of their preferred speed.

    A movement is decided on as a whole: one that leads into a zone or out of it has the mean speed
    of its way. So people slow down at most 1.5 s before a zone, speed up at most 1.5 s before its
    end, and come to its far side when they should. Where zones overlap, their factors multiply.
    People keep the same distances as elsewhere, at a lower speed, and on stairs a tread and a half
    more (`Headway`). A zone with a tread and a direction is a stair, on which people walk by the
    maps for stairs (`PedestrianType.up`).

    Args:
        polygon: shapely or WKT, metres.
        factor: more than 0, at most 1.
        name: for files and pictures.
        uphill: the factor for people who walk against ``downhill``; by default they have the same.
        downhill: the direction (dx, dy) in which the ground falls; needed for ``uphill``.
        tread: depth of the treads of stairs, metres; 0 for other ground.

    Raises:
        FloorPlanError: not a polygon, a number out of range, or ``uphill`` without a direction.
    """

    polygon: Polygon | str
    factor: float
    name: str = ""
    uphill: float | None = None
    downhill: tuple[float, float] | None = None
    tread: float = 0.0

    def __post_init__(self) -> None:
        what = f"speed zone {self.name!r}" if self.name else "speed zone"
        object.__setattr__(self, "polygon", read_polygon(self.polygon, what))
        uphill = self.factor if self.uphill is None else self.uphill
        for called, factor in (("factor", self.factor), ("uphill", uphill)):
            if not (is_number(factor) and 0.0 < factor <= 1.0):
                raise FloorPlanError(
                    f"{what}: {called} must be above 0, at most 1, found {factor!r}"
                )
        if not (is_number(self.tread) and 0.0 <= self.tread <= MOST_TREAD):
            raise FloorPlanError(
                f"{what}: tread must be 0 to {MOST_TREAD:g} m, found {self.tread!r}"
            )
        if self.downhill is not None or self.uphill is not None:
            object.__setattr__(self, "downhill", _direction(self.downhill, what))
        shapely.prepare(self.polygon)

    @property
    def is_stair(self) -> bool:
        """Whether it has a tread and a direction, so that people walk on it as on stairs."""
        return self.tread > 0.0 and self.downhill is not None

    @property
    def area(self) -> Polygon:
        """The polygon as a shapely geometry."""
        assert isinstance(self.polygon, Polygon)
        return self.polygon


def _direction(given: object, what: str) -> tuple[float, float]:
    """A direction (dx, dy) as floats; FloorPlanError unless it is one."""
    if (
        isinstance(given, Sequence)
        and len(given) == 2
        and all(is_number(each) for each in given)
        and 0.0 < math.hypot(*given) < math.inf
    ):
        return float(given[0]), float(given[1])
    raise FloorPlanError(
        f"{what}: downhill must be a direction (dx, dy) in which the ground falls, found {given!r}"
    )


def check_zones(walkable: Polygon, zones: Sequence[SpeedZone]) -> None:
    """Zones must be SpeedZone objects that cover some floor; FloorPlanError otherwise."""
    for number, zone in enumerate(zones):
        if not isinstance(zone, SpeedZone):
            raise FloorPlanError(f"zones must be SpeedZone objects, found {type(zone).__name__}")
        if not zone.area.intersection(walkable).area > 0.0:
            raise FloorPlanError(f"speed zone {zone.name or number} has no floor in it")


def speed_factors(zones: Sequence[SpeedZone], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) share of the preferred speed at (n, 2) points, of people who do not walk uphill."""
    return _ground(zones, points, np.zeros_like(points))[0]


def _ground(
    zones: Sequence[SpeedZone], points: NDArray[np.float64], ways: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n,) factors and (n,) treads at (n, 2) points for people who walk in (n, 2) directions."""
    factors, treads = np.ones(len(points)), np.zeros(len(points))
    for zone in zones:
        inside = shapely.intersects_xy(zone.area, points[:, 0], points[:, 1])
        factors[inside] *= zone.factor
        treads[inside] += zone.tread
        if zone.uphill is not None:
            up = inside & (ways @ np.array(zone.downhill) < 0.0)
            factors[up] *= zone.uphill / zone.factor
    return factors, treads


_PARTS = 15
"""Parts of a way, each of which has one factor."""


def ground_ahead(
    zones: Sequence[SpeedZone], starts: NDArray[np.float64], ends: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Speeds and distances that the ground allows people on straight ways.

    A movement that leads into a zone or out of it is decided on as a whole. With the factor where
    it starts alone, people would be up to a movement late in slowing down, and in speeding up.

    Args:
        zones: the zones.
        starts: (n, 2) where people start, metres.
        ends: (n, 2) where they would be without zones when the movement ends, metres.

    Returns:
        (n,) mean share of the preferred speed, and (n,) mean tread, metres.
    """
    share = (np.arange(_PARTS) + 0.5) / _PARTS
    ahead = starts[:, None] + share[:, None] * (ends - starts)[:, None]
    ways = np.repeat(ends - starts, _PARTS, axis=0)
    found = _ground(zones, ahead.reshape(-1, 2), ways)
    factors, treads = (each.reshape(-1, _PARTS) for each in found)
    # Each part takes 1 / factor of its time without zones; the movement ends within one of them.
    before = np.cumsum(1.0 / factors, axis=1) - 1.0 / factors
    passed = np.clip((_PARTS - before) * factors, 0.0, 1.0)
    return passed.mean(axis=1), (passed * treads).sum(axis=1) / passed.sum(axis=1)
