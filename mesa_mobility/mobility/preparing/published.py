"""Free speeds as sources publish them, for types of whom nobody is recorded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class PublishedSpeed:
    """Free speeds of a type, m/s.

    Attributes:
        mean: of all who were measured.
        deviation: standard deviation.
        source: where they are published.
        extremes: of the slowest and of the fastest who were measured, if published.
    """

    mean: float
    deviation: float
    source: str
    extremes: tuple[float, float] | None = None

    @property
    def metadata(self) -> dict[str, Any]:
        """The entry ``preferred_speed_m_s`` of a map's metadata."""
        extremes = dict(zip(("least", "most"), self.extremes or (), strict=False))
        return {
            "mean": self.mean,
            "standard_deviation": self.deviation,
            **extremes,
            "source": self.source,
        }


_BOYCE = "Boyce, Shields and Silcock 1999"

CANE = PublishedSpeed(0.81, 0.38, _BOYCE, (0.26, 1.60))
CRUTCHES = PublishedSpeed(0.94, 0.30, _BOYCE, (0.63, 1.35))
WALKING_FRAME = PublishedSpeed(0.57, 0.29, _BOYCE, (0.10, 1.02))
MANUAL_WHEELCHAIR = PublishedSpeed(0.69, 0.35, _BOYCE, (0.13, 1.35))
ASSISTED_WHEELCHAIR = PublishedSpeed(1.30, 0.34, _BOYCE, (0.84, 1.98))
POWERED_WHEELCHAIR = PublishedSpeed(0.89, 0.22, f"{_BOYCE} (two people); deviation assumed")
"""Speeds on a level floor. Extremes of two people say nothing of others."""
