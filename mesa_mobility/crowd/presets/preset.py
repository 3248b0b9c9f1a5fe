"""A preset: which terms, durations and constraints a model uses, the same in every scenario."""

from __future__ import annotations

import hashlib
import inspect
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.costs.terms import EXPECTED_WEIGHT, CostTerm, is_weight
from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.presets.naming import (
    CODE,
    MOST_ACCELERATION,
    MOST_ACCELERATION_NAME,
    OPTIONS,
    WEIGHT,
    as_value,
    named,
    unknown,
)
from mesa_mobility.crowd.presets.provenance import Provenance
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean, load_behavior

SCENE_FIRST = ("visits", "lifts", "speed_zones", "speed_rules")
"""Tactics by which people do what the scene says, before those of a preset."""

SCENE_LAST = ("waiting", "stepping_off")
"""The same, after those of a preset."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """A named set of rules: everything in which models with the same map and plan may differ.

    ``dataclasses.replace(PRESETS["default"], name="mine", durations=(12, 24))`` makes one of one's
    own from another.

    Attributes:
        name: for results; by which those that ship are selected.
        terms: weight of each registered cost term, by its name.
        target_choice: registered behaviour that gives people their targets.
        tactics: registered tactics, in order: the steps from a target to what people want of their
            next movement.  Those by which people do what the scene says (``SCENE_FIRST``,
            ``SCENE_LAST``) come before and after them, unless the preset names their place.
        group_pace: registered speed rule that keeps groups together.
        durations: option durations in frames.
        shares: shortened copies of the options of each cluster, as shares of the ground covered:
            first of the shortest ones, then of the next longer, and so on.
        most_acceleration: of an option, m/s2; those that exceed it are left out. None for all.
        hard_bodies: whether no two cores may overlap.
        settings: settings of terms, tactics, target choice and group pace that are not as the
            behaviour has them by default: values by name, by the behaviour's name.
        provenance: where the numbers come from, if somebody has noted it.
        origin: what the preset was read from, such as "preset default" or the name of a file, and
            what it ``said`` then; None for one that code has made.

    Raises:
        ModelError: a number out of range.
    """

    name: str
    terms: dict[str, float]
    target_choice: str
    tactics: tuple[str, ...]
    group_pace: str | None
    durations: tuple[int, ...]
    shares: tuple[tuple[float, ...], ...]
    most_acceleration: float | None
    hard_bodies: bool
    settings: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    provenance: Provenance | None = field(default=None, compare=False, repr=False)
    origin: tuple[str, str] | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        def refuse(what: str, got: object, expected: str) -> None:
            raise ModelError(f"preset {self.name!r}: {what} {got!r}, expected {expected}")

        if not isinstance(self.name, str) or not self.name:
            raise ModelError(f"preset: name {self.name!r}, expected a text")
        if not isinstance(self.terms, Mapping) or not all(
            is_weight(weight) for weight in self.terms.values()
        ):
            refuse("terms", self.terms, f"for the name of each {EXPECTED_WEIGHT}")
        if isinstance(self.tactics, str) or not all(isinstance(each, str) for each in self.tactics):
            refuse("tactics", self.tactics, "names of registered tactics, in order")
        if not isinstance(self.settings, Mapping) or not all(
            isinstance(each, Mapping) for each in self.settings.values()
        ):
            refuse("settings", self.settings, "for the name of each behaviour values by name")
        # As they are read from JSON, too.
        own = {name: dict(values) for name, values in self.settings.items() if values}
        object.__setattr__(self, "settings", own)
        object.__setattr__(self, "durations", tuple(self.durations))
        object.__setattr__(self, "tactics", tuple(self.tactics))
        object.__setattr__(self, "shares", tuple(tuple(each) for each in self.shares))
        if not self.durations or not all(
            is_number(each) and isinstance(each, int) and each > 0 for each in self.durations
        ):
            refuse("durations", self.durations, "frames, 1 or more each")
        most = self.most_acceleration
        if most is not None and not (is_number(most) and 0.0 < most < math.inf):
            refuse("most_acceleration", most, "None, or m/s2, more than 0")
        for share in (each for some in self.shares for each in some):
            if not (is_number(share) and 0.0 <= share < 1.0):
                refuse("share", share, "0 or more and less than 1")

    def numbers(self) -> dict[str, Any]:
        """All that the preset decides, ready for JSON."""
        return {
            "name": self.name,
            "terms": dict(self.terms),
            "target_choice": self.target_choice,
            "tactics": list(self.tactics),
            "group_pace": self.group_pace,
            "durations": list(self.durations),
            "shares": [list(each) for each in self.shares],
            "most_acceleration": self.most_acceleration,
            "hard_bodies": self.hard_bodies,
            "settings": {name: dict(values) for name, values in self.settings.items()},
        }

    @property
    def digest(self) -> str:
        """The sha256 of all that the preset decides, with the settings that it leaves as they are.

        The name does not count.

        Raises:
            ModelError: a behaviour is not installed.
        """
        numbers = self.numbers()
        del numbers["name"]
        numbers["tactics"] = self.all_tactics
        numbers["settings"] = {
            made.name: {each: repr(value) for each, value in made.settings().items()}
            for made in self.behaviours()
        }
        return _sha(numbers)

    @property
    def source(self) -> str:
        """What the preset was read from and has not been changed since, or "code"."""
        return CODE if self.origin is None or self.origin[1] != self.said else self.origin[0]

    @property
    def said(self) -> str:
        """The sha256 of what the preset itself says."""
        return _sha(self.numbers())

    @property
    def inputs_text(self) -> str:
        """Name, file and digest, as inputs of a run are listed."""
        own = self.source in (CODE, f"preset {self.name}")
        return f"{self.name if own else f'{self.name}, {self.source}'}, sha256 {self.digest}"

    @property
    def all_tactics(self) -> tuple[str, ...]:
        """Names of the preset's tactics and of those of every preset, in order."""
        first = (each for each in SCENE_FIRST if each not in self.tactics)
        last = (each for each in SCENE_LAST if each not in self.tactics)
        return (*first, *self.tactics, *last)

    def make_tactics(self) -> list[Tactic]:
        """All tactics in order, looked up among the installed behaviours."""
        return [self._made(name) for name in self.all_tactics]

    def make_target_choice(self) -> TargetChoice:
        """The target choice, looked up among the installed behaviours."""
        made: TargetChoice = self._made(self.target_choice)
        return made

    def make_group_paces(self) -> list[SpeedRule]:
        """The speed rules of a model with groups, looked up among the installed behaviours."""
        return [self._made(self.group_pace)] if self.group_pace else []

    def make_terms(self) -> list[CostTerm]:
        """The cost terms, looked up among the installed behaviours."""
        return [self._made(name, weight=weight) for name, weight in self.terms.items()]

    def behaviours(self) -> list[Plugin]:
        """All behaviours that the preset names, made anew.

        Raises:
            ModelError: one is not installed, or is no such behaviour, or settings do not fit.
        """
        made = [
            *self.make_terms(),
            *self.make_tactics(),
            self.make_target_choice(),
            *self.make_group_paces(),
        ]
        kinds = {
            "terms": (CostTerm, self.terms),
            "tactics": (Tactic, self.all_tactics),
            "target_choice": (TargetChoice, [self.target_choice]),
            "group_pace": (SpeedRule, [self.group_pace] if self.group_pace else []),
        }
        names = [name for _, of in kinds.values() for name in of]
        wanted = [(what, kind) for what, (kind, of) in kinds.items() for _ in of]
        for name, (what, kind), each in zip(names, wanted, made, strict=True):
            if not isinstance(each, kind):
                raise ModelError(f"{what}: {name!r} is no {kind.__name__}")
        if strangers := [name for name in self.settings if name not in names]:
            raise ModelError(
                f"settings: {strangers[0]!r} is no behaviour of the preset"
                f"{did_you_mean(strangers[0], dict.fromkeys(names))}"
            )
        return made

    def parameters(self) -> dict[str, Any]:
        """The value of each number by its name, such as "headway.time" and "headway.weight"."""
        values = {MOST_ACCELERATION_NAME: self.most_acceleration}
        return values | {
            name: getattr(made, each.name) for name, made, each in named(self.behaviours())
        }

    def states(self, name: str) -> bool:
        """Whether the preset says a number, and does not leave it as the behaviour has it."""
        behaviour, _, setting = name.partition(".")
        said = self.settings.get(behaviour, {})
        return setting == WEIGHT or behaviour == OPTIONS or setting in said

    def with_parameters(self, values: Mapping[str, Any]) -> Preset:
        """The preset with other numbers.

        Args:
            values: by name; a text stands for a number, as with `--set`.

        Raises:
            ModelError: an unknown name, or a value out of range.
        """
        if not values:
            return self
        known = {name: each for name, _, each in named(self.behaviours())}
        known[MOST_ACCELERATION_NAME] = MOST_ACCELERATION
        terms, settings = dict(self.terms), {key: dict(of) for key, of in self.settings.items()}
        most_acceleration = self.most_acceleration
        for name, given in values.items():
            if name not in known:
                raise unknown(name, known)
            value = as_value(name, known[name], given)
            behaviour, _, setting = name.partition(".")
            if behaviour == OPTIONS:
                most_acceleration = value
            elif setting == WEIGHT:
                terms[behaviour] = value
            else:
                settings.setdefault(behaviour, {})[setting] = value
        changed = replace(self, terms=terms, settings=settings, most_acceleration=most_acceleration)
        changed.behaviours()  # settings may each be in range and not fit together
        return changed

    def _made(self, name: str, **keywords: Any) -> Any:
        """A behaviour with the preset's settings."""
        kind, settings = load_behavior(name), self.settings.get(name, {})
        taken = inspect.signature(kind).parameters if settings else {}
        given = {key: value for key, value in settings.items() if key in taken}
        made = kind(**keywords, **given)
        for key in settings.keys() - given.keys():
            setattr(made, key, settings[key])
        return made


def _sha(numbers: Mapping[str, Any]) -> str:
    text = json.dumps(numbers, sort_keys=True, default=repr)
    return hashlib.sha256(text.encode()).hexdigest()
