"""Random places to enter at, in an area or along a line."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_wkt
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.reachability import with_way_out

_THROWS = 8
"""Points thrown within the bounds of an area for each place wanted."""


def read_entrance(value: BaseGeometry | str) -> BaseGeometry:
    """An area or line (shapely or WKT) as a shapely geometry; FloorPlanError otherwise."""
    geometry: Any = value
    if isinstance(value, str):
        geometry = read_wkt(value, "entrance", "POLYGON or LINESTRING")
    kind = getattr(geometry, "geom_type", type(geometry).__name__)
    if kind not in ("Polygon", "LineString"):
        raise FloorPlanError(f"entrance: expected a Polygon or a LineString, found a {kind}")
    if geometry.is_empty or not geometry.is_valid:
        raise FloorPlanError(f"entrance: the {kind} is empty or not valid")
    made: BaseGeometry = geometry
    return made


class Entrance:
    """Draws random places with room for a body between the plan's current walls.

    Args:
        plan: the floor plan.
        geometry: a polygon or a line, metres.
        clearance: distance to walls, metres.
        passing: half the width of the narrowest gap on the body's way to an exit, metres.
    """

    def __init__(
        self, plan: Floor, geometry: BaseGeometry, *, clearance: float, passing: float
    ) -> None:
        self._plan = plan
        self._passing = passing
        self._geometry = geometry
        self._clearance = clearance
        self._version = -1
        if self.room.is_empty:
            raise FloorPlanError(
                f"entrance: no place in it is on the floor and {clearance:.2f} m from every wall"
            )

    @property
    def room(self) -> BaseGeometry:
        """Possible centres of a body: (multi)polygon or (multi)line, or empty."""
        if self._version != self._plan.version:
            self._version = self._plan.version
            free = self._plan.free.buffer(-self._clearance, quad_segs=32)
            room = with_way_out(self._plan, free.intersection(self._geometry), self._passing)
            found = shapely.get_parts(room)
            parts = [part for part in found if part.geom_type == self._geometry.geom_type]
            self._room = shapely.union_all(parts)
            shapely.prepare(self._room)
        return self._room

    def draw(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(k, 2) up to n places, metres; fewer or none if there is little room."""
        room = self.room
        if room.is_empty:
            return np.empty((0, 2))
        if self._geometry.geom_type == "LineString":
            parts = shapely.get_parts(room)
            lengths = shapely.length(parts)
            at = rng.choice(len(parts), n, p=lengths / lengths.sum())
            points = shapely.line_interpolate_point(parts[at], rng.random(n), normalized=True)
            return shapely.get_coordinates(points)
        x0, y0, x1, y1 = room.bounds
        thrown = rng.uniform((x0, y0), (x1, y1), (_THROWS * n, 2))
        return thrown[shapely.contains_xy(room, thrown[:, 0], thrown[:, 1])][:n]
