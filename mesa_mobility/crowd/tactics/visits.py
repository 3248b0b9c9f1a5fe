"""Slowing down before a place at which one is to stand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.journeys.journeys import Journeys
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.schema import Kind

STOPPING = 3.0
"""Seconds from full speed to standing.

183 people who stopped at urban intersections did so most often early and on purpose, over about
3 s or six steps on average (Analysis on termination of pedestrians' gait at urban intersections,
IEEE Conference on Intelligent Transportation Systems 2014).
"""


def slow_down(speeds: NDArray[np.float64], remaining: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) speeds from which people come to stand at the end of their way, m/s.

    At the constant deceleration v0 / ``STOPPING`` somebody at full speed v0 needs
    v0 ``STOPPING`` / 2 to stand, and their speed is v0 times the square root of the share of
    this stretch that remains.

    Args:
        speeds: (n,) full speeds, m/s.
        remaining: (n,) metres to where each is to stand.
    """
    braking = speeds * STOPPING / 2.0
    slower = np.sqrt(2.0 * speeds / STOPPING * np.clip(remaining, 0.0, braking))
    found: NDArray[np.float64] = np.where(remaining < braking, np.minimum(speeds, slower), speeds)
    return found


class StayAtPlaces(Tactic):
    """People slow down before a place of their route at which they stay, and walk to where they
    stand there. Before a place that is full they wait."""

    name = "visits"
    saved: ClassVar[Mapping[str, Kind]] = {}  # the journeys are the model's

    _journeys: Journeys

    def bind(self, model: World) -> None:
        """Keep who goes where, and who stays."""
        self._journeys = model.journeys

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those who have arrived to their spot, and slow down those who come near theirs."""
        rows = deciding.pedestrians
        bound = np.flatnonzero(self._journeys.to_stay(rows, deciding.inside.crowd))
        if desired.newcomers or not len(bound):
            return
        remaining = desired.targets.distances.copy()
        who, spots = self._journeys.stays.spots(rows)
        if len(who):
            desired.points = desired.points.copy()
            desired.points[who] = spots
            remaining[who] = np.hypot(*(spots - deciding.positions[who]).T)
        desired.speeds = desired.speeds.copy()
        desired.speeds[bound] = slow_down(desired.speeds[bound], remaining[bound])
        in_line = self._journeys.stays.in_line(rows)
        if in_line.any():
            deciding.hold(desired, in_line)
