"""Places on the floor that people visit: who has arrived, and where there is room to stand."""

from __future__ import annotations

import math

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.crowd.journeys.visit import Visit
from mesa_mobility.crowd.state.clearances import passing_of
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import FloorPlan, line_of_sight, lines_of_sight

APART = 0.6
"""Metres between the places where two people stand."""

NEAR = 0.5
"""Metres from a point at which somebody has arrived, if nobody stands there."""

BESIDE = 1.0
"""Metres from a place at which somebody waits until there is room for them."""

# Those around a point stand on a sunflower's spiral, APART from each other, and the next one has
# arrived where it meets them.
_SPIRAL, _AROUND = 0.34, 0.4
_TURN = math.pi * (3.0 - math.sqrt(5.0))

_THROWS = 32
"""Random points of an area of which the first free one is taken."""


class Place:
    """A place of a floor plan for people of one core radius.

    Args:
        plan: the floor plan, whose obstacles may change.
        visit: the place.
        core: radius of their bodies, metres.
    """

    def __init__(self, plan: FloorPlan, visit: Visit, core: float) -> None:
        self.visit = visit
        self._plan = plan
        self._keep = passing_of(core)
        self._version = -1

    @property
    def _room(self) -> BaseGeometry:
        """Where a body may stand and go."""
        if self._version != self._plan.version:
            self._version = self._plan.version
            room = self._plan.free.buffer(-self._keep, quad_segs=32)
            area = self.visit.area
            self._now = room if area is None else room.intersection(area)
            shapely.prepare(self._now)
        return self._now

    def way_point(self) -> tuple[float, float]:
        """The point of the place to which routes lead, metres.

        Raises:
            FloorPlanError: there is no room for the body.
        """
        room = self._room
        if isinstance(self.visit.place, tuple):
            x, y = self.visit.place
            if not self._plan.contains([(x, y)])[0]:
                raise FloorPlanError(f"visit: {self.visit} is off the floor, expected one on it")
            if not shapely.contains_xy(room, x, y):
                away = shapely.Point(x, y).distance(self._plan.free.boundary)
                raise FloorPlanError(
                    f"visit: {self.visit} is {away:.3f} m from a wall, expected {self._keep:.3f} m "
                    "or more"
                )
            return x, y
        parts = [each for each in shapely.get_parts(room) if each.area > 0.0]
        if not parts:
            raise FloorPlanError(
                f"visit: {self.visit} has no place on the floor that is {self._keep:.3f} m from "
                "every wall"
            )
        inside = max(parts, key=lambda part: part.area).representative_point()
        return float(inside.x), float(inside.y)

    def reached(self, x: float, y: float, staying: int) -> bool:
        """Whether somebody at (x, y), metres, has arrived where so many others stay."""
        area = self.visit.area
        if area is not None:
            return bool(shapely.intersects_xy(area, x, y))
        px, py = self.visit.place
        away = math.hypot(x - px, y - py)
        if away > NEAR + _AROUND * math.sqrt(staying):
            return False
        return away == 0.0 or line_of_sight(self._plan, (x, y), (px, py))

    def beside(self, x: float, y: float, others: int) -> bool:
        """Whether somebody at (x, y), metres, is so near that they wait for room at the place.

        Args:
            x: their position, metres.
            y: their position, metres.
            others: number of people who stay or wait there.
        """
        here = shapely.Point(x, y)
        place = shapely.Point(self.visit.place) if self.visit.area is None else self._room
        if place.is_empty:
            return False
        way = shapely.shortest_line(here, place)
        if way.length > BESIDE + _AROUND * math.sqrt(others):
            return False
        return way.length == 0.0 or line_of_sight(self._plan, (x, y), way.coords[-1])

    def spot(
        self,
        x: float,
        y: float,
        staying: int,
        taken: NDArray[np.float64],
        rng: np.random.Generator,
    ) -> tuple[float, float]:
        """Choose where a person who has arrived at (x, y) is going to stand, metres.

        Args:
            x: their position, metres.
            y: their position, metres.
            staying: number of other people who stay at this place.
            taken: (k, 2) where others stand, at this place or another, metres.
            rng: the model's generator.
        """
        room = self._room
        if isinstance(self.visit.place, tuple):
            px, py = self.visit.place
            number = np.arange(4 * staying + 13)
            far, angle = _SPIRAL * np.sqrt(number), _TURN * number
            thrown = np.column_stack([px + far * np.cos(angle), py + far * np.sin(angle)])
        else:
            px, py = x, y
            x0, y0, x1, y1 = room.bounds
            # Where an obstacle has come to stand, or only one person has room.
            if not x1 > x0 or max(x1 - x0, y1 - y0) <= APART:
                return x, y
            thrown = rng.uniform((x0, y0), (x1, y1), (_THROWS, 2))
        thrown = thrown[shapely.contains_xy(room, thrown[:, 0], thrown[:, 1])]
        seen = lines_of_sight(self._plan, np.tile((px, py), (len(thrown), 1)), thrown)
        thrown = thrown[seen]
        if len(thrown) == 0:
            return x, y
        gaps = np.full(len(thrown), np.inf)
        if len(taken):
            gaps = np.hypot(*(thrown[:, None] - taken).T).min(axis=0)
        free = gaps >= APART - 0.05
        best = int(np.argmax(free)) if free.any() else int(np.argmax(gaps))
        return float(thrown[best, 0]), float(thrown[best, 1])
