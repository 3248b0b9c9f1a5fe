"""Where people may be in a building, in true coordinates, worked out from what it was made of.

It uses the arguments of levels, stairs, ramps, escalators and lifts, and nothing of what the
building draws for the model.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility import Building, Escalator, Level, Lift, Ramp, Stairs

FloatArray = NDArray[np.float64]

BEHIND, BESIDE = 0.35, 0.05
"""Metres behind the far end of a flight, and beside it, that are taken from the floor."""
DOORWAY = 0.1
"""Metres from a level to the car of a lift."""


@dataclass(frozen=True)
class Surface:
    """A floor on which people may be.

    Attributes:
        name: for messages.
        area: in plan, metres.
        plane: (a, b, c) with the height a + b x + c y, metres.
        joined: names of the surfaces onto which people step from it.
        lift: name of the lift whose car it is, if any.
        rise: metres by which a car under way may be higher.
    """

    name: str
    area: BaseGeometry
    plane: tuple[float, float, float]
    joined: frozenset[str] = frozenset()
    lift: str = ""
    rise: float = 0.0

    def heights(self, xy: FloatArray) -> FloatArray:
        """(n,) heights at (n, 2) places, metres."""
        a, b, c = self.plane
        found: FloatArray = a + b * xy[:, 0] + c * xy[:, 1]
        return found

    @property
    def slope(self) -> float:
        """Rise over run."""
        return math.hypot(*self.plane[1:])


@dataclass(frozen=True)
class Flight:
    """A slope in plan: its rectangle, and the surfaces at its two ends."""

    name: str
    left: FloatArray
    right: FloatArray
    going: float
    top: float
    bottom: float
    upper: str
    lower: str

    @property
    def down(self) -> FloatArray:
        """(2,) unit vector downwards, to the left of which lies the left end of the head."""
        across = self.left - self.right
        found: FloatArray = np.array([across[1], -across[0]]) / np.hypot(*across)
        return found

    def part(self, first: float, last: float, wider: float = 0.0) -> Polygon:
        """The rectangle between two distances from the head, metres, that much wider."""
        aside = wider * (self.left - self.right) / np.hypot(*(self.left - self.right))
        left, right = self.left + aside, self.right - aside
        down = self.down
        return Polygon([left + first * down, right + first * down, right + last * down,
                        left + last * down])  # fmt: skip

    @property
    def surface(self) -> Surface:
        """The slope itself."""
        fall = (self.bottom - self.top) / self.going
        b, c = fall * self.down
        a = self.top - b * self.left[0] - c * self.left[1]
        ends = frozenset((self.upper, self.lower))
        area = self.part(0.0, self.going)
        return Surface(self.name, area, (float(a), float(b), float(c)), ends)


def flights_of(way: Stairs | Ramp | Escalator, top: float, bottom: float) -> list[Flight]:
    """The slopes of stairs, a ramp or an escalator between two heights."""
    left, right = (np.array(end, dtype=float) for end in way.head)
    upper, lower = level_name(way.upper), level_name(way.lower)
    if not isinstance(way, Stairs):
        return [Flight(way.name, left, right, way.length, top, bottom, upper, lower)]
    if way.shape == "straight":
        going = (way.risers - 1) * way.tread
        return [Flight(way.name, left, right, going, top, bottom, upper, lower)]
    first, second = way.risers // 2, way.risers - way.risers // 2
    between = top - first * (top - bottom) / way.risers
    landing = landing_name(way.name)
    one = Flight(f"{way.name}, upper", left, right, (first - 1) * way.tread, top, between,
                 upper, landing)  # fmt: skip
    width = np.hypot(*(left - right))
    across = (left - right) / width * (1.0 if way.turn == "left" else -1.0)
    foot = (first - 1) * way.tread * one.down
    # Its head is seen from the other side: left and right change.
    two = Flight(f"{way.name}, lower", right + foot + (width + way.well) * across,
                 left + foot + (width + way.well) * across, (second - 1) * way.tread, between,
                 bottom, landing, lower)  # fmt: skip
    return [one, two]


def landing_of(way: Stairs, one: Flight, two: Flight) -> Surface:
    """The landing between the slopes of a dog-leg."""
    deep = (np.hypot(*(one.left - one.right)) if way.landing is None else way.landing) * one.down
    foot = one.going * one.down
    ends = np.array([one.left + foot, one.right + foot, two.left, two.right])
    area = shapely.MultiPoint(np.concatenate([ends, ends + deep])).convex_hull
    return Surface(landing_name(way.name), area, (one.bottom, 0.0, 0.0),
                   frozenset((one.name, two.name)))  # fmt: skip


def level_name(number: int) -> str:
    """Name of the floor of a level."""
    return f"level {number}"


def landing_name(stairs: str) -> str:
    """Name of the landing of a dog-leg."""
    return f"landing of {stairs}"


def surfaces_of(building: Building) -> list[Surface]:
    """All floors, landings, slopes, cars at their levels, and cars under way."""
    heights = {level.number: level.elevation for level in building.levels}
    slopes, found = list[Flight](), list[Surface]()
    for way in building.stairs:
        own = flights_of(way, heights[way.upper], heights[way.lower])
        slopes += own
        found += [each.surface for each in own]
        if len(own) == 2:
            assert isinstance(way, Stairs)
            found.append(landing_of(way, *own))
    for level in building.levels:
        shafts = [each for each in building.lifts if _reaches(each, level.elevation, heights)]
        found.append(_floor(level, slopes, shafts))
        found += [_car(lift, level) for lift in building.lifts if level.number in lift.numbers]
    for lift in building.lifts:
        served = [heights[number] for number in lift.numbers]
        stops = frozenset(each.name for each in found if each.lift == lift.name)
        plane = min(served), 0.0, 0.0
        found.append(Surface(f"{lift.name} under way", _inside(lift), plane, stops, lift.name,
                             max(served) - min(served)))  # fmt: skip
    return found


def _reaches(lift: Lift, height: float, heights: Mapping[int, float]) -> bool:
    """Whether the shaft of a lift stops at a height or passes it."""
    stops = [heights[number] for number in lift.numbers]
    return min(stops) <= height <= max(stops)


def _floor(level: Level, slopes: Sequence[Flight], lifts: Sequence[Lift]) -> Surface:
    """The floor of a level without what is taken from it; ``lifts`` are those that reach it."""
    name, joined = level_name(level.number), set[str]()
    taken = list(level.blocked)
    for each in slopes:
        if each.upper == name:
            taken.append(each.part(0.0, each.going + BEHIND, BESIDE))
        if each.lower == name:
            taken.append(each.part(-BEHIND, each.going, BESIDE))
        if name in (each.upper, each.lower):
            joined.add(each.name)
    for lift in lifts:
        taken.append(_behind(lift, 0.0, DOORWAY + lift.depth + BESIDE,
                             lift.width / 2.0 + BESIDE))  # fmt: skip
        if level.number in lift.numbers:
            joined.add(f"{lift.name} at {name}")
    area = shapely.difference(level.area, shapely.union_all(taken), grid_size=1e-9)
    # On this grid a spike of the outline may become a line.
    area = shapely.union_all([part for part in shapely.get_parts(area) if part.area])
    return Surface(name, area, (level.elevation, 0.0, 0.0), frozenset(joined))


def _car(lift: Lift, level: Level) -> Surface:
    """The car of a lift and its doorway, at a level."""
    name, door = level_name(level.number), LineString(lift.door).length / 2.0
    area = shapely.union(_behind(lift, 0.0, DOORWAY, door), _inside(lift), grid_size=1e-9)
    plane = level.elevation, 0.0, 0.0
    return Surface(f"{lift.name} at {name}", area, plane, frozenset([name]), lift.name)


def _inside(lift: Lift) -> Polygon:
    """The car of a lift without its doorway."""
    return _behind(lift, DOORWAY, DOORWAY + lift.depth, lift.width / 2.0)


def _behind(lift: Lift, first: float, last: float, half: float) -> Polygon:
    """A rectangle behind the door of a lift, whose first point is on the left of who walks in."""
    left, right = (np.array(end, dtype=float) for end in lift.door)
    middle, across = (left + right) / 2.0, (left - right) / np.hypot(*(left - right))
    into = np.array([across[1], -across[0]])
    aside = half * across
    return Polygon([middle + aside + first * into, middle - aside + first * into,
                    middle - aside + last * into, middle + aside + last * into])  # fmt: skip
