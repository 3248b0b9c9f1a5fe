"""People who wait stand where they are."""

from __future__ import annotations

from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic


class Wait(Tactic):
    """People who wait, by ``Pedestrian.wait`` or before they set off, stand where they are."""

    name = "waiting"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """As for people without a route: they stop, and stay."""
        # Those who stand already may turn to something meanwhile (``Deciding.hold``).
        waits = deciding.waiting & (desired.speeds > 0.0)
        if not desired.newcomers and waits.any():
            desired.stand(waits, deciding.positions)
