"""Keeping apart from everybody who is not of one's own group."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Other, Range, pair_kernel


@pair_kernel
def _keep_distance(option: Option, me: Me, other: Other, p: "KeepDistance") -> float:
    if me.group > 0.0 and me.group == other.group:
        return 0.0
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    room = p.distance - math.sqrt(dx * dx + dy * dy)
    return room if room > 0.0 else 0.0


class KeepDistance(CompiledTerm):
    """Keeps a distance from others, as people were asked to in the pandemic of 2020.

    Sum over neighbours of the metres by which an option ends nearer to them than ``distance``,
    where they will be by then at constant velocity. Members of one group do not keep apart.

    The 1.5 m are those that Germany and the Netherlands asked for in 2020.

    Args:
        weight: factor in the sum.
        distance: metres between the middles of two people.

    Raises:
        ModelError: a distance that is not finite and positive.
    """

    name = "keep_distance"
    default_weight = 2.0
    kernel = _keep_distance

    def __init__(
        self,
        weight: float | None = None,
        distance: Annotated[float, Range(0.0, unit="m", above=True)] = 1.5,
    ) -> None:
        super().__init__(weight)
        self.distance = distance
