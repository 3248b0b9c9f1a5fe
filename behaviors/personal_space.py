"""Personal space: keeping a little room between bodies."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Other, Range, pair_kernel


@pair_kernel
def _personal_space(option: Option, me: Me, other: Other, p: "PersonalSpace") -> float:
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    return max(p.room + me.core + other.core - math.sqrt(dx * dx + dy * dy), 0.0)


class PersonalSpace(CompiledTerm):
    """Prefers to keep a little room between bodies, on all sides.

    Sum over neighbours of the metres by which ``room`` is missing between the core of the person
    and that of the neighbour, where both will be when the option ends, at constant velocity of the
    neighbour.

    In a jam people spread by this term, as far as the room ahead of them lets them. Without it they
    crowd to 8 persons/m2 before a narrow opening, where 3.5 to 6 are measured, and block each
    other.

    Args:
        weight: factor in the sum.
        room: metres between two bodies.

    Raises:
        ModelError: a number out of range.
    """

    name = "personal_space"
    default_weight = 4.0
    kernel = _personal_space

    def __init__(
        self,
        weight: float | None = None,
        room: Annotated[float, Range(0.0, unit="m", above=True)] = 0.32,
    ) -> None:
        super().__init__(weight)
        self.room = room
