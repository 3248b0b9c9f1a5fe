"""Keeping out of the way of others: the right of way."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Other, Range, pair_kernel
from mesa_mobility.errors import ModelError

# Cosine of the least angle between the ways of two people who come towards each other, 120 degrees:
# those from either side of a door do not, though each is left of the other's way.
OPPOSED = 0.5


@pair_kernel
def _right_of_way(option: Option, me: Me, other: Other, p: "RightOfWay") -> float:
    dx = option.x - other.x
    dy = option.y - other.y
    along = dx * other.way_x + dy * other.way_y
    aside = dy * other.way_x - dx * other.way_y
    ahead_x = me.target_x - me.x
    ahead_y = me.target_y - me.y
    against = -(ahead_x * other.way_x + ahead_y * other.way_y)
    oncoming = against > OPPOSED * math.sqrt(ahead_x * ahead_x + ahead_y * ahead_y)
    counts = along > 0.0 and (oncoming or (other.lead > 0.0 and along < p.ahead))
    middle = p.bias if oncoming else 0.0
    # By factors that all neighbours share: a processor does few divisions at a time.
    narrow = 1.0 / p.width
    wide = 1.0 / (p.width + abs(p.bias))
    off = abs(aside + middle) * (wide if oncoming else narrow)
    return (1.0 if oncoming else p.beside) * max(1.0 - off, 0.0) if counts else 0.0


class RightOfWay(CompiledTerm):
    """Makes way for people who have priority.

    The cost is the sum over neighbours who have priority of how far a mobility point is in their
    way. Oncoming people have priority, so that both make way: those whose way is at more than 120
    degrees to one's own. People who have less far to go have priority over those right beside them,
    so that two who want the same gap do not both block it. The cost is 1 on the line from an
    oncoming neighbour to their target, ``beside`` on the line of a neighbour who goes the same way,
    and falls to 0 at ``width`` from the line. Oncoming people are passed on the right: on the wrong
    side the cost reaches ``2 bias`` farther, and it is greatest at ``bias`` from the line. How far
    ahead of an oncoming person a point is does not count: this term is a reason to step aside, not
    to stay back.

    By this term people who walk the same way form lanes. Moussaid et al., Proc. R. Soc. B 276
    (2009), measured that people make way sidewards, and rather to one side.

    Args:
        weight: factor in the sum.
        width: metres between the middles of two people who pass with room.
        bias: metres; negative where people pass on the left.
        ahead: metres ahead of a neighbour who goes the same way that count as their way.
        beside: what being in the way of a neighbour of the same way costs.

    Raises:
        ModelError: a number that is not finite, ``width`` no more than ``bias``, or ``ahead``
            or ``beside`` negative.
    """

    name = "right_of_way"
    default_weight = 3.0
    kernel = _right_of_way

    def __init__(
        self,
        weight: float | None = None,
        width: Annotated[float, Range(0.0, unit="m", above=True)] = 0.4,
        bias: Annotated[float, Range(-100.0, 100.0, "m")] = 0.1,
        ahead: Annotated[float, Range(0.0, unit="m")] = 0.5,
        beside: Annotated[float, Range(0.0)] = 0.5,
    ) -> None:
        super().__init__(weight)
        self.width = width
        self.bias = bias
        self.ahead = ahead
        self.beside = beside

    def check_settings(self) -> None:
        """Raise ModelError unless the way is wider than people keep to a side of it."""
        if self.width <= abs(self.bias):
            raise ModelError(
                f"right_of_way: width {self.width} m, expected more than the bias, {self.bias} m"
            )
