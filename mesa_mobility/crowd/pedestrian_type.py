"""Types of pedestrians: whose recorded movement they share, and how fast they like to walk."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.map import CORE_RADIUS


@dataclass(frozen=True, kw_only=True)
class PedestrianType:
    """Pedestrians who share one mobility map.

    Preferred speeds are normal, mean 1.34 and standard deviation 0.26 m/s
    (Weidmann 1993), clipped to the range that the type's recordings serve.

    Attributes:
        mobility_map: the type's clustered mobility map.
        name: by default the map's own.
        speed_mean: mean preferred speed, m/s.
        speed_sd: its standard deviation, m/s.
        speed_range: least and greatest preferred speed, m/s.
        core_radius: radius of the disc that no other body enters, metres; by default the map's.
    """

    mobility_map: MobilityMap
    name: str = ""
    speed_mean: float = 1.34
    speed_sd: float = 0.26
    speed_range: tuple[float, float] = (0.6, 2.0)
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
        low, high = self.speed_range
        if not (0.0 < low <= self.speed_mean <= high and self.speed_sd >= 0.0):
            raise ModelError(
                f"type {self.name!r}: speeds {self.speed_mean} +- {self.speed_sd} in {low} to "
                f"{high} m/s, expected 0 < least <= mean <= greatest and no negative deviation"
            )

    def draw_speeds(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) preferred speeds, m/s."""
        return np.clip(rng.normal(self.speed_mean, self.speed_sd, n), *self.speed_range)
