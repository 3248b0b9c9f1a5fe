"""Buildings of several levels: levels, stairs, and how they are laid out in one plane."""

from mesa_mobility.buildings.building import Building
from mesa_mobility.buildings.files import read_floor
from mesa_mobility.buildings.level import Level
from mesa_mobility.buildings.places import ON_STAIRS
from mesa_mobility.buildings.stairs import Flight, Landing, Stairs

__all__ = ["ON_STAIRS", "Building", "Flight", "Landing", "Level", "Stairs", "read_floor"]
