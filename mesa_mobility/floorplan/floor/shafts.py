"""Shafts: how lifts join the sheets of a floor plan.

The car of a lift is drawn on each sheet at which it stops, behind a gate: its door. Routes lead
into the car at one stop and out of it at another. People ride in a model of the plan, which moves
all who stand in the car from one drawing of it to the other.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility.floorplan.floor.openings import Gate
from mesa_mobility.floorplan.floor.seams import Link

WALKS = 1.34
"""Metres that people walk in a second, by which times of a ride count in routes (Weidmann 1993)."""

_OUTSIDE = 0.8
"""Metres from a door to a place right before it, at which a wheelchair has room."""


@dataclass(frozen=True)
class Stop:
    """A sheet at which a lift stops.

    Attributes:
        name: unique among the stops of the lift.
        door: the door, (left, right) as seen by somebody who walks in, metres in the plane.
        elevation: of the floor, metres.
    """

    name: str
    door: tuple[tuple[float, float], tuple[float, float]]
    elevation: float


@dataclass(frozen=True)
class Shaft:
    """A lift as a floor plan has it.

    Attributes:
        name: unique in the plan; names of its gates begin with it.
        stops: at least two; their doors are shifted copies of each other.
        before: metres from the line of a door to the car.
        width: of the car, metres.
        depth: of the car, metres.
        capacity: most people in the car.
        speed: of the car, m/s.
        door_s: seconds in which the doors open, and in which they close.
        everybody: whether people who use stairs use it, too.
    """

    name: str
    stops: tuple[Stop, ...]
    before: float
    width: float
    depth: float
    capacity: int
    speed: float
    door_s: float
    everybody: bool

    @property
    def gates(self) -> tuple[Gate, ...]:
        """The doors as gates, by stop."""
        return tuple(Gate(f"{self.name} at {stop.name}", *stop.door) for stop in self.stops)

    def car(self, stop: int) -> Polygon:
        """The floor of the car as drawn at a stop."""
        middle, into, across = self._axes(stop)
        near = middle + self.before * into
        half = self.width / 2.0 * across
        far = self.depth * into
        return Polygon([near - half, near + half, near + half + far, near - half + far])

    def in_car(
        self, stop: int, points: NDArray[np.float64], clear: NDArray[np.float64] | float = 0.0
    ) -> NDArray[np.bool_]:
        """(n,) whether points are in the car as drawn at a stop.

        Args:
            stop: number of the stop.
            points: (n, 2) metres.
            clear: (n,) metres that they must be past its front edge; below 0 before it.
        """
        middle, into, across = self._axes(stop)
        deep, aside = (points - middle) @ into - self.before, (points - middle) @ across
        inside: NDArray[np.bool_] = (
            (deep >= clear) & (deep <= self.depth) & (np.abs(aside) <= self.width / 2.0)
        )
        return inside

    def reached(
        self, stop: int, points: NDArray[np.float64], cores: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """(n,) whether bodies at (n, 2) points, of (n,) core radii, metres, are in the car as drawn
        at a stop, or across the line of its door."""
        return self.in_car(stop, points, -self.before - cores)

    def door(self, stop: int) -> NDArray[np.float64]:
        """(2,) middle of the door at a stop, metres."""
        return self._axes(stop)[0]

    def before_door(self, stop: int) -> NDArray[np.float64]:
        """(2,) a place on the floor right before the door at a stop, metres."""
        return self.door(stop) - _OUTSIDE * self.into()

    def into(self) -> NDArray[np.float64]:
        """(2,) unit vector into the car."""
        return self._axes(0)[1]

    def shift(self, start: int, end: int) -> NDArray[np.float64]:
        """(2,) metres from a place in the car at one stop to the same at another."""
        return np.array(self.stops[end].door[0]) - np.array(self.stops[start].door[0])

    @property
    def shifts(self) -> NDArray[np.float64]:
        """(k, 2) metres by which people are moved, from each stop to each other."""
        every = range(len(self.stops))
        return np.array([self.shift(a, b) for a in every for b in every if a != b])

    def ride_s(self, start: int, end: int) -> float:
        """Seconds from when the doors begin to close at one stop until they are open at another."""
        rise = abs(self.stops[end].elevation - self.stops[start].elevation)
        return 2.0 * self.door_s + rise / self.speed

    def ride_length(self, start: int, end: int) -> float:
        """Metres as which a ride counts in routes.

        It counts as long as it takes, and so does half a ride to and fro, for which people wait on
        average for a car that nobody else uses.
        """
        return 2.0 * self.ride_s(start, end) * WALKS

    @property
    def links(self) -> list[Link]:
        """How routes lead through the car, from each stop to each other."""
        into, gates, every = self.into(), self.gates, range(len(self.stops))
        return [
            Link(
                gates[start].name,
                gates[end].name,
                into,
                -into,
                self.shift(start, end),
                self.ride_length(start, end),
            )
            for start in every
            for end in every
            if start != end
        ]

    def _axes(
        self, stop: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """(2,) the middle of the door, the unit vector into the car, and that to the right."""
        left, right = (np.array(end) for end in self.stops[stop].door)
        across = (right - left) / math.dist(left, right)
        return (left + right) / 2.0, np.array([-across[1], across[0]]), across


def joints_of(shafts: Sequence[Shaft]) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Pairs of places, (x, y) in metres, that lifts join: the middles of cars at two stops."""
    pairs = []
    for shaft in shafts:
        places = [tuple(shaft.car(k).centroid.coords[0]) for k in range(len(shaft.stops))]
        pairs += [(places[0], other) for other in places[1:]]
    return pairs
