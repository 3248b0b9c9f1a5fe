"""Keeping a hand's breadth from walls."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Range, Wall, option_kernel


@option_kernel
def _wall_distance(option: Option, me: Me, wall: Wall, p: "WallDistance") -> float:
    wx = wall.x2 - wall.x1
    wy = wall.y2 - wall.y1
    length2 = wx * wx + wy * wy
    along = (option.x - wall.x1) * wx + (option.y - wall.y1) * wy
    share = min(max(along / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    dx = option.x - wall.x1 - share * wx
    dy = option.y - wall.y1 - share * wy
    room = math.sqrt(dx * dx + dy * dy) - me.core
    return max(1.0 - room / p.within, 0.0)


class WallDistance(CompiledTerm):
    """Prefers options that end with some room between body and walls.

    ``1 - r / w`` of the nearest wall, as far as r is less than w: r is the distance from the core
    to the wall at the mobility point and w is ``within``.

    Args:
        weight: factor in the sum.
        within: w, metres.

    Raises:
        ModelError: ``within`` is not finite and positive.
    """

    name = "wall_distance"
    kernel = _wall_distance

    def __init__(
        self,
        weight: float | None = None,
        within: Annotated[float, Range(0.0, unit="m", above=True)] = 0.15,
    ) -> None:
        super().__init__(weight)
        self.within = within
