"""People walk as fast as the speed rules of their model say."""

from __future__ import annotations

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.speed_rules import apply_speed_rules
from mesa_mobility.crowd.tactics.tactic import Tactic


class FollowSpeedRules(Tactic):
    """People walk as fast as the model's speed rules say."""

    name = "speed_rules"

    _model: World

    def bind(self, model: World) -> None:
        """Keep the model, whose rules may change."""
        self._model = model

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Apply the rules in order."""
        desired.speeds = apply_speed_rules(self._model.speed_rules, deciding, desired.speeds)
