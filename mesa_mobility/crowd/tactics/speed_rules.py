"""Speed rules: behaviours that change preferred speeds."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.tactics.deciding import Deciding
from mesa_mobility.crowd.tactics.unchanged import Given
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_given

FASTEST = 100.0
"""Highest preferred speed that is accepted, m/s."""


class SpeedRule(Plugin):
    """A behaviour that changes the preferred speed of a pedestrian's next movement.

    Subclasses set ``name`` and define ``speeds``.  A model applies those in ``model.speed_rules``
    in order; each gets the speeds that the one before returned.
    """

    @abstractmethod
    def speeds(self, deciding: Deciding, speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) preferred speeds for the next movement, m/s, at least 0.

        Args:
            deciding: the pedestrians who decide.
            speeds: (n,) preferred speeds without this behaviour, m/s.
        """


def apply_speed_rules(
    speed_rules: Iterable[SpeedRule], deciding: Deciding, speeds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Apply all speed rules in order and check what they return; (n,) m/s.

    Raises:
        ModelError: speeds that are negative or not finite, or an array of another shape.
    """
    given = Given(deciding)
    for pace in speed_rules:
        giver, outside = f"behaviour {pace.name!r}", given.keep(pace)
        new = numbers_given(giver, "speeds", pace.speeds(deciding, speeds), speeds.shape)
        if outside:
            given.check(pace)
        off = ~((new >= 0.0) & (new <= FASTEST))
        if off.any():
            raise ModelError(
                f"{giver}: gave a speed of {new[off][0]} m/s, expected 0 to {FASTEST:g}"
            )
        speeds = new
    return speeds
