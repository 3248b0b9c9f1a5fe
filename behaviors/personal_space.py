"""Personal space: keeping a little room to other bodies and to walls."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Other, Range, Wall, option_kernel, pair_kernel


@pair_kernel
def _between_bodies(option: Option, me: Me, other: Other, p: "PersonalSpace") -> float:
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    return max(1.0 - (math.sqrt(dx * dx + dy * dy) - me.core - other.core) / p.room, 0.0)


@option_kernel
def _to_a_wall(option: Option, me: Me, wall: Wall, p: "PersonalSpace") -> float:
    wx = wall.x2 - wall.x1
    wy = wall.y2 - wall.y1
    length2 = wx * wx + wy * wy
    along = (option.x - wall.x1) * wx + (option.y - wall.y1) * wy
    share = min(max(along / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    dx = option.x - wall.x1 - share * wx
    dy = option.y - wall.y1 - share * wy
    return max(1.0 - (math.sqrt(dx * dx + dy * dy) - me.core) / (0.5 * p.room), 0.0)


class PersonalSpace(CompiledTerm):
    """Prefers to keep a little room around the body.

    Around each body lies a ring, half of ``room`` wide. The term is the share of the room that is
    missing where two rings overlap, summed over neighbours, and the share of the ring that is
    missing to the nearest wall. Bodies are where they will be when the option ends, at constant
    velocity of the neighbour.

    In a jam people spread by this term, as far as the room ahead of them lets them. Without it
    people before an exit change their direction and step aside more than measured people do.

    Args:
        weight: factor in the sum.
        room: metres between the cores of two bodies; half as many between a core and a wall.

    Raises:
        ModelError: a number out of range.
    """

    name = "personal_space"
    default_weight = 1.3
    kernel = _between_bodies
    walls = _to_a_wall

    def __init__(
        self,
        weight: float | None = None,
        room: Annotated[float, Range(0.0, unit="m", above=True)] = 0.32,
    ) -> None:
        super().__init__(weight)
        self.room = room
