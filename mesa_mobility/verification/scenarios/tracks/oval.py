"""A closed track of two straights and two half circles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from shapely import LineString, Polygon, box

from mesa_mobility import FloorPlan, Gate, PedestrianModel
from mesa_mobility.distributions import Distribution
from mesa_mobility.verification.runs import crowd_model

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Oval:
    """A track round the origin; the straights run along x, at y = -radius and y = +radius.

    Attributes:
        straight: length of each straight, metres.
        radius: of the half circles on the centre line, metres.
        width: of the track, metres.
    """

    straight: float
    radius: float
    width: float

    @property
    def length(self) -> float:
        """Of the centre line, metres."""
        return 2.0 * self.straight + 2.0 * math.pi * self.radius

    @property
    def floor(self) -> Polygon:
        """The track."""
        spine = LineString([(-self.straight / 2, 0.0), (self.straight / 2, 0.0)])
        outer = spine.buffer(self.radius + self.width / 2, quad_segs=16)
        inner = spine.buffer(self.radius - self.width / 2, quad_segs=16)
        return Polygon(outer.exterior, [inner.exterior])

    def plan(self) -> FloorPlan:
        """The track as a floor plan, with gates across the middle of straights and half circles."""
        inner, outer = self.radius - self.width / 2, self.radius + self.width / 2
        end = self.straight / 2
        gates = [
            Gate("south", (0.0, -inner), (0.0, -outer)),
            Gate("east", (end + inner, 0.0), (end + outer, 0.0)),
            Gate("north", (0.0, inner), (0.0, outer)),
            Gate("west", (-end - inner, 0.0), (-end - outer, 0.0)),
        ]
        return FloorPlan(self.floor, exits=[], gates=gates, name="oval")

    def boxes(self, length: float) -> tuple[Polygon, Polygon]:
        """The middle `length` metres of both straights, the lower straight first."""
        half, side = length / 2, self.width / 2
        return (
            box(-half, -self.radius - side, half, -self.radius + side),
            box(-half, self.radius - side, half, self.radius + side),
        )

    def unroll(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Metres along the centre line, counter-clockwise from the left end of the lower straight,
        and metres to the left of it, of (n, 2) places."""
        x, y = places[:, 0], places[:, 1]
        half = self.straight / 2
        turn = np.pi * self.radius
        right, left = x > half, x < -half
        along = np.where(y < 0, x + half, self.straight + turn + (half - x))
        across = self.radius - np.abs(y)
        for end, centre, start, begin in (
            (right, half, -np.pi / 2, self.straight),
            (left, -half, np.pi / 2, 2 * self.straight + turn),
        ):
            angle = np.mod(np.arctan2(y, x - centre) - start, 2 * np.pi)
            along = np.where(end, begin + self.radius * angle, along)
            across = np.where(end, self.radius - np.hypot(x - centre, y), across)
        return np.mod(along, self.length), across

    def roll(self, along: FloatArray, across: FloatArray) -> FloatArray:
        """(n, 2) places of distances along and to the left of the centre line."""
        along = np.mod(along, self.length)
        half, turn = self.straight / 2, np.pi * self.radius
        places = np.empty((len(along), 2))
        lower = along < self.straight
        upper = (along >= self.straight + turn) & (along < 2 * self.straight + turn)
        places[lower] = np.column_stack([along - half, across - self.radius])[lower]
        back = half - (along - self.straight - turn)
        places[upper] = np.column_stack([back, self.radius - across])[upper]
        for end, centre, start, begin in (
            (~lower & (along < self.straight + turn), half, -np.pi / 2, self.straight),
            (along >= 2 * self.straight + turn, -half, np.pi / 2, 2 * self.straight + turn),
        ):
            angle = start + (along - begin) / self.radius
            reach = self.radius - across
            on_arc = np.column_stack([centre + reach * np.cos(angle), reach * np.sin(angle)])
            places[end] = on_arc[end]
        return places


def oval_model(
    oval: Oval,
    people: int,
    seed: int,
    *,
    speed: float | Distribution | None = None,
    spacing: float,
    clearance: float,
    **rules: Any,
) -> PedestrianModel:
    """People distributed over an oval; they walk round it without end, counter-clockwise."""
    plan = oval.plan()
    model = crowd_model(plan, seed, **rules)
    places = plan.random_points(people, model.rng, spacing=spacing, clearance=clearance)
    names = [gate.name for gate in plan.gates]
    lines = oval.unroll(np.array([gate.midpoint for gate in plan.gates]))[0]
    ahead = np.searchsorted(lines, oval.unroll(places)[0]) % len(names)
    for first in range(len(names)):
        group = ahead == first
        if group.any():
            model.add_pedestrians(
                places[group],
                preferred_speeds=speed,
                route=names[first:] + names[:first],
                loop=True,
            )
    return model
