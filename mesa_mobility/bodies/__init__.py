"""Bodies: the full-body poses behind movement options, and people who move through them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.bodies.bank import PoseBank
    from mesa_mobility.bodies.building import build_bank
    from mesa_mobility.bodies.motion import BodyMotion, body_motion
    from mesa_mobility.bodies.quality import BodyQuality, quality
    from mesa_mobility.bodies.sequence import Movements

_MODULES = {
    "BodyMotion": "motion",
    "BodyQuality": "quality",
    "Movements": "sequence",
    "PoseBank": "bank",
    "body_motion": "motion",
    "build_bank": "building",
    "quality": "quality",
}

__all__ = [
    "BodyMotion",
    "BodyQuality",
    "Movements",
    "PoseBank",
    "body_motion",
    "build_bank",
    "quality",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
