"""The shipped models, each a plug-in like any other."""

from mesa_mobility.models.auditorium import Auditorium
from mesa_mobility.models.doorway import Doorway
from mesa_mobility.models.floor_plan import FloorPlanEgress
from mesa_mobility.models.mixed_evacuation import MixedEvacuation
from mesa_mobility.models.office_tower import OfficeTower
from mesa_mobility.models.open_space import OpenSpace
from mesa_mobility.models.scenario import Scenario
from mesa_mobility.models.straight_walk import StraightWalk

__all__ = [
    "Auditorium",
    "Doorway",
    "FloorPlanEgress",
    "MixedEvacuation",
    "OfficeTower",
    "OpenSpace",
    "Scenario",
    "StraightWalk",
]
