"""Presets: which terms, durations and constraints a model uses, the same in every scenario."""

from __future__ import annotations

from dataclasses import dataclass

from mesa_mobility.crowd.pace import Pace
from mesa_mobility.crowd.target_choice import TargetChoice
from mesa_mobility.crowd.terms import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.registry import load_behavior


@dataclass(frozen=True)
class Preset:
    """A named set of rules.

    Attributes:
        name: as it is asked for.
        terms: weight of each registered cost term.
        target_choice: registered behaviour that gives people their targets.
        group_pace: registered behaviour that keeps groups together, where there are any.
        durations: option durations in frames.
        shares: shortened copies of the shortest options, as shares of the ground they cover.
        cores: whether bodies are hard.
        abreast: whether a crowd spreads out to pass a corner.
        impatience: whether people who get nowhere look for a way round.
        even_pace: whether whoever walks freely makes up for steps longer or shorter than it likes.
    """

    name: str
    terms: dict[str, float]
    target_choice: str
    group_pace: str | None
    durations: tuple[int, ...]
    shares: tuple[float, ...]
    cores: bool
    abreast: bool
    impatience: bool
    even_pace: bool

    def make_target_choice(self) -> TargetChoice:
        """The target choice, looked up among the installed behaviours."""
        return load_behavior(self.target_choice)()

    def make_group_paces(self) -> list[Pace]:
        """What a model with groups needs, looked up among the installed behaviours."""
        return [load_behavior(self.group_pace)()] if self.group_pace else []

    def make_terms(self) -> list[CostTerm]:
        """The cost terms, looked up among the installed behaviours."""
        return [load_behavior(name)(weight=weight) for name, weight in self.terms.items()]


PRESETS = {
    # Equation (1) as printed.  The paper does not give w_D, w_theta and w_S; 1, 0.5 and 1
    # put a metre of progress, a metre of displacement and two radians of deviation on a par.
    "paper": Preset(
        name="paper",
        terms={
            "target_distance": 1.0,
            "facing_deviation": 0.5,
            "displacement": 1.0,
            "interference": 1.0,
        },
        target_choice="nearest_exit",
        group_pace=None,
        durations=(45,),
        shares=(),
        cores=False,
        abreast=False,
        impatience=False,
        even_pace=False,
    ),
    # The same terms and constants, but a velocity of one's own in place of reward without
    # limit, bodies that do not overlap and make way, and options short enough for a queue to move.
    "default": Preset(
        name="default",
        terms={
            "target_distance": 1.0,
            "facing_deviation": 1.2,
            "preferred_velocity": 2.0,
            "interference": 1.0,
            "headway": 1.5,
            "right_of_way": 3.0,
            "stepping": 1.0,
        },
        target_choice="nearest_exit",
        group_pace="walk_together",
        durations=(12, 24, 45),
        shares=(0.5, 0.25, 0.0),
        cores=True,
        abreast=True,
        impatience=True,
        even_pace=True,
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
