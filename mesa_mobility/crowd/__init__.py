"""Pedestrians, their capability, the cost of their options, and the choice.

Compiling decisions needs none of what makes a model, so the names are imported when they are first
used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.crowd.costs.candidates import Candidates
    from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm
    from mesa_mobility.crowd.costs.kernel_decorators import option_kernel, pair_kernel
    from mesa_mobility.crowd.costs.records import Me, Option, Options, Other, Wall
    from mesa_mobility.crowd.costs.terms import CostTerm
    from mesa_mobility.crowd.hooks import World
    from mesa_mobility.crowd.insertion.inflow import Inflow
    from mesa_mobility.crowd.insertion.source import Source
    from mesa_mobility.crowd.journeys.visit import Visit
    from mesa_mobility.crowd.options.capability import Capability
    from mesa_mobility.crowd.pedestrian_model import PedestrianModel
    from mesa_mobility.crowd.people.pedestrian import Pedestrian
    from mesa_mobility.crowd.planning.explanation import FREE, PERSON, WALL, Explanation, Watch
    from mesa_mobility.crowd.presets import PRESETS, Preset
    from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
    from mesa_mobility.crowd.tactics.route_choice import RouteChoice
    from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
    from mesa_mobility.crowd.tactics.tactic import Tactic
    from mesa_mobility.crowd.tactics.target_choice import TargetChoice
    from mesa_mobility.crowd.types.pedestrian_type import PedestrianType

_MODULES = {
    "Candidates": "costs.candidates",
    "Capability": "options.capability",
    "CompiledTerm": "costs.compiled_terms",
    "CostTerm": "costs.terms",
    "Deciding": "tactics.deciding",
    "Desired": "tactics.deciding",
    "Explanation": "planning.explanation",
    "FREE": "planning.explanation",
    "Inflow": "insertion.inflow",
    "Me": "costs.records",
    "Option": "costs.records",
    "Options": "costs.records",
    "Other": "costs.records",
    "PERSON": "planning.explanation",
    "PRESETS": "presets",
    "Pedestrian": "people.pedestrian",
    "PedestrianModel": "pedestrian_model",
    "PedestrianType": "types.pedestrian_type",
    "Preset": "presets",
    "RouteChoice": "tactics.route_choice",
    "Source": "insertion.source",
    "SpeedRule": "tactics.speed_rules",
    "Tactic": "tactics.tactic",
    "TargetChoice": "tactics.target_choice",
    "Visit": "journeys.visit",
    "WALL": "planning.explanation",
    "Wall": "costs.records",
    "Watch": "planning.explanation",
    "World": "hooks",
    "option_kernel": "costs.kernel_decorators",
    "pair_kernel": "costs.kernel_decorators",
}

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
    "Desired",
    "Explanation",
    "Inflow",
    "Me",
    "Option",
    "Options",
    "Other",
    "Pedestrian",
    "PedestrianModel",
    "PedestrianType",
    "Preset",
    "RouteChoice",
    "Source",
    "SpeedRule",
    "Tactic",
    "TargetChoice",
    "Visit",
    "Wall",
    "Watch",
    "World",
    "option_kernel",
    "pair_kernel",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
