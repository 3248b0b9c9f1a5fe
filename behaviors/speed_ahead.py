"""Walking as fast as the people ahead."""

import math
from typing import Annotated

from mesa_mobility.behaviors.decay import decay
from mesa_mobility.behaviors.right_of_way import OPPOSED

from mesa_mobility import CompiledTerm, Me, Option, Other, Range, pair_kernel


@pair_kernel
def _speed_ahead(option: Option, me: Me, other: Other, p: "SpeedAhead") -> float:
    ex = me.target_x - me.x
    ey = me.target_y - me.y
    way = math.sqrt(ex * ex + ey * ey)
    ex = ex / way if way > 0.0 else 0.0
    ey = ey / way if way > 0.0 else 0.0
    dx = other.x - me.x
    dy = other.y - me.y
    ahead = dx * ex + dy * ey
    # By factors that all neighbours share: a processor does few divisions at a time.
    share = 1.0 - abs(dy * ex - dx * ey) * (1.0 / p.width)
    oncoming = ex * other.way_x + ey * other.way_y < -OPPOSED
    counts = ahead > 0.0 and ahead < way and share > 0.0 and not oncoming
    own = ((option.x - me.x) * ex + (option.y - me.y) * ey) / option.duration
    theirs = other.vx * ex + other.vy * ey
    far = max(ahead - p.gap, 0.0) * (1.0 / p.range)
    return share * abs(own - theirs) * decay(far) if counts else 0.0


class SpeedAhead(CompiledTerm):
    """Prefers to walk as fast as the people ahead.

    Sum over neighbours ahead of ``|v - u| s exp(-(d - g) / r)``: v and u are the speeds of the
    option and of the neighbour along the way to the target, d is how far ahead the neighbour is
    now, g the gap up to which they count in full and r the range over which that falls. s is 1
    straight ahead and 0 at ``width`` to the side. People beyond the target do not count, nor do
    oncoming people, as of ``RightOfWay``: nobody follows those who come the other way.
    People who take over the speed of those ahead keep the gap as it is, so that small changes do
    not grow on their way back through a queue (Treiber and Kesting, Traffic Flow Dynamics,
    chapter 15).

    Args:
        weight: factor in the sum.
        width: metres to the side from which on neighbours do not count.
        gap: g, metres between the middles of two people.
        range: r, metres.

    Raises:
        ModelError: a number out of range.
    """

    name = "speed_ahead"
    kernel = _speed_ahead

    def __init__(
        self,
        weight: float | None = None,
        width: Annotated[float, Range(0.0, unit="m", above=True)] = 0.35,
        gap: Annotated[float, Range(0.0, unit="m")] = 0.3,
        range: Annotated[float, Range(0.0, unit="m", above=True)] = 1.0,
    ) -> None:
        super().__init__(weight)
        self.width = width
        self.gap = gap
        self.range = range
