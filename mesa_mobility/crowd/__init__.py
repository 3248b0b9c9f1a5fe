"""Pedestrians, their capability, the cost of their options, and the choice.

Compiling decisions needs none of what makes a model, so the names are imported when they are first
used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.crowd.costs.candidates import Candidates as Candidates
    from mesa_mobility.crowd.costs.compiled_terms import CompiledTerm as CompiledTerm
    from mesa_mobility.crowd.costs.kernel_decorators import option_kernel as option_kernel
    from mesa_mobility.crowd.costs.kernel_decorators import pair_kernel as pair_kernel
    from mesa_mobility.crowd.costs.records import Me as Me
    from mesa_mobility.crowd.costs.records import Option as Option
    from mesa_mobility.crowd.costs.records import Options as Options
    from mesa_mobility.crowd.costs.records import Other as Other
    from mesa_mobility.crowd.costs.records import Wall as Wall
    from mesa_mobility.crowd.costs.terms import CostTerm as CostTerm
    from mesa_mobility.crowd.doors.door import Door as Door
    from mesa_mobility.crowd.hooks import World as World
    from mesa_mobility.crowd.insertion.inflow import Inflow as Inflow
    from mesa_mobility.crowd.insertion.source import Source as Source
    from mesa_mobility.crowd.journeys.visit import Visit as Visit
    from mesa_mobility.crowd.options.capability import Capability as Capability
    from mesa_mobility.crowd.pedestrian_model import PedestrianModel as PedestrianModel
    from mesa_mobility.crowd.people.pedestrian import Pedestrian as Pedestrian
    from mesa_mobility.crowd.planning.explanation import FREE as FREE
    from mesa_mobility.crowd.planning.explanation import PERSON as PERSON
    from mesa_mobility.crowd.planning.explanation import WALL as WALL
    from mesa_mobility.crowd.planning.explanation import Explanation as Explanation
    from mesa_mobility.crowd.planning.explanation import Watch as Watch
    from mesa_mobility.crowd.presets.files import read_preset as read_preset
    from mesa_mobility.crowd.presets.files import write_preset as write_preset
    from mesa_mobility.crowd.presets.given import model_rules as model_rules
    from mesa_mobility.crowd.presets.naming import ModelParameter as ModelParameter
    from mesa_mobility.crowd.presets.preset import Preset as Preset
    from mesa_mobility.crowd.presets.provenance import Provenance as Provenance
    from mesa_mobility.crowd.presets.shipped import PRESETS as PRESETS
    from mesa_mobility.crowd.tactics.deciding import Deciding as Deciding
    from mesa_mobility.crowd.tactics.deciding import Desired as Desired
    from mesa_mobility.crowd.tactics.route_choice import RouteChoice as RouteChoice
    from mesa_mobility.crowd.tactics.speed_rules import SpeedRule as SpeedRule
    from mesa_mobility.crowd.tactics.tactic import Tactic as Tactic
    from mesa_mobility.crowd.tactics.target_choice import TargetChoice as TargetChoice
    from mesa_mobility.crowd.types.pedestrian_type import PedestrianType as PedestrianType

__getattr__, __dir__ = names_of(__name__, __file__)
