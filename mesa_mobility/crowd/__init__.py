"""Pedestrians, their capability, the cost of their options, and the choice."""

from mesa_mobility.crowd.candidates import Candidates
from mesa_mobility.crowd.capability import Capability
from mesa_mobility.crowd.explain import FREE, PERSON, WALL, Explanation, Watch
from mesa_mobility.crowd.kernels import bound_kernel, option_kernel, pair_kernel
from mesa_mobility.crowd.model import PedestrianModel
from mesa_mobility.crowd.pace import Pace
from mesa_mobility.crowd.pedestrian import Pedestrian
from mesa_mobility.crowd.pedestrian_type import PedestrianType
from mesa_mobility.crowd.presets import PRESETS, Preset
from mesa_mobility.crowd.source import Inflow, Source
from mesa_mobility.crowd.target_choice import Deciding, TargetChoice
from mesa_mobility.crowd.terms import CompiledTerm, CostTerm

__all__ = [
    "FREE",
    "PERSON",
    "PRESETS",
    "WALL",
    "Candidates",
    "Capability",
    "CompiledTerm",
    "CostTerm",
    "Deciding",
    "Explanation",
    "Inflow",
    "Pace",
    "Pedestrian",
    "PedestrianModel",
    "PedestrianType",
    "Preset",
    "Source",
    "TargetChoice",
    "Watch",
    "bound_kernel",
    "option_kernel",
    "pair_kernel",
]
