"""Shafts of lifts: walls that one sees through, open at the doors, and a frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.animation.meshes import Mesh, bar, joined, post, upright

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building, Lift

DOOR_HIGH = 2.0
"""Clear height of the door of a lift, metres: the least of EN 81-20."""

HEAD = 2.3
"""Metres by which a shaft is higher than the floor of its highest level."""

_POST = 0.06
"""Thickness of the frame, metres."""

_SHORTEST = 1e-6
"""Metres of a wall that is drawn."""


@dataclass(frozen=True)
class Stretch:
    """The part of a shaft between two elevations.

    Attributes:
        lift: its lift.
        low: its lower end, metres.
        high: its upper end, metres.
        stops: whether the lift stops at the lower end, where the shaft then has a door.
        last: whether it is the highest part.
    """

    lift: Lift
    low: float
    high: float
    stops: bool
    last: bool

    @property
    def walls(self) -> Mesh:
        """The sides, the back, and what is beside and above the door."""
        around, (left, right) = _corners(self.lift), np.array(self.lift.door)
        sides = np.hstack([around, np.roll(around, -1, axis=0)])
        if not self.stops:
            return upright(sides, self.low, self.high)
        beside = np.array([[*around[0], *left], [*right, *around[1]]])
        beside = beside[np.hypot(*(beside[:, 2:] - beside[:, :2]).T) > _SHORTEST]
        parts = [upright(np.concatenate([sides[1:], beside]), self.low, self.high)]
        if self._door_top < self.high:
            parts.append(upright(np.array([[*left, *right]]), self._door_top, self.high))
        return joined(parts)

    @property
    def frame(self) -> Mesh:
        """Posts at the corners and beside the door, a bar above the door, and bars on the top."""
        around, door = _corners(self.lift), np.array(self.lift.door)
        parts = [post(at, _POST, self.low, self.high) for at in around]
        if self.stops:
            parts += [post(at, _POST, self.low, self._door_top) for at in door]
            parts.append(_bar(door[0], door[1], self._door_top))
        if self.last:
            parts += [_bar(*ends, self.high) for ends in pairwise([*around, around[0]])]
        return joined(parts)

    @property
    def _door_top(self) -> float:
        return min(self.low + DOOR_HIGH, self.high)


def holes(building: Building, elevation: float) -> list[shapely.Polygon]:
    """The cars of the lifts that come to a floor from below, or pass it."""
    spans = [(lift, stops_of(building, lift)) for lift in building.lifts]
    return [lift.car for lift, stops in spans if min(stops) < elevation <= max(stops)]


def stretches(building: Building) -> Iterator[Stretch]:
    """The parts of all shafts from each elevation of a level up to the next one."""
    levels = {level.elevation for level in building.levels}
    for lift in building.lifts:
        stops = stops_of(building, lift)
        low, top = min(stops), max(stops)
        ends = [*sorted(each for each in levels if low <= each <= top), top + HEAD]
        for lower, upper in pairwise(ends):
            yield Stretch(lift, lower, upper, lower in stops, upper == ends[-1])


def stops_of(building: Building, lift: Lift) -> list[float]:
    """Elevations of the levels at which a lift stops, metres."""
    return [building.level(number).elevation for number in lift.numbers]


def _corners(lift: Lift) -> NDArray[np.float64]:
    """(4, 2) corners of a shaft, from the one on the left of its door to that on the right."""
    return shapely.get_coordinates(lift.shape)[:4]


def _bar(start: NDArray[np.float64], end: NDArray[np.float64], top: float) -> Mesh:
    return bar(np.array([*start, top]), np.array([*end, top]), _POST)
