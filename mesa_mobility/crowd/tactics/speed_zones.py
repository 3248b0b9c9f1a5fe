"""Speed zones of the floor plan."""

from __future__ import annotations

import numpy as np

from mesa_mobility.crowd.options.table import LONGEST_MOVEMENT_S
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.floorplan.floor.zones import ground_ahead


class SlowInZones(Tactic):
    """People walk more slowly in the speed zones of the floor plan."""

    name = "speed_zones"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Multiply speeds by the mean factor on the way ahead, and note the ground there."""
        zones = deciding.site.plan.zones
        if zones:
            way = desired.points - deciding.positions
            way *= (desired.speeds * LONGEST_MOVEMENT_S / np.maximum(np.hypot(*way.T), 1e-9))[
                :, None
            ]
            factors, treads = ground_ahead(zones, deciding.positions, deciding.positions + way)
            desired.speeds = desired.speeds * factors
            agenda = deciding.inside.crowd.agenda
            agenda["pace"][deciding.pedestrians] = factors
            agenda["tread"][deciding.pedestrians] = treads
