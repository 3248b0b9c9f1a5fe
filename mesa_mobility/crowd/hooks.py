"""Hooks by which the parts of a model, and plug-ins, are bound to it, saved and restored."""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


def scheduled_events(model: object) -> int:
    """Events that a model of a newer Mesa has to come; models of Mesa 3.3 keep none."""
    owner = getattr(model, "_scheduler", model)
    events = getattr(owner, "_event_list", ())
    return len(events) if hasattr(events, "__len__") else 0


class Saved:
    """A part of a model that goes into a checkpoint.

    Attributes:
        saved: names of the attributes that change while a model runs.
    """

    saved: ClassVar[tuple[str, ...]]

    def state(self) -> dict[str, Any]:
        """All that changes while a model runs."""
        return {name: getattr(self, name) for name in self.saved}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given, in this process or another."""
        for name in self.saved:
            setattr(self, name, state[name])


class Plugin(ABC):
    """What all behaviours have in common: a name, and three hooks that may be overridden.

    Attributes:
        name: unique name, as it is registered and shown.
    """

    name: ClassVar[str]

    def bind(self, model: PedestrianModel) -> None:  # noqa: B027
        """Called once by each model before it uses the behaviour.

        Args:
            model: the model, whose ``floor_plan``, ``crowd`` and ``agents`` the behaviour may keep.
        """

    def state(self) -> dict[str, Any]:
        """All that the behaviour needs to go on from a checkpoint; by default its attributes.

        Numbers, texts, arrays, lists and dictionaries of them, geometries, distributions and
        generators can be saved, and the model itself, its plan and its people.
        """
        return dict(vars(self))

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given, in this process or another."""
        vars(self).update(state)
