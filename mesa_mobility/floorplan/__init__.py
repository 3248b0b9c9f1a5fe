"""Walkable area, walls, doors, exits and routes."""

from mesa_mobility.floorplan.openings import Exit, Gate
from mesa_mobility.floorplan.plan import FloorPlan
from mesa_mobility.floorplan.routing.router import Router
from mesa_mobility.floorplan.routing.targets import Targets
from mesa_mobility.floorplan.walls.line_of_sight import line_of_sight, lines_of_sight
from mesa_mobility.floorplan.walls.wall_index import CellTable, WallIndex
from mesa_mobility.floorplan.zones import SpeedZone

__all__ = [
    "CellTable",
    "Exit",
    "FloorPlan",
    "Gate",
    "Router",
    "SpeedZone",
    "Targets",
    "WallIndex",
    "line_of_sight",
    "lines_of_sight",
]
