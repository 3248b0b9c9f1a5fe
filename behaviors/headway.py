"""Keeping a distance to those ahead."""

import math
from typing import Annotated, Any

from mesa_mobility.behaviors.stepping import STANDS

from mesa_mobility import CompiledTerm, Option, Other, Range, pair_kernel

TREADS = 1.5
"""Treads that people on stairs keep more than elsewhere from those ahead."""


# ``me`` is a Me with the fields ``pace`` and ``tread``.
@pair_kernel(fields=("pace", "tread"))
def _headway(option: Option, me: Any, other: Other, p: "Headway") -> float:
    wx = me.target_x - me.x
    wy = me.target_y - me.y
    way2 = wx * wx + wy * wy
    mx = option.facing_x
    my = option.facing_y
    if option.speed * option.duration <= STANDS:
        way = math.sqrt(way2)
        mx = wx / way if way > 0.0 else 0.0
        my = wy / way if way > 0.0 else 0.0
    dx = other.x + other.vx * option.duration - option.x
    dy = other.y + other.vy * option.duration - option.y
    ahead = dx * mx + dy * my
    # By factors that all neighbours share: a processor does few divisions at a time.
    share = 1.0 - abs(dy * mx - dx * my) * (1.0 / p.width)
    excess = option.speed - me.pace * (ahead - p.distance - TREADS * me.tread) * (1.0 / p.time)
    if ahead <= 0.0 or share <= 0.0 or excess <= 0.0:
        return 0.0
    if (other.x - me.x) * wx + (other.y - me.y) * wy >= way2:
        share = share * p.beyond
    soft = p.softness
    counts = excess * excess * (0.5 / soft) if excess < soft else excess - 0.5 * soft
    return 1.5 * share * counts


class Headway(CompiledTerm):
    """Keeps a distance from people ahead that grows with speed.

    The cost is a sum over neighbours ahead. Each counts by how much faster an option is than the
    room to the neighbour allows: e = v - s (d - l) / T, where this is positive. v is the speed of
    the option. d is how far ahead of the mobility point the neighbour will be when the option ends,
    at constant velocity. l is the distance that people keep when they stand, and T the time gap
    when they walk. Ahead is where one faces at the mobility point or, for an option that covers no
    ground, where one's target is: nobody makes room by looking elsewhere.

    s is the share of their speed at which the ground lets people walk. In speed zones people keep
    the same distances at a lower speed, so flows fall as speeds do. In the SFPE Handbook, too,
    speeds on stairs are a share of those on a level floor at every density (chapter on employing
    the hydraulic model). On stairs l is a tread and a half longer. A body needs the tread before
    it. People step over a whole tread or not at all, so half a tread stays empty on average.

    The cost of a neighbour is 1.5 h(e), in metres over the 1.5 s of the paper. h is Huber's loss
    (Annals of Mathematical Statistics 35 (1964) 73-101): e^2 / (2 b) for e up to b, ``softness``,
    and e - b / 2 beyond. If all costs were linear, their sum would be least at a kink. A small
    change of the room ahead would then take people from one kink to another: from the speed that
    the room allows to the speed that they prefer.

    A neighbour straight ahead counts in full, one ``width`` to the side not at all. The speed that
    the room ahead allows is that of the collision-free speed model of Tordeux, Chraibi and Seyfried
    (Traffic and Granular Flow '15). Equation (2) of the paper alone lets people stand as close as
    their bodies are wide.

    Args:
        weight: factor in the sum.
        distance: l, metres between the middles of two people.
        time: T, seconds.
        width: metres.
        softness: b, m/s.
        beyond: how much people beyond the target count. At 0 people come up to a door or to the end
            of a queue as if nobody stood behind it.

    Raises:
        ModelError: a number out of range.
    """

    name = "headway"
    default_weight = 1.5
    kernel = _headway

    def __init__(
        self,
        weight: float | None = None,
        distance: Annotated[float, Range(0.0, unit="m", above=True)] = 0.36,
        time: Annotated[float, Range(0.0, unit="s", above=True)] = 1.2,
        width: Annotated[float, Range(0.0, unit="m", above=True)] = 0.35,
        softness: Annotated[float, Range(0.0, unit="m/s", above=True)] = 0.15,
        beyond: Annotated[float, Range(0.0, 1.0)] = 1.0,
    ) -> None:
        super().__init__(weight)
        self.distance = distance
        self.time = time
        self.width = width
        self.softness = softness
        self.beyond = beyond
