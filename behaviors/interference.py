"""Keeping away from neighbours: equation (2)."""

import math
from typing import Annotated

from mesa_mobility.behaviors.decay import decay

from mesa_mobility import CompiledTerm, Option, Other, Range, pair_kernel


@pair_kernel
def _interference(option: Option, other: Other, p: "Interference") -> float:
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    # Factors and not divisions, of which a processor does few at a time.
    d = math.sqrt(dx * dx + dy * dy) * (1.0 / (p.b * option.speed))
    counts = d < 40.0 and dx * option.facing_x + dy * option.facing_y >= 0.0
    return p.a * decay(d if counts else 0.0) if counts else 0.0


class Interference(CompiledTerm):
    """Keeps away from where other people will be.

    Sum over neighbours of P = a exp(-d / (b v)), equation (2): d is the distance from
    the mobility point to where the neighbour will be by then at constant velocity, v the
    speed of the option: who moves slowly accepts to be closer, and P tends to 0 with v.
    Neighbours behind the mobility point do not count.

    Args:
        weight: w_P.
        a: cost at contact; the paper's 10.5.
        b: range in seconds; the paper's 0.09.

    Raises:
        ModelError: a negative, or b not positive.
    """

    name = "interference"
    kernel = _interference

    def __init__(
        self,
        weight: float | None = None,
        a: Annotated[float, Range(0.0)] = 10.5,
        b: Annotated[float, Range(0.0, unit="s", above=True)] = 0.09,
    ) -> None:
        super().__init__(weight)
        self.a = a
        self.b = b
