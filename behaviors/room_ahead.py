"""Keeping room to walk on: not to end a movement facing a wall."""

import math
from typing import Annotated

from mesa_mobility.behaviors.stepping import STANDS

from mesa_mobility import CompiledTerm, Me, Option, Range, Wall, option_kernel


@option_kernel
def _room_ahead(option: Option, me: Me, wall: Wall, p: "RoomAhead") -> float:
    ux = option.facing_x
    uy = option.facing_y
    if option.speed * option.duration <= STANDS:
        dx = me.target_x - me.x
        dy = me.target_y - me.y
        way = math.sqrt(dx * dx + dy * dy)
        if way > 0.0:
            ux = dx / way
            uy = dy / way
    wx = wall.x2 - wall.x1
    wy = wall.y2 - wall.y1
    length = math.sqrt(wx * wx + wy * wy)
    slope = ux * wy - uy * wx
    if abs(slope) <= 1e-9 * length:
        return 0.0
    dx = wall.x1 - option.x
    dy = wall.y1 - option.y
    along = (dx * wy - dy * wx) / slope
    where = (dx * uy - dy * ux) / slope * length
    # How far the way straight on passes beside the end of the wall, at right angles to the way.
    beside = max(-where, where - length, 0.0) * abs(slope) / length
    if along <= 0.0 or beside >= me.core:
        return 0.0
    # The body touches the wall earlier, the more so the more gently the two meet.
    room = max(along - me.core * length / abs(slope), 0.0)
    return (1.0 - beside / me.core) * max(1.0 - room / max(option.speed * p.time, p.least), 0.0)


class RoomAhead(CompiledTerm):
    """Prefers options after which one can walk on in the direction faced.

    The cost is (1 - r / l) (1 - b / c) of the worst wall, where r is less than l and b less than c.
    r is how far a body gets that walks straight on from the mobility point, the way it faces,
    before its core, of radius c, touches the line of the wall. l is what the body covers in
    ``time`` at the speed of the option, at least ``least``. b is how far beside the end of the wall
    this way passes, 0 if it crosses the wall. The more of the core misses the wall, the less the
    wall counts: otherwise people would not find into gaps little wider than they are.

    An option that covers no ground is judged by the way to the target, wherever one faces.
    Otherwise people who turn on the spot in a narrow door would stay as they are, since halfway
    they face the jamb of the door. ``option_kernel`` says which walls are looked at.

    Without this term people end movements beside a wall and facing it, in states from which every
    next movement but standing hits the wall: the inevitable collision states of motion planning
    (Fraichard and Asama, Advanced Robotics 18 (2004) 1001-1024).

    Args:
        weight: factor in the sum.
        time: seconds.
        least: metres.

    Raises:
        ModelError: a number that is not finite and positive.
    """

    name = "room_ahead"
    default_weight = 3.0
    kernel = _room_ahead

    def __init__(
        self,
        weight: float | None = None,
        time: Annotated[float, Range(0.0, unit="s", above=True)] = 1.0,
        least: Annotated[float, Range(0.0, unit="m/s", above=True)] = 0.5,
    ) -> None:
        super().__init__(weight)
        self.time = time
        self.least = least
