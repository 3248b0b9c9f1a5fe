"""Pedestrians, their capability, the cost of their options, and the choice.

Compiling decisions needs none of what makes a model, so the names are imported when they are first
used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility.lazily import names_of

if TYPE_CHECKING:
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

_MODULES = {
    "FREE": "explain",
    "PERSON": "explain",
    "PRESETS": "presets",
    "WALL": "explain",
    "Candidates": "candidates",
    "Capability": "capability",
    "CompiledTerm": "terms",
    "CostTerm": "terms",
    "Deciding": "target_choice",
    "Explanation": "explain",
    "Inflow": "source",
    "Pace": "pace",
    "Pedestrian": "pedestrian",
    "PedestrianModel": "model",
    "PedestrianType": "pedestrian_type",
    "Preset": "presets",
    "Source": "source",
    "TargetChoice": "target_choice",
    "Watch": "explain",
    "bound_kernel": "kernels",
    "option_kernel": "kernels",
    "pair_kernel": "kernels",
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

__getattr__, __dir__ = names_of(__name__, _MODULES)
