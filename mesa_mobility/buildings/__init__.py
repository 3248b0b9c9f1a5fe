"""Buildings: levels, what joins them, and how they are laid out in one plane."""

from mesa_mobility.buildings.building import Building
from mesa_mobility.buildings.connections.escalator import Escalator
from mesa_mobility.buildings.connections.flights import Flight, Landing
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.buildings.files import read_floor
from mesa_mobility.buildings.footing import Footing
from mesa_mobility.buildings.level import Level
from mesa_mobility.buildings.places import ON_STAIRS
from mesa_mobility.buildings.refuge import Refuge
from mesa_mobility.buildings.sheets import Sheet

__all__ = [
    "ON_STAIRS",
    "Building",
    "Escalator",
    "Flight",
    "Footing",
    "Landing",
    "Level",
    "Lift",
    "Ramp",
    "Refuge",
    "Sheet",
    "Stairs",
    "read_floor",
]
