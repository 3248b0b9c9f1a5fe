"""The behaviours of a model in a checkpoint."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any

from mesa_mobility.crowd.checkpoint.plain import Packer
from mesa_mobility.crowd.hooks import SHIPPED, Plugin
from mesa_mobility.crowd.model.crowd_model import CrowdModel
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins import registry


def behaviours_of(model: CrowdModel) -> dict[str, list[Plugin]]:
    """The behaviours of a model as lists, by the keys of these lists in a checkpoint."""
    return {
        "terms": list(model.terms),
        "speed_rules": list(model.speed_rules),
        "target_choice": [model.target_choice],
        "tactics": list(model.tactics),
    }


def pack_behaviour(behaviour: Plugin, packer: Packer) -> dict[str, Any]:
    """Class, name and state of a behaviour.

    Raises:
        ModelError: its state cannot be saved.
    """
    where = f"behaviour {behaviour.name!r}"
    state = {key: packer.pack(value, f"{where}, {key}") for key, value in behaviour.state().items()}
    return {
        "class": class_name(type(behaviour)),
        "name": behaviour.name,
        "state": {"$": ["dict", list(map(list, state.items()))]},
    }


def match_behaviours(
    model: CrowdModel, saved: Mapping[str, Any], plugins: Iterable[Plugin]
) -> None:
    """Give a model the behaviours that it had, those of its constructor before others.

    Raises:
        ModelError: one of them is nowhere to be found.
    """
    there = [each for group in behaviours_of(model).values() for each in group]
    there += plugins

    def find(wanted: Mapping[str, Any]) -> Any:
        for k, each in enumerate(there):
            if class_name(type(each)) == wanted["class"]:
                return there.pop(k)
        installed = registry.behaviors().get(wanted["name"])
        kind = installed.load() if installed is not None else _shipped(wanted["class"])
        if kind is not None and class_name(kind) == wanted["class"]:
            return kind()
        raise ModelError(
            f"behaviour {wanted['name']!r} ({wanted['class']}) is neither installed nor made by "
            f"the constructor of {type(model).__name__}, expected load(path, plugins=[...]) with it"
        )

    model.terms[:] = [find(each) for each in saved["terms"]]
    model.speed_rules[:] = [find(each) for each in saved["speed_rules"]]
    model.target_choice = find(saved["target_choice"][0])
    model.tactics[:] = [find(each) for each in saved["tactics"]]


def _shipped(name: str) -> type[Plugin] | None:
    """The behaviour of this class name if the package's public modules have it."""
    module, _, kind = name.partition(":")
    if not module.startswith(SHIPPED) or "._" in module:
        return None
    try:
        found = getattr(import_module(module), kind, None)
    except ImportError:
        return None
    return found if isinstance(found, type) and issubclass(found, Plugin) else None


def class_name(kind: type) -> str:
    """Where a class is, as ``module:name``."""
    return f"{kind.__module__}:{kind.__qualname__}"
