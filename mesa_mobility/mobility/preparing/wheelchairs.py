"""People in wheelchairs: no gait to record, so their options are those of a differential drive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.preparing.primitives import DifferentialDrive, map_of_primitives
from mesa_mobility.mobility.preparing.published import (
    ASSISTED_WHEELCHAIR,
    MANUAL_WHEELCHAIR,
    POWERED_WHEELCHAIR,
    PublishedSpeed,
)

LENGTH, WIDTH = 1.2, 0.7
"""Footprint of an occupied wheelchair in metres: the greatest of class A of EN 12184:2014, powered
wheelchairs for use indoors."""


@dataclass(frozen=True)
class Wheelchair:
    """A kind of wheelchair and of who moves it.

    Attributes:
        drive: limits of its movements.
        speed: free speeds, as published.
        limits: where the limits come from.
    """

    drive: DifferentialDrive
    speed: PublishedSpeed
    limits: str

    def build(self, type_name: str, metadata: dict[str, Any] | None = None) -> MobilityMap:
        """The mobility map.

        Args:
            type_name: name of the pedestrian type.
            metadata: further entries for the map's metadata, such as the command.
        """
        drive = self.drive
        return map_of_primitives(
            drive,
            type_name,
            {
                "body": {
                    "core_radius_m": WIDTH / 2,
                    "length_m": LENGTH,
                    "width_m": WIDTH,
                    "source": "greatest of class A of EN 12184:2014; a disc as wide as that",
                },
                "preferred_speed_m_s": self.speed.metadata,
                "derived": {
                    "by": "motion primitives of a differential drive; nobody is recorded",
                    "fastest_m_s": drive.fastest,
                    "acceleration_m_s2": drive.acceleration,
                    "braking_m_s2": drive.braking,
                    "turn_rate_deg_s": round(float(np.rad2deg(drive.turn_rate)), 1),
                    "lateral_acceleration_m_s2": drive.lateral_acceleration,
                    "limits": self.limits,
                },
                **(metadata or {}),
            },
        )


_COMFORT = 1.0
"""m/s^2: about 0.1 g, an assumption."""

_LIMITS = "accelerations up to 0.1 g and turn rates assumed"

WHEELCHAIRS = {
    "wheelchair_manual": Wheelchair(
        DifferentialDrive(1.4, 0.6, _COMFORT, np.deg2rad(90.0), _COMFORT),
        MANUAL_WHEELCHAIR,
        f"fastest: two deviations above the mean; acceleration by hand assumed; {_LIMITS}",
    ),
    "wheelchair_powered": Wheelchair(
        DifferentialDrive(1.6, _COMFORT, _COMFORT, np.deg2rad(90.0), _COMFORT),
        POWERED_WHEELCHAIR,
        f"fastest: 6 km/h, assumed; {_LIMITS}",
    ),
    "wheelchair_assisted": Wheelchair(
        DifferentialDrive(2.0, _COMFORT, _COMFORT, np.deg2rad(60.0), _COMFORT),
        ASSISTED_WHEELCHAIR,
        f"fastest: two deviations above the mean; who pushes is not part of the body; {_LIMITS}",
    ),
}
"""Wheelchairs by the name of their type."""
