"""`--behavior NAME[=WEIGHT]`: installed behaviours, switched on for one run."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import load_behavior

if TYPE_CHECKING:
    from mesa_mobility import PedestrianModel


def use_behaviors(model: PedestrianModel, texts: Iterable[str]) -> None:
    """Let a model use installed behaviours besides its own.

    A cost term, a speed rule or a tactic is added, or given another weight where the model has it;
    a target choice takes the place of the model's.

    Args:
        model: the model.
        texts: name of each, with ``=WEIGHT`` for a cost term that is not to have its own weight.

    Raises:
        ModelError: an unknown name, a weight that is none, or a model without behaviours.
    """
    from mesa_mobility import CostTerm, PedestrianModel, SpeedRule, Tactic, TargetChoice

    for text in texts:
        if not isinstance(model, PedestrianModel):
            raise ModelError(f"--behavior {text}: {type(model).__name__} is no PedestrianModel")
        name, equals, weight = text.partition("=")
        kind = load_behavior(name.strip())
        try:
            made = kind()
        except TypeError as error:
            raise ModelError(
                f"--behavior {text}: cannot be made without arguments ({error})"
            ) from None
        if equals and not isinstance(made, CostTerm):
            raise ModelError(f"--behavior {text}: has no weight, expected {name} alone")
        if isinstance(made, CostTerm):
            there = next((term for term in model.terms if term.name == made.name), None)
            if there is None:
                model.terms.append(made)
            if equals:
                (there or made).weight = _number(text, weight)
        elif isinstance(made, SpeedRule):
            if made.name not in [rule.name for rule in model.speed_rules]:
                model.speed_rules.append(made)
        elif isinstance(made, Tactic):
            if made.name not in [tactic.name for tactic in model.tactics]:
                model.add_tactic(made)
        elif isinstance(made, TargetChoice):
            model.target_choice = made
        else:
            raise ModelError(f"--behavior {text}: {kind.__name__} is no behaviour")


def _number(text: str, weight: str) -> float:
    try:
        return float(weight)
    except ValueError:
        raise ModelError(f"--behavior {text}: weight {weight!r}, expected a number") from None
