"""Tactics: the steps from a target to what people want of their next movement."""

from __future__ import annotations

from abc import abstractmethod
from typing import ClassVar

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired


class Tactic(Plugin):
    """A behaviour that changes what deciding pedestrians want: where to go, and how fast.

    Subclasses set ``name`` and define ``apply``. A model applies those in ``model.tactics`` in
    order.

    Attributes:
        after: name of the tactic behind which ``PedestrianModel.add_tactic`` puts this one; by
            default it goes to the end.
    """

    after: ClassVar[str | None] = None

    @abstractmethod
    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change points and speeds for the next movement.

        Args:
            deciding: the pedestrians who decide.
            desired: what they want so far.
        """

    def compile_ahead(self) -> None:
        """Compile what ``apply`` calls, with nobody; called before a run, which then need not wait.

        It may be called without ``bind``.
        """
