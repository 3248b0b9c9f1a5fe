"""Presets: which terms, durations and constraints a model uses, the same in every scenario."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.costs.terms import EXPECTED_WEIGHT, CostTerm, is_weight
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import load_behavior


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
            next movement.
        group_pace: registered speed rule that keeps groups together.
        durations: option durations in frames.
        shares: shortened copies of the options of each cluster, as shares of the ground covered:
            first of the shortest ones, then of the next longer, and so on.
        most_acceleration: of an option, m/s2; those that exceed it are left out. None for all.
        hard_bodies: whether no two cores may overlap.

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
        # As they are read from JSON, too.
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
            **asdict(self),
            "terms": dict(self.terms),
            "tactics": list(self.tactics),
            "durations": list(self.durations),
            "shares": [list(each) for each in self.shares],
        }

    def make_tactics(self) -> list[Tactic]:
        """The tactics in order, looked up among the installed behaviours."""
        return [load_behavior(name)() for name in self.tactics]

    def make_target_choice(self) -> TargetChoice:
        """The target choice, looked up among the installed behaviours."""
        return load_behavior(self.target_choice)()

    def make_group_paces(self) -> list[SpeedRule]:
        """The speed rules of a model with groups, looked up among the installed behaviours."""
        return [load_behavior(self.group_pace)()] if self.group_pace else []

    def make_terms(self) -> list[CostTerm]:
        """The cost terms, looked up among the installed behaviours."""
        return [load_behavior(name)(weight=weight) for name, weight in self.terms.items()]


PRESETS = {
    # Equation (1) as printed.  The paper does not give w_D, w_theta and w_S; 1, 0.5 and 1
    # make a metre of progress, a metre of displacement and two radians weigh the same.
    "paper": Preset(
        name="paper",
        terms={
            "target_distance": 1.0,
            "facing_deviation": 0.5,
            "displacement": 1.0,
            "interference": 1.0,
        },
        target_choice="nearest_exit",
        tactics=("visits", "speed_zones", "speed_rules", "waiting"),
        group_pace=None,
        durations=(45,),
        shares=(),
        most_acceleration=None,
        hard_bodies=False,
    ),
    # The same terms and constants, but a preferred velocity in place of unlimited reward, bodies
    # that do not overlap and make way, options short and slow enough for a queue to move and none
    # that starts abruptly, and people who look ahead and walk steadily.
    "default": Preset(
        name="default",
        terms={
            "target_distance": 0.6,
            "facing_deviation": 1.25,
            "preferred_velocity": 2.75,
            "velocity_change": 1.3,
            "sideways": 2.2,
            "room_ahead": 2.0,
            "interference": 1.0,
            "headway": 2.6,
            "right_of_way": 1.2,
            "stepping": 1.3,
        },
        target_choice="nearest_exit",
        tactics=(
            "corner_spreading",
            "visits",
            "speed_zones",
            "speed_rules",
            "giving_way",
            "waiting",
            "speed_compensation",
            "anticipation",
            "speed_adaptation",
            "stepping_off",
        ),
        group_pace="walk_together",
        durations=(12, 24, 45),
        shares=((0.75, 0.5, 0.25, 0.0), (0.75, 0.5, 0.25)),
        most_acceleration=0.95,
        hard_bodies=True,
    ),
}


def preset_named(name: str) -> Preset:
    """The preset of this name.

    Raises:
        ModelError: there is none.
    """
    if name not in PRESETS:
        raise ModelError(f"preset {name!r} is unknown, expected one of {', '.join(PRESETS)}")
    return PRESETS[name]


def read_preset(preset: str | Preset) -> Preset:
    """A preset, or the one of this name.

    Raises:
        ModelError: there is none, or it is something else.
    """
    if isinstance(preset, Preset):
        return preset
    if not isinstance(preset, str):
        raise ModelError(f"preset: got {preset!r}, expected a name or a Preset")
    return preset_named(preset)
