"""Pedestrian crowds driven by recorded human movement, on Mesa.

Names are imported when they are first used, so that ``import mesa_mobility``
and the command line start at once.
"""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from mesa_mobility.kernel_cache import drop_stale_kernels
from mesa_mobility.lazily import names_of

if TYPE_CHECKING:
    from mesa_mobility.batch import batch_run
    from mesa_mobility.crowd import (
        Candidates,
        Capability,
        CompiledTerm,
        CostTerm,
        Deciding,
        Pace,
        Pedestrian,
        PedestrianModel,
        PedestrianType,
        Source,
        TargetChoice,
        bound_kernel,
        option_kernel,
        pair_kernel,
    )
    from mesa_mobility.errors import MobilityError
    from mesa_mobility.floorplan import Exit, FloorPlan, Gate, SpeedZone, Targets
    from mesa_mobility.mobility import MobilityMap, MotionGraph
    from mesa_mobility.results import Trajectories

__version__ = version("mesa-mobility")

drop_stale_kernels(Path(__file__).parent)

_ROOMS = {
    "Candidates": "crowd",
    "Capability": "crowd",
    "CompiledTerm": "crowd",
    "CostTerm": "crowd",
    "Deciding": "crowd",
    "Exit": "floorplan",
    "FloorPlan": "floorplan",
    "Gate": "floorplan",
    "MobilityError": "errors",
    "MobilityMap": "mobility",
    "MotionGraph": "mobility",
    "Pace": "crowd",
    "Pedestrian": "crowd",
    "PedestrianModel": "crowd",
    "PedestrianType": "crowd",
    "Source": "crowd",
    "SpeedZone": "floorplan",
    "TargetChoice": "crowd",
    "Targets": "floorplan",
    "Trajectories": "results",
    "batch_run": "batch",
    "bound_kernel": "crowd",
    "option_kernel": "crowd",
    "pair_kernel": "crowd",
}

__all__ = [
    "Candidates",
    "Capability",
    "CompiledTerm",
    "CostTerm",
    "Deciding",
    "Exit",
    "FloorPlan",
    "Gate",
    "MobilityError",
    "MobilityMap",
    "MotionGraph",
    "Pace",
    "Pedestrian",
    "PedestrianModel",
    "PedestrianType",
    "Source",
    "SpeedZone",
    "TargetChoice",
    "Targets",
    "Trajectories",
    "batch_run",
    "bound_kernel",
    "option_kernel",
    "pair_kernel",
]

__getattr__, __dir__ = names_of(__name__, _ROOMS)
