"""Walkable area, walls, doors, exits and routes."""

from mesa_mobility.floorplan.openings import Exit, Gate
from mesa_mobility.floorplan.plan import FloorPlan
from mesa_mobility.floorplan.router import Router, Targets
from mesa_mobility.floorplan.sight import line_of_sight, lines_of_sight
from mesa_mobility.floorplan.walls import CellTable, WallIndex
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
