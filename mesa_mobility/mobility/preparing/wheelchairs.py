"""People in wheelchairs: no gait to record, so their options are those of a differential drive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.preparing.primitives import DifferentialDrive, map_of_primitives

BOYCE = "Boyce, Shields and Silcock 1999"

LENGTH, WIDTH = 1.2, 0.7
"""Footprint of an occupied wheelchair in metres: the greatest of class A of EN 12184:2014, powered
wheelchairs for use indoors."""


@dataclass(frozen=True)
class Wheelchair:
    """A kind of wheelchair and of who moves it.

    Attributes:
        drive: limits of its movements.
        speed: mean and standard deviation of the free speed, m/s.
        reference: where the speeds come from.
        limits: where the limits come from.
    """

    drive: DifferentialDrive
    speed: tuple[float, float]
    reference: str
    limits: str

    def build(self, type_name: str, metadata: dict[str, Any] | None = None) -> MobilityMap:
        """The mobility map.

        Args:
            type_name: name of the pedestrian type.
            metadata: further entries for the map's metadata, such as the command.
        """
        mean, deviation = self.speed
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
                "preferred_speed_m_s": {
                    "mean": mean,
                    "standard_deviation": deviation,
                    "source": self.reference,
                },
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
        (0.69, 0.35),
        BOYCE,
        f"fastest: two deviations above the mean; acceleration by hand assumed; {_LIMITS}",
    ),
    "wheelchair_powered": Wheelchair(
        DifferentialDrive(1.6, _COMFORT, _COMFORT, np.deg2rad(90.0), _COMFORT),
        (0.89, 0.22),
        f"{BOYCE} (two people); deviation assumed",
        f"fastest: 6 km/h, assumed; {_LIMITS}",
    ),
    "wheelchair_assisted": Wheelchair(
        DifferentialDrive(2.0, _COMFORT, _COMFORT, np.deg2rad(60.0), _COMFORT),
        (1.30, 0.34),
        BOYCE,
        f"fastest: two deviations above the mean; who pushes is not part of the body; {_LIMITS}",
    ),
}
"""Wheelchairs by the name of their type."""
