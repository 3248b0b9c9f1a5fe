"""Behaviours that ship, each a plug-in like any other."""

from mesa_mobility.behaviors.interference import Interference
from mesa_mobility.behaviors.nearest_exit import NearestExit
from mesa_mobility.behaviors.speed import Displacement, PreferredSpeed
from mesa_mobility.behaviors.target import FacingDeviation, TargetDistance
from mesa_mobility.behaviors.walk_together import WalkTogether

__all__ = [
    "Displacement",
    "FacingDeviation",
    "Interference",
    "NearestExit",
    "PreferredSpeed",
    "TargetDistance",
    "WalkTogether",
]
