"""Where the numbers of one model come from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.presets.naming import (
    CODE,
    MOST_ACCELERATION,
    MOST_ACCELERATION_NAME,
    ModelParameter,
    named,
)
from mesa_mobility.crowd.presets.preset import Preset

BEHAVIOUR = "behaviour"
"""The source of a number that the file of a preset leaves as the behaviour has it."""


class Sources:
    """The numbers that a model was made with, and where each comes from.

    Args:
        base: the preset that was asked for.
        rules: the same, with the numbers that were given.
        given: values by name that were given beside it.
        source: of these.
        behaviours: made by ``rules``.
    """

    def __init__(
        self,
        base: Preset,
        rules: Preset,
        given: Mapping[str, Any],
        source: str,
        behaviours: Iterable[Plugin],
    ) -> None:
        self.base = base
        values = {MOST_ACCELERATION_NAME: rules.most_acceleration}
        values |= {name: getattr(made, each.name) for name, made, each in named(behaviours)}
        shipped = base.source == f"preset {base.name}"
        self._known: dict[str, tuple[Any, str]] = {}
        for name, value in values.items():
            said = shipped or base.states(name)
            own = source if name in given else base.source if said else BEHAVIOUR
            self._known[name] = value, own

    def listed(
        self, rules: Preset, behaviours: Iterable[Plugin] | None = None
    ) -> dict[str, ModelParameter]:
        """Every number by its name, with the value that it has now.

        Args:
            rules: the preset with the numbers that were given.
            behaviours: as they are now; by default those of the preset, made anew.
        """
        made = rules.behaviours() if behaviours is None else behaviours
        values = [(MOST_ACCELERATION_NAME, rules.most_acceleration, MOST_ACCELERATION)]
        values += [(name, getattr(of, each.name), each) for name, of, each in named(made)]
        found = {}
        for name, value, each in values:
            assert each.range is not None
            source = self.source(name, value)
            found[name] = ModelParameter(name, value, each.range.unit, each.range, source)
        return found

    def source(self, name: str, value: Any) -> str:
        """The source of a number that has a value now."""
        known = self._known.get(name)
        return known[1] if known is not None and known[0] == value else CODE

    def note(self, name: str, value: Any, source: str) -> None:
        """Note that a number was set."""
        self._known[name] = value, source
