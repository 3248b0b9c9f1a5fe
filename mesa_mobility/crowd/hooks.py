"""Hooks by which the parts of a model, and plug-ins, are bound to it, saved and restored."""

from __future__ import annotations

from abc import ABC
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from mesa_mobility.errors import ModelError

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


SHIPPED = "mesa_mobility."
"""How the names of modules begin whose behaviours are taken on trust."""

_OF_PRESETS = "mesa_mobility.crowd."


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


def check_behaviours(what: str, given: Iterable[object], kind: type[Plugin]) -> None:
    """Raise ModelError unless all are behaviours of a kind, with names."""
    for each in given:
        if not isinstance(each, kind):
            text = f"{each!r:.80}"
            raise ModelError(f"{what}: got {text}, expected an object of a {kind.__name__}")
        name = getattr(each, "name", None)
        if not (isinstance(name, str) and name):
            raise ModelError(
                f"{what}: {type(each).__name__} has the name {name!r}, expected a text"
            )


def ships(behaviour: Plugin) -> bool:
    """Whether a behaviour is the package's own."""
    return type(behaviour).__module__.startswith(SHIPPED)


def keeps_its_model(behaviour: Plugin) -> bool:
    """Whether a behaviour takes something from the model by which it is bound.

    Those of presets do, but are made for one model.
    """
    made_for_one = type(behaviour).__module__.startswith(_OF_PRESETS)
    return not made_for_one and type(behaviour).bind is not Plugin.bind
