"""Straight stretches of the edge of an area, and what lies in front of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LinearRing, Polygon
from shapely.geometry.base import BaseGeometry

STRAIGHT = 0.005
"""Metres by which the corners of a straight edge may lie off it."""

IN_FRONT = 0.3
"""Metres in front of an exit where there must be floor: half the depth of a body."""

SHORTEST = 0.3
"""Metres; nobody passes an exit that is narrower."""


@dataclass(frozen=True)
class Edge:
    """A straight stretch from ``a`` to ``b``, (2,) metres, with the floor on its left."""

    a: NDArray[np.float64]
    b: NDArray[np.float64]

    @property
    def length(self) -> float:
        """Metres."""
        return float(np.hypot(*(self.b - self.a)))

    @property
    def along(self) -> NDArray[np.float64]:
        """(2,) direction from ``a`` to ``b``, of length 1."""
        return (self.b - self.a) / self.length

    @property
    def inwards(self) -> NDArray[np.float64]:
        """(2,) direction to the floor, of length 1."""
        x, y = self.along
        return np.array([-y, x])

    def between(self, first: float, last: float) -> "Edge":
        """The part between two distances from ``a``, metres."""
        return Edge(self.a + first * self.along, self.a + last * self.along)

    def open_parts(self, free: BaseGeometry) -> "list[Edge]":
        """The parts, at least ``SHORTEST`` long, that have free floor in front of them."""
        line = shapely.LineString([self.a, self.b])
        before = free
        for depth in (IN_FRONT / 2, IN_FRONT):
            x, y = depth * self.inwards
            moved = shapely.affinity.translate(line, x, y).intersection(before)
            line = shapely.affinity.translate(moved, -x, -y)
        found = []
        for part in shapely.get_parts(shapely.line_merge(line)):
            xy = shapely.get_coordinates(part)
            where = np.sort((xy - self.a) @ self.along)
            if len(where) > 1 and where[-1] - where[0] >= SHORTEST:
                found.append(self.between(float(where[0]), float(where[-1])))
        return found


def outer_edges(area: Polygon) -> list[Edge]:
    """The straight edges of the outline, without those of holes."""
    return list(_edges(shapely.geometry.polygon.orient(area).exterior))


def all_edges(area: Polygon) -> list[Edge]:
    """The straight edges of the outline and of holes."""
    oriented = shapely.geometry.polygon.orient(area)
    rings = (oriented.exterior, *oriented.interiors)
    return [edge for ring in rings for edge in _edges(ring)]


def _edges(ring: LinearRing) -> Iterator[Edge]:
    """Corners that lie on a straight line are left out."""
    xy = shapely.get_coordinates(shapely.simplify(ring, STRAIGHT))[:-1]
    # The corner at which a ring begins stays even where it is straight.
    if len(xy) > 3:
        before, after = xy[-1], xy[1]
        span = after - before
        off = abs(span[0] * (xy[0] - before)[1] - span[1] * (xy[0] - before)[0])
        if off <= STRAIGHT * np.hypot(*span):
            xy = xy[1:]
    for a, b in zip(xy, np.roll(xy, -1, axis=0), strict=True):
        if (a != b).any():
            yield Edge(a, b)
