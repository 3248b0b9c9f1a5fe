"""People who wait stand where they are: also those before a door that is shut for now."""

from __future__ import annotations

import numpy as np
import shapely

from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic

BEFORE = 0.6
"""Metres from a door that is shut for now, within which people wait for it."""


class Wait(Tactic):
    """People who wait, by ``Pedestrian.wait`` or before they set off, stand where they are.

    So do people who come to a door whose rate is used up.
    """

    name = "waiting"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """As for people without a route: they stop, and stay."""
        if deciding.site.shut and not desired.newcomers:
            self._hold_before_doors(deciding, desired)
        # Those who stand already may turn to something meanwhile (``Deciding.hold``).
        waits = deciding.waiting & (desired.speeds > 0.0)
        if not desired.newcomers and waits.any():
            desired.stand(waits, deciding.positions)

    def _hold_before_doors(self, deciding: Deciding, desired: Desired) -> None:
        """Hold those who are close to a shut door that they are to pass."""
        points = shapely.points(deciding.positions)
        before = np.zeros(len(points), dtype=np.bool_)
        for number, each in enumerate(deciding.site.plan.openings()):
            if each.name in deciding.site.shut:
                bound = desired.targets.gates == number
                before[bound] = shapely.dwithin(points[bound], each.line, BEFORE)
        if before.any():
            deciding.hold(desired, before)
