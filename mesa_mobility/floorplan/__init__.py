"""Walkable area, walls, doors, exits and routes."""

from mesa_mobility.floorplan.floor.belts import Belt
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.floor.room import Room
from mesa_mobility.floorplan.floor.seams import Seam
from mesa_mobility.floorplan.floor.shafts import WALKS, Shaft, Stop
from mesa_mobility.floorplan.floor.wall_index import CellTable, WallIndex
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.plan_format import PlanFormat, plan_suffixes
from mesa_mobility.floorplan.formats.storeys import Link, Storey, Storeys
from mesa_mobility.floorplan.oddities import Oddity, oddities_of
from mesa_mobility.floorplan.plan import FloorPlan
from mesa_mobility.floorplan.rooms.loads import LoadTable, load_tables, occupant_numbers
from mesa_mobility.floorplan.routing.router import Router
from mesa_mobility.floorplan.routing.targets import Targets
from mesa_mobility.floorplan.walls.line_of_sight import line_of_sight, lines_of_sight

__all__ = [
    "WALKS",
    "Belt",
    "CellTable",
    "Content",
    "Exit",
    "FloorPlan",
    "Gate",
    "Link",
    "LoadTable",
    "Oddity",
    "PlanFormat",
    "Room",
    "Router",
    "Seam",
    "Shaft",
    "SpeedZone",
    "Stop",
    "Storey",
    "Storeys",
    "Targets",
    "WallIndex",
    "line_of_sight",
    "lines_of_sight",
    "load_tables",
    "occupant_numbers",
    "oddities_of",
    "plan_suffixes",
]
