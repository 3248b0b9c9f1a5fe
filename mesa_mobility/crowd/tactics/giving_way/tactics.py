"""The tactics by which people take turns and give way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.giving_way.precedence import WIDE, Precedence
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.turns import Turns, find_mouths, give_turns
from mesa_mobility.floorplan.routing.passages import Passages
from mesa_mobility.schema import Kind


class _OfTheCrowd(Tactic):
    """A tactic that keeps its notes in the crowd's records."""

    _crowd: Crowd

    def bind(self, model: World) -> None:
        """Keep the crowd."""
        self._crowd = model.crowd


class TakeTurns(_OfTheCrowd):
    """People take turns where two cannot pass each other."""

    name = "taking_turns"

    _turns: Turns

    def bind(self, model: World) -> None:
        """Look for narrow passages."""
        super().bind(model)
        self._turns = Turns(model.floor_plan)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return self._turns.members()

    def state(self) -> dict[str, Any]:
        """Who has the turn where."""
        return self._turns.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._turns.restore(state)
        self._turns.check_mouths(self._crowd)

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Let people wait where others have the turn."""
        if not desired.newcomers:
            desired.points, desired.speeds = self._turns.take(
                deciding.pedestrians,
                deciding.inside.pedestrians,
                deciding.frame,
                self._crowd,
                desired.points,
                desired.speeds,
            )

    def compile_ahead(self) -> None:
        """Compile the search for those before a passage."""
        nobody, crowd = np.empty(0, dtype=np.int64), Crowd(2)
        ends = np.zeros(1, dtype=np.int64)
        passages = Passages(np.empty((0, 6)), ends, np.empty((0, 2)), ends, np.empty((0, 4)))
        find_mouths(nobody, passages, crowd.records, crowd.agenda, np.empty((0, 2)))
        allowed = np.empty(0, dtype=np.bool_)
        give_turns(nobody, 0.0, passages, crowd.agenda, nobody, np.empty(0), allowed)


class GiveWay(_OfTheCrowd):
    """Wide people go one after the other through openings too narrow for two of them."""

    name = "giving_way"

    _precedence: Precedence | None = None

    def bind(self, model: World) -> None:
        """Keep the crowd; without wide types there is nothing to do."""
        super().bind(model)
        widest = max(each.half_width for each in model.pedestrian_types)
        if widest > WIDE:
            self._precedence = Precedence(model.floor_plan, widest)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {} if self._precedence is None else self._precedence.members()

    def state(self) -> dict[str, Any]:
        """Who goes first where."""
        return {} if self._precedence is None else self._precedence.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        if self._precedence is not None:
            self._precedence.restore(state)

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Let wide people wait clear of openings where another goes first."""
        if self._precedence is not None and not desired.newcomers:
            desired.points, desired.speeds = self._precedence.heed(
                deciding.pedestrians,
                deciding.inside.pedestrians,
                deciding.frame,
                self._crowd,
                desired.points,
                desired.speeds,
            )
