"""Somebody whom the page's reader steers with keys."""

from __future__ import annotations

import math

import numpy as np

from mesa_mobility import PedestrianModel
from mesa_mobility.live.order_tactics import follow_orders
from mesa_mobility.live.orders import Orders


class ByHand:
    """Steering of a model's people, one at a time.

    A model gets the tactics for it when somebody is steered first; until then it is as it was made.

    Args:
        model: the model.

    Attributes:
        row: of the person who is steered, or -1.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self.row = -1
        self._model = model
        self._orders: Orders | None = None

    def steer(self, row: int, direction: tuple[float, float]) -> None:
        """Let somebody walk in a direction at its preferred speed; it stands for (0, 0).

        Whoever was steered before goes on as before. Nobody is steered who is not inside.
        """
        if row != self.row:
            self.release()
        model, length = self._model, math.hypot(*direction)
        if not (0 <= row < model.population.count and model.crowd.active[row]):
            return
        if not math.isfinite(length):
            return
        if self._orders is None:
            self._orders = follow_orders(model)
        speed = float(model.crowd.agenda["speed"][row]) / length if length else 0.0
        self._orders.steer(np.array([row]), (speed * direction[0], speed * direction[1]))
        self.row = row

    def release(self) -> None:
        """Let the person who is steered go on as before."""
        row, self.row = self.row, -1
        if self._orders is not None and row >= 0 and self._model.crowd.active[row]:
            self._orders.release(np.array([row]))
