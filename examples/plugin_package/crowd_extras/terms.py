"""Two cost terms: one in NumPy, one compiled."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Candidates, CompiledTerm, CostTerm, Option, Range, pair_kernel


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


# ``me`` and ``other`` are a Me and an Other with the field, a float: 1.0 for true.
@pair_kernel(fields=("infected",))
def _keep_away(option: Option, me: Any, other: Any, p: KeepAway) -> float:
    # Where the neighbour will be when the option ends:
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    room = p.distance - math.sqrt(dx * dx + dy * dy)
    return (1.0 - me.infected) * other.infected * room if room > 0.0 else 0.0


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

    # A parameter with a range is a setting: it is checked here and whenever it is set. The kernel
    # reads it as p.distance.
    def __init__(
        self, weight: float | None = None, distance: Annotated[float, Range(0.0, 10.0, "m")] = 1.5
    ) -> None:
        super().__init__(weight)
        self.distance = distance
