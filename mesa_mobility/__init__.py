"""Pedestrian crowds driven by recorded human movement, on Mesa.

Names are imported when they are first used, so that ``import mesa_mobility``
and the command line start at once.
"""

from __future__ import annotations

from mesa_mobility._lazy import beside_in_a_checkout, names_of

# To load typing takes as long as all else here, and the command answers Ctrl-C only after it.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility._version import __version__ as __version__
    from mesa_mobility.batch import batch_run as batch_run
    from mesa_mobility.buildings import Building as Building
    from mesa_mobility.buildings import Escalator as Escalator
    from mesa_mobility.buildings import Level as Level
    from mesa_mobility.buildings import Lift as Lift
    from mesa_mobility.buildings import Ramp as Ramp
    from mesa_mobility.buildings import Refuge as Refuge
    from mesa_mobility.buildings import Stairs as Stairs
    from mesa_mobility.crowd import Candidates as Candidates
    from mesa_mobility.crowd import Capability as Capability
    from mesa_mobility.crowd import CompiledTerm as CompiledTerm
    from mesa_mobility.crowd import CostTerm as CostTerm
    from mesa_mobility.crowd import Deciding as Deciding
    from mesa_mobility.crowd import Desired as Desired
    from mesa_mobility.crowd import Door as Door
    from mesa_mobility.crowd import Me as Me
    from mesa_mobility.crowd import Option as Option
    from mesa_mobility.crowd import Options as Options
    from mesa_mobility.crowd import Other as Other
    from mesa_mobility.crowd import Pedestrian as Pedestrian
    from mesa_mobility.crowd import PedestrianModel as PedestrianModel
    from mesa_mobility.crowd import PedestrianType as PedestrianType
    from mesa_mobility.crowd import Preset as Preset
    from mesa_mobility.crowd import RouteChoice as RouteChoice
    from mesa_mobility.crowd import Source as Source
    from mesa_mobility.crowd import SpeedRule as SpeedRule
    from mesa_mobility.crowd import Tactic as Tactic
    from mesa_mobility.crowd import TargetChoice as TargetChoice
    from mesa_mobility.crowd import Visit as Visit
    from mesa_mobility.crowd import Wall as Wall
    from mesa_mobility.crowd import World as World
    from mesa_mobility.crowd import option_kernel as option_kernel
    from mesa_mobility.crowd import pair_kernel as pair_kernel
    from mesa_mobility.errors import MobilityError as MobilityError
    from mesa_mobility.floorplan import Exit as Exit
    from mesa_mobility.floorplan import FloorPlan as FloorPlan
    from mesa_mobility.floorplan import Gate as Gate
    from mesa_mobility.floorplan import Room as Room
    from mesa_mobility.floorplan import SpeedZone as SpeedZone
    from mesa_mobility.floorplan import Targets as Targets
    from mesa_mobility.mobility import MobilityMap as MobilityMap
    from mesa_mobility.mobility import MotionGraph as MotionGraph
    from mesa_mobility.plugins.annotations import Files as Files
    from mesa_mobility.plugins.annotations import ListOf as ListOf
    from mesa_mobility.plugins.annotations import Range as Range
    from mesa_mobility.plugins.settings import check_fields as check_fields
    from mesa_mobility.results import Trajectories as Trajectories

__path__ += beside_in_a_checkout(__path__[0], "models")
__getattr__, __dir__ = names_of(__name__, __file__)
