"""Types of pedestrians: a mobility map, a body and preferred speeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.distributions import Clipped, Distribution, Normal
from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.map import CORE_RADIUS

PREFERRED_SPEED = Clipped(Normal(1.34, 0.26), 0.6, 2.0)
"""Weidmann (1993): 1.34 +- 0.26 m/s, within the range of recordings of walking adults."""


@dataclass(frozen=True, kw_only=True)
class PedestrianType:
    """Pedestrians who share one mobility map.

    Attributes:
        mobility_map: the type's clustered mobility map.
        name: by default the map's own.
        preferred_speed: distribution of preferred speeds, m/s, or one speed for everybody.
        core_radius: radius of the disc that no other body enters, metres; by default the map's.
    """

    mobility_map: MobilityMap
    name: str = ""
    preferred_speed: Distribution | float = PREFERRED_SPEED
    core_radius: float = field(default=0.0)

    def __post_init__(self) -> None:
        if not self.name:
            object.__setattr__(self, "name", self.mobility_map.pedestrian_type)
        if self.core_radius == 0.0:
            body = self.mobility_map.metadata.get("body", {})
            object.__setattr__(self, "core_radius", float(body.get("core_radius_m", CORE_RADIUS)))
        if not 0.0 < self.core_radius < 1.0:
            raise ModelError(
                f"type {self.name!r}: core_radius {self.core_radius}, expected 0 to 1 m"
            )
        if not isinstance(self.preferred_speed, Distribution):
            speed = self.preferred_speed
            if not (isinstance(speed, Real) and 0.0 < speed < np.inf):
                raise ModelError(
                    f"type {self.name!r}: preferred_speed {speed!r}, expected a distribution or "
                    "more than 0 m/s"
                )

    def draw_speeds(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) preferred speeds, m/s."""
        if isinstance(self.preferred_speed, Distribution):
            return self.preferred_speed.draw(n, rng)
        return np.full(n, float(self.preferred_speed))


def types_of(
    mobility_map: MobilityMap | str | Path | None, types: Sequence[PedestrianType] | None
) -> tuple[PedestrianType, ...]:
    """A model's types: those given, or a single one for a map, its file, or the one that ships.

    Raises:
        ModelError: both are given, or no types at all.
        MapError: an unusable map file.
    """
    if types is None:
        if not isinstance(mobility_map, MobilityMap):
            mobility_map = MobilityMap.load(mobility_map)
        return (PedestrianType(mobility_map=mobility_map),)
    if mobility_map is not None:
        raise ModelError("mobility_map and pedestrian_types: got both, expected one of them")
    if not types:
        raise ModelError("pedestrian_types: got none, expected at least one")
    return tuple(types)
