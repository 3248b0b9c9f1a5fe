"""Types derived from recordings of others, where nobody of the type could be recorded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mesa_mobility.capture import Recording, scale
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.map_data import CORE_RADIUS
from mesa_mobility.mobility.poses import STANDING_SPEED, STANDING_TURN_RATE, pose_table
from mesa_mobility.mobility.preparing.published import (
    CANE,
    CRUTCHES,
    WALKING_FRAME,
    PublishedSpeed,
)
from mesa_mobility.mobility.preparing.wheelchairs import WHEELCHAIRS

STEADY = 75
"""Percentile of the speeds of moving poses that stands for a steady walk.

Recordings are full of starts, turns and stops. Of able-bodied ones it is 1.34 m/s, Weidmann's mean.
"""


@dataclass(frozen=True)
class DerivedType:
    """How a type is derived from the recordings of another.

    Attributes:
        source: type of the recordings.
        speed: free speeds, as published.
        length: factor of all lengths.
        time: factor of all times; None for the one that gives the mean free speed.
        core_radius: of the body, metres.
        body: where the core radius comes from.
    """

    source: str
    speed: PublishedSpeed
    length: float = 1.0
    time: float | None = None
    core_radius: float = CORE_RADIUS
    body: str = "as an adult's"

    def time_factor(self, recordings: Sequence[Recording]) -> float:
        """The factor of all times of these recordings."""
        if self.time is not None:
            return self.time
        poses = pose_table(recordings)
        factor = 1.0
        # Who is quicker stands in fewer of the poses, which changes the percentile a little.
        for _ in range(5):
            standing = poses.is_standing(
                STANDING_SPEED * factor / self.length, STANDING_TURN_RATE * factor
            )
            steady = float(np.percentile(poses.speed[~standing], STEADY))
            factor = self.length * steady / self.speed.mean
        return factor

    def derive(
        self, recordings: Sequence[Recording], time: float
    ) -> tuple[list[Recording], dict[str, Any]]:
        """Scaled recordings, and the entries of a map's metadata that say how.

        Args:
            recordings: of the source type.
            time: from ``time_factor``.
        """
        metadata = {
            "body": {"core_radius_m": round(self.core_radius, 3), "source": self.body},
            "preferred_speed_m_s": self.speed.metadata,
            "derived": {
                "from": self.source,
                "length_factor": round(self.length, 4),
                "time_factor": round(time, 4),
                "by": "scaling lengths and times of the recordings; joint angles stay",
            },
        }
        return [scale(recording, self.length, time) for recording in recordings], metadata


_CHILD = 1.25 / 1.75
_CHILD_SPEED = round(1.34 * _CHILD**0.5, 2)

DERIVED_TYPES = {
    "child": DerivedType(
        "able_bodied",
        PublishedSpeed(
            _CHILD_SPEED,
            round(0.26 * _CHILD**0.5, 2),
            "able-bodied speeds (Weidmann 1993) at the Froude number of an adult",
        ),
        length=_CHILD,
        time=_CHILD**0.5,
        core_radius=CORE_RADIUS * 0.42 / 0.46,
        body="an adult's times 0.42 m / 0.46 m, diameters of a child of 10 and of an adult",
    ),
    "older_adult": DerivedType(
        "able_bodied",
        PublishedSpeed(
            1.23,
            0.2,
            "means of 27 people of 50 to 84 years (BMClab, CC BY 4.0); deviation assumed",
        ),
        # Steps of 0.715 and 0.722 leg lengths at 121 and 118 a minute, 1.23 and 1.25 m/s.
        length=(1.23 / 121) / (1.25 / 118),
        time=118 / 121,
    ),
    "frail_older_adult": DerivedType(
        "slow", PublishedSpeed(0.80, 0.30, "elderly people of FDS+Evac, guide, table 1")
    ),
    "cane": DerivedType("limping", CANE),
    "crutches": DerivedType(
        "limping", CRUTCHES, core_radius=0.22, body="assumed: crutches held 0.7 m apart"
    ),
    "walking_frame": DerivedType(
        "slow", WALKING_FRAME, core_radius=0.20, body="assumed: a frame 0.65 m wide"
    ),
}
"""Types by name."""


def derived_type(name: str) -> DerivedType:
    """A type that is derived from recordings, by name.

    Raises:
        MapError: there is none of that name.
    """
    if name not in DERIVED_TYPES:
        known = ", ".join([*DERIVED_TYPES, *WHEELCHAIRS])
        raise MapError(f"no derived type {name!r}, expected one of {known}")
    return DERIVED_TYPES[name]
