"""Which behaviours a model has bound, and that each of them serves one model."""

from __future__ import annotations

from typing import Protocol
from weakref import WeakValueDictionary

from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.hooks import Plugin, World, check_behaviours, keeps_its_model
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.errors import ModelError

# The bindings of the model that has bound a behaviour last, by the behaviour's identity.
_SERVES: WeakValueDictionary[int, Bindings] = WeakValueDictionary()


class Behaving(World, Protocol):
    """A model with its behaviours, which may change at any time."""

    terms: list[CostTerm]
    tactics: list[Tactic]
    speed_rules: list[SpeedRule]
    target_choice: TargetChoice


class Bindings:
    """The behaviours that a model has bound."""

    def __init__(self) -> None:
        self._bound: list[Plugin] = []
        self._keeping: list[Plugin] = []

    def bind(self, model: Behaving) -> None:
        """Bind behaviours that have come in since the last time, and look at all their names.

        Raises:
            ModelError: two cost terms of one name for people of one type, something that is no
                behaviour or has no name, or a behaviour that serves another model by now.
        """
        now = [*model.terms, *model.speed_rules, model.target_choice, *model.tactics]
        if now == self._bound:
            self._check_shared()
            return
        check_behaviours("terms", model.terms, CostTerm)
        check_behaviours("speed_rules", model.speed_rules, SpeedRule)
        check_behaviours("target_choice", [model.target_choice], TargetChoice)
        check_behaviours("tactics", model.tactics, Tactic)
        for kind in model.pedestrian_types:
            names = [term.name for term in model.terms if term.is_for(kind.name)]
            for name in names:
                if names.count(name) > 1:
                    raise ModelError(
                        f"terms: two of them are named {name!r}, expected names of their own"
                    )
        known = set(map(id, self._bound))
        self._bound, self._keeping = now, [each for each in now if keeps_its_model(each)]
        for each in now:
            if id(each) not in known:
                _SERVES[id(each)] = self
                each.bind(model)

    def _check_shared(self) -> None:
        """Raise ModelError where another model has bound a behaviour of this one meanwhile."""
        for each in self._keeping:
            if _SERVES.setdefault(id(each), self) is not self:
                raise ModelError(
                    f"behaviour {each.name!r}: serves another model by now, expected an object of "
                    "its own for each model"
                )
