"""A closed track, two straights and two half circles, on which people walk for ever."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import LineString, Polygon, box

from mesa_mobility import Deciding, Exit, FloorPlan, PedestrianModel, TargetChoice, Targets
from mesa_mobility.verification.runs import crowd_model

FloatArray = NDArray[np.float64]

AHEAD = 3.0
"""How far ahead on the track people aim, metres."""

SERVICE_DOOR = "service door"
"""A floor plan needs an exit; this one is shut before anybody comes."""


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
        """The track as a floor plan without a way out."""
        y = -self.radius - self.width / 2
        plan = FloorPlan(self.floor, exits=[Exit(SERVICE_DOOR, (-0.5, y), (0.5, y))], name="oval")
        return plan

    def boxes(self, length: float) -> tuple[Polygon, Polygon]:
        """The middle of both straights, `length` metres of them, the lower one first."""
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


class RoundAndRound(TargetChoice):
    """Everybody walks round an oval for ever, some the other way round.

    Args:
        oval: the track.
        clockwise: rows of those who walk clockwise.
    """

    name = "round_and_round"

    def __init__(self, oval: Oval, clockwise: frozenset[int] = frozenset()) -> None:
        self.oval = oval
        self.clockwise = np.array(sorted(clockwise), dtype=np.int64)

    def targets(self, deciding: Deciding) -> Targets:
        """A point ahead on one's own side of the track."""
        along, across = self.oval.unroll(deciding.positions)
        back = np.isin(deciding.pedestrians, self.clockwise)
        points = self.oval.roll(along + np.where(back, -AHEAD, AHEAD), across)
        n = len(deciding.pedestrians)
        # Nobody is nearer to a goal than anybody else: people decide in the order of their rows.
        return Targets(points, np.full(n, -1, dtype=np.int64), np.full(n, AHEAD))


def oval_model(
    oval: Oval,
    people: int,
    seed: int,
    *,
    speed: float | None = None,
    clockwise: int = 0,
    spacing: float,
    clearance: float,
) -> PedestrianModel:
    """People all over an oval, `clockwise` of them the other way round."""
    plan = oval.plan()
    backwards = frozenset(range(clockwise))
    model = crowd_model(plan, seed, target_choice=RoundAndRound(oval, backwards))
    places = plan.random_points(people, model.rng, spacing=spacing, clearance=clearance)
    plan.close_gate(SERVICE_DOOR)
    model.add_pedestrians(places, preferred_speeds=speed)
    return model
