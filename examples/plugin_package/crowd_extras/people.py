"""Agents with a step of their own."""

from __future__ import annotations

from mesa_mobility import Pedestrian, PedestrianModel


class Patient(Pedestrian):
    """Somebody who may catch an infection from people nearby, 1 % a step for each within 1 m.

    Attributes:
        caught_at: simulated seconds at which it did, or None.
    """

    infected: bool  # a field of the model

    def __init__(self, model: PedestrianModel, row: int) -> None:
        super().__init__(model, row)
        self.caught_at: float | None = None

    def step(self) -> None:
        """Called once a step of the model, before anybody moves."""
        if self.infected:
            return
        near, _ = self.get_neighbors_in_radius(1.0)
        risk = 0.01 * sum(other.infected for other in near if other is not self)
        if risk > 0.0 and self.model.rng.random() < risk:
            self.infected = True
            self.caught_at = self.model.elapsed
