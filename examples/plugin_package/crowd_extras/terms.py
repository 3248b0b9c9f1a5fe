"""Two cost terms: one in NumPy, one compiled."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Candidates, CompiledTerm, CostTerm, Range, pair_kernel


class KeepLeft(CostTerm):
    """Options that lead to the right of the way to the target cost more, by the metre."""

    name = "keep_left"
    default_weight = 0.3

    def cost(self, candidates: Candidates) -> NDArray[np.float64]:
        """(n,) metres to the right of the way."""
        way = candidates.targets - candidates.positions
        way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
        step = candidates.points - candidates.positions[candidates.owner]
        ahead = way[candidates.owner]
        right: NDArray[np.float64] = ahead[:, 1] * step[:, 0] - ahead[:, 0] * step[:, 1]
        return right


@pair_kernel(fields=("infected",))
def _keep_away(
    x: float, y: float, facing_x: float, facing_y: float, duration: float, speed: float,
    start_x: float, start_y: float, target_x: float, target_y: float, their_x: float,
    their_y: float, their_vx: float, their_vy: float, their_ex: float, their_ey: float,
    lead: float, infected: float, their_infected: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    # Fields come as floats: 1.0 for true. Where the neighbour will be when the option ends:
    dx = their_x + their_vx * duration - x
    dy = their_y + their_vy * duration - y
    room = p[0] - math.sqrt(dx * dx + dy * dy)
    return (1.0 - infected) * their_infected * room if room > 0.0 else 0.0


class KeepAway(CompiledTerm):
    """Those who are not infected keep a distance from those who are.

    The cost is by how many metres an option ends nearer than ``distance`` to each of them. It
    takes the field ``infected``, which the model must declare.

    Args:
        weight: factor in the sum.
        distance: metres.
    """

    name = "keep_away"
    default_weight = 2.0
    kernel = _keep_away

    # A parameter with a range is a setting: it is checked here and whenever it is set.
    def __init__(
        self, weight: float | None = None, distance: Annotated[float, Range(0.0, 10.0, "m")] = 1.5
    ) -> None:
        super().__init__(weight)
        self.distance = distance

    def parameters(self) -> tuple[float, ...]:
        """``(distance,)``."""
        return (self.distance,)
