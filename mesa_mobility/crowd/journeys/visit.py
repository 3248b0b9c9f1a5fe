"""A place to visit, and the time to stay there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.journeys.waiting import LONGEST_WAIT
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan.floor.checks import read_wkt
from mesa_mobility.plugins.output import numbers_in

MOST_PEOPLE = 10_000_000
"""Most people at one place."""


@dataclass(frozen=True)
class Visit:
    """A place that people visit on their way, and stay at for a time.

    A visit stands in a ``route`` like the name of a gate. In an area everybody looks for a place of
    their own; at a point those who find others there stand around it.

    Attributes:
        place: a point (x, y) in metres, or an area, a polygon (shapely or WKT).
        stay: seconds for which people stand there, or a distribution of them.
        capacity: people who may stay there at once; the others wait before it, and go in as they
            came. By default as many as come.

    Raises:
        ModelError: a stay that is no time, or a capacity that is no number of people.
        FloorPlanError: a place that is neither a point nor a polygon.
    """

    place: Any
    stay: float | Distribution = 0.0
    capacity: int | None = None

    def __post_init__(self) -> None:
        if self.capacity is not None and not (
            isinstance(self.capacity, int)
            and not isinstance(self.capacity, bool)
            and 1 <= self.capacity <= MOST_PEOPLE
        ):
            raise ModelError(
                f"visit: capacity {self.capacity!r:.60}, expected 1 to {MOST_PEOPLE:,} people"
            )
        if not isinstance(self.stay, Distribution) and not (
            is_number(self.stay) and 0.0 <= self.stay <= LONGEST_WAIT
        ):
            raise ModelError(
                f"visit: stay {self.stay!r}, expected a distribution, or 0 to {LONGEST_WAIT:g} s"
            )
        object.__setattr__(self, "place", _read(self.place))

    @property
    def area(self) -> BaseGeometry | None:
        """The polygon to visit, if it is no point."""
        return None if isinstance(self.place, tuple) else self.place

    def __str__(self) -> str:
        if isinstance(self.place, tuple):
            return f"the point ({self.place[0]:g}, {self.place[1]:g})"
        x, y = self.place.centroid.coords[0]
        return f"the area around ({x:.6g}, {y:.6g})"


Route: TypeAlias = Sequence[str | Visit]
"""Gates and places in the order in which people go there."""


def _read(place: Any) -> tuple[float, float] | BaseGeometry:
    given = place
    if isinstance(given, str):
        given = read_wkt(given, "visit", "POINT or POLYGON")
    if isinstance(given, BaseGeometry) and given.geom_type == "Polygon":
        if given.is_empty or not given.is_valid:
            raise FloorPlanError("visit: the Polygon is empty or not valid")
        return given
    if isinstance(given, BaseGeometry) and given.geom_type == "Point" and not given.is_empty:
        given = given.x, given.y
    try:
        point = numbers_in("visit", given, "a point")
    except ModelError:
        point = np.empty(0)
    if point.shape != (2,) or not np.isfinite(point).all():
        raise FloorPlanError(f"visit: place {place!r}, expected a point (x, y) or a polygon")
    return float(point[0]), float(point[1])
