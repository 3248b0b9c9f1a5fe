"""Pedestrian crowds driven by recorded human movement, on Mesa.

Names are imported when they are first used, so that ``import mesa_mobility``
and the command line start at once.
"""

from __future__ import annotations

from mesa_mobility._lazy import beside_in_a_checkout, names_of

# To load typing takes as long as all else here, and the command answers Ctrl-C only after it.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility._version import __version__
    from mesa_mobility.batch import batch_run
    from mesa_mobility.crowd import (
        Candidates,
        Capability,
        CompiledTerm,
        CostTerm,
        Deciding,
        Desired,
        Me,
        Option,
        Options,
        Other,
        Pedestrian,
        PedestrianModel,
        PedestrianType,
        Preset,
        RouteChoice,
        Source,
        SpeedRule,
        Tactic,
        TargetChoice,
        Visit,
        Wall,
        World,
        option_kernel,
        pair_kernel,
    )
    from mesa_mobility.errors import MobilityError
    from mesa_mobility.floorplan import Exit, FloorPlan, Gate, SpeedZone, Targets
    from mesa_mobility.mobility import MobilityMap, MotionGraph
    from mesa_mobility.plugins.annotations import Files, ListOf, Range
    from mesa_mobility.plugins.settings import check_fields
    from mesa_mobility.results import Trajectories

_ROOMS = {
    "Candidates": "crowd",
    "Capability": "crowd",
    "CompiledTerm": "crowd",
    "CostTerm": "crowd",
    "Deciding": "crowd",
    "Desired": "crowd",
    "Exit": "floorplan",
    "Files": "plugins.annotations",
    "FloorPlan": "floorplan",
    "Gate": "floorplan",
    "ListOf": "plugins.annotations",
    "Me": "crowd",
    "MobilityError": "errors",
    "MobilityMap": "mobility",
    "MotionGraph": "mobility",
    "Option": "crowd",
    "Options": "crowd",
    "Other": "crowd",
    "Pedestrian": "crowd",
    "PedestrianModel": "crowd",
    "PedestrianType": "crowd",
    "Preset": "crowd",
    "Range": "plugins.annotations",
    "RouteChoice": "crowd",
    "Source": "crowd",
    "SpeedRule": "crowd",
    "SpeedZone": "floorplan",
    "Tactic": "crowd",
    "TargetChoice": "crowd",
    "Targets": "floorplan",
    "Trajectories": "results",
    "Visit": "crowd",
    "Wall": "crowd",
    "World": "crowd",
    "__version__": "_version",
    "batch_run": "batch",
    "check_fields": "plugins.settings",
    "option_kernel": "crowd",
    "pair_kernel": "crowd",
}

__all__ = [
    "Candidates",
    "Capability",
    "CompiledTerm",
    "CostTerm",
    "Deciding",
    "Desired",
    "Exit",
    "Files",
    "FloorPlan",
    "Gate",
    "ListOf",
    "Me",
    "MobilityError",
    "MobilityMap",
    "MotionGraph",
    "Option",
    "Options",
    "Other",
    "Pedestrian",
    "PedestrianModel",
    "PedestrianType",
    "Preset",
    "Range",
    "RouteChoice",
    "Source",
    "SpeedRule",
    "SpeedZone",
    "Tactic",
    "TargetChoice",
    "Targets",
    "Trajectories",
    "Visit",
    "Wall",
    "World",
    "__version__",
    "batch_run",
    "check_fields",
    "option_kernel",
    "pair_kernel",
]

__path__ += beside_in_a_checkout(__path__[0], "models")
__getattr__, __dir__ = names_of(__name__, _ROOMS)
