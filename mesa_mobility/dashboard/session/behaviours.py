"""Behaviours that are switched on and off, and weighted, while a model runs."""

from __future__ import annotations

import inspect
from dataclasses import dataclass

from mesa_mobility import CostTerm, MobilityError, PedestrianModel, TargetChoice
from mesa_mobility.plugins import registry


@dataclass(frozen=True)
class TermState:
    """A behaviour as the page shows it.

    Attributes:
        name: of the term.
        description: the first line of its docstring, and its settings.
        on: whether the model uses it.
        weight: its factor, used or not.
    """

    name: str
    description: str
    on: bool
    weight: float


@dataclass(frozen=True)
class ChoiceState:
    """The target choice as the page shows it.

    Attributes:
        name: of the target choice that the model uses.
        names: names of all that it could use.
    """

    name: str
    names: tuple[str, ...]


class Behaviours:
    """The behaviours of a model, and all other installed ones.

    Attributes:
        wanted: name -> (on, weight) of those that have been changed.
        wanted_choice: name of the target choice if it has been changed, or "".
    """

    def __init__(self) -> None:
        self._terms: dict[str, CostTerm] = {}
        self._choices: dict[str, TargetChoice] = {}
        self.wanted: dict[str, tuple[bool, float]] = {}
        self.wanted_choice = ""

    def adopt(self, model: PedestrianModel, *, keep: bool) -> None:
        """Take over the behaviours of a new model; ``keep`` the changes made for the one before."""
        installed = _installed()
        self._terms = {term.name: term for term in model.terms}
        self._choices = {model.target_choice.name: model.target_choice}
        for behaviour in installed:
            if isinstance(behaviour, CostTerm):
                self._terms.setdefault(behaviour.name, behaviour)
            else:
                self._choices.setdefault(behaviour.name, behaviour)
        if not keep:
            self.wanted.clear()
            self.wanted_choice = ""
        self.apply(model)

    def apply(self, model: PedestrianModel) -> None:
        """Apply the changes to the model."""
        # A page's address may name behaviours that are not installed here.
        for name in self.wanted.keys() & self._terms.keys():
            self._set(model, name, *self.wanted[name])
        if self.wanted_choice in self._choices:
            self.choose(model, self.wanted_choice)

    def choose(self, model: PedestrianModel, name: str) -> None:
        """Use another target choice, from each person's next decision on."""
        model.target_choice = self._choices[name]
        self.wanted_choice = name

    def choice(self, model: PedestrianModel) -> ChoiceState:
        """The target choice in use, and the others."""
        return ChoiceState(model.target_choice.name, tuple(self._choices))

    def set(self, model: PedestrianModel, name: str, on: bool, weight: float) -> None:
        """Use a behaviour or not, with a weight.

        Raises:
            ModelError: the weight is not finite, or too large.
        """
        self._set(model, name, on, weight)
        self.wanted[name] = (on, weight)

    def states(self, model: PedestrianModel) -> tuple[TermState, ...]:
        """All behaviours, the model's own first."""
        return tuple(
            TermState(
                term.name,
                _described(term),
                term in model.terms,
                term.weight,
            )
            for term in self._terms.values()
        )

    def _set(self, model: PedestrianModel, name: str, on: bool, weight: float) -> None:
        term = self._terms[name]
        term.weight = weight
        if on and term not in model.terms:
            model.terms.append(term)
        if not on and term in model.terms:
            model.terms.remove(term)


def _described(term: CostTerm) -> str:
    """What a term is, and its settings as they are."""
    first = (inspect.getdoc(type(term)) or "").partition("\n")[0]
    settings = ", ".join(f"{name} {value}" for name, value in CostTerm.settings(term).items())
    return f"{first} ({settings})" if settings else first


def _installed() -> list[CostTerm | TargetChoice]:
    """An instance of each installed cost term and target choice that needs no arguments."""
    made: list[CostTerm | TargetChoice] = []
    for plugin in registry.behaviors().values():
        try:
            kind = plugin.load()
            if issubclass(kind, CostTerm | TargetChoice):
                made.append(kind())
        # A broken plug-in, or one that needs arguments; `mesa-mobility behaviors` lists them.
        except (MobilityError, TypeError):
            continue
    return made
