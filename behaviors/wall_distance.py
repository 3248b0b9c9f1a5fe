"""Keeping away from walls."""

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
    return max(1.0 - math.sqrt(dx * dx + dy * dy) / p.within, 0.0)


class WallDistance(CompiledTerm):
    """Prefers options that end some way from walls.

    ``1 - d / w`` of the nearest wall, as far as d is less than w: d is the distance from the middle
    of the body to the wall at the mobility point and w is ``within``.  Wide bodies so keep less
    room between themselves and the wall: if all kept the same, two people in wheelchairs would
    both keep to the middle of a narrow corridor and never pass each other.

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
        within: Annotated[float, Range(0.0, unit="m", above=True)] = 0.3,
    ) -> None:
        super().__init__(weight)
        self.within = within
