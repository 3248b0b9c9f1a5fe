"""The people that a map is examined with, and how long they may take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mesa_mobility.crowd import PedestrianModel, PedestrianType, Visit
from mesa_mobility.distributions import Distribution
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.judging.verdict import with_verdict

BESIDE = 0.3
"""Metres that a door or a corridor leaves beside a body."""

DOOR, CORRIDOR = 0.9, 1.2
"""Least widths in metres: a door and a corridor of a flat."""

SLACK_S, SLACK = 20.0, 3.0
"""Seconds that people may take beyond the time of the straight way, and the factor by which that
time counts. Somebody in a manual wheelchair who starts beside a door, facing away from it, may pass
it, turn round and come back, and so take 21 s more than the straight way takes."""


@dataclass(frozen=True)
class Subject:
    """A person with whom a map is examined: one of its type, with the median preferred speed.

    Attributes:
        kind: the pedestrian type.
        speed: preferred speed, m/s.
    """

    kind: PedestrianType
    speed: float

    @classmethod
    def of(cls, map_: MobilityMap) -> Subject:
        """A person of the map's pedestrian type, with the median of that type's preferred speeds.

        Raises:
            MapError: the speeds in the map's metadata cannot be used.
        """
        # Under examination: its models need not warn that it has not been examined.
        kind = PedestrianType(mobility_map=with_verdict(map_, {}))
        speed = kind.preferred_speed
        assert isinstance(speed, Distribution)  # that of the map
        return cls(kind, float(speed.quantile(np.array([0.5]))[0]))

    @property
    def radius(self) -> float:
        """Radius of the body, metres."""
        return self.kind.half_width

    @property
    def door(self) -> float:
        """Width in metres of a door that the body needs."""
        return max(DOOR, 2.0 * self.radius + BESIDE)

    @property
    def corridor(self) -> float:
        """Width in metres of a corridor that the body needs."""
        return max(CORRIDOR, 2.0 * self.radius + BESIDE)

    def limit(self, way: float, speed: float | None = None) -> float:
        """Most seconds that a way of so many metres may take, at their own ``speed`` or another."""
        return SLACK_S + SLACK * way / (speed or self.speed)

    def model(self, plan: FloorPlan, seed: int = 0) -> PedestrianModel:
        """A model of people of this kind."""
        return PedestrianModel(plan, pedestrian_types=[self.kind], rng=seed)

    def alone(
        self,
        plan: FloorPlan,
        place: tuple[float, float],
        heading: float = 0.0,
        *,
        speed: float | None = None,
        route: Sequence[Visit] = (),
    ) -> PedestrianModel:
        """A model of one person, who stands at a place and faces a heading, radians."""
        model = self.model(plan)
        model.add_pedestrians(
            [place], headings=[heading], preferred_speeds=speed or self.speed, route=list(route)
        )
        return model

    def times(
        self, plan: FloorPlan, starts: Sequence[tuple[tuple[float, float], float, float]]
    ) -> list[float | None]:
        """Seconds until somebody alone has left, for each start.

        Args:
            plan: the floor.
            starts: place (x, y) in metres, heading in radians, and length of the way out in metres.

        Returns:
            Seconds for each start; None where the person has not left within ``limit``.
        """
        found: list[float | None] = []
        for place, heading, way in starts:
            model = self.alone(plan, place, heading)
            model.run(max_seconds=self.limit(way))
            found.append(None if model.inside else round(model.elapsed, 1))
        return found
