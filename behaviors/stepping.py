"""Waiting for room for a step instead of shuffling."""

import math
from typing import Annotated

from numba import njit

from mesa_mobility import CompiledTerm, Me, Option, Options, Range, option_kernel

STANDS = 0.01
"""A person who covers no more ground than this in a movement stands, metres."""

LONGEST = 1.5
"""The longest movement, seconds."""


@njit(error_model="numpy")
def _length(preferred: float, length: float) -> float:
    # Those who want to stand have no step of their own.
    return min(length, LONGEST * preferred) if preferred > 0.0 else length


@njit(error_model="numpy")
def _waiting(me: Me, ux: float, uy: float, length: float, waits_for: float) -> float:
    # What it costs to stand with a facing (ux, uy): nothing where somebody ahead may make room.
    dx = me.target_x - me.x
    dy = me.target_y - me.y
    way = math.sqrt(dx * dx + dy * dy)
    if me.ahead < waits_for or me.preferred_speed <= 0.0 or way <= 0.0:
        return 0.0
    turned = ((ux - math.cos(me.heading)) * dx + (uy - math.sin(me.heading)) * dy) / way
    lost = min(LONGEST * me.preferred_speed / length, 1.0)
    return lost * (1.0 - min(max(turned, 0.0), 1.0))


@option_kernel
def _stepping(option: Option, me: Me, p: "Stepping") -> float:
    ground = option.speed * option.duration
    if ground > STANDS:
        return max(1.0 - ground / _length(me.preferred_speed, p.length), 0.0)
    return _waiting(me, option.facing_x, option.facing_y, p.length, p.waits_for)


@option_kernel
def _stepping_bound(options: Options, me: Me, p: "Stepping") -> float:
    if options.fastest * options.duration <= STANDS:
        waiting = _waiting(me, options.facing_x, options.facing_y, p.length, p.waits_for)
        return max(waiting - options.turn, 0.0)
    if options.slowest * options.duration <= STANDS:
        return 0.0
    share = options.fastest * options.duration / _length(me.preferred_speed, p.length)
    return max(1.0 - share, 0.0)


class Stepping(CompiledTerm):
    """Avoids short steps: people wait until there is room for a proper one.

    1 - s / l for an option that covers s metres, 0 from l on and where one stays where one is.
    The effort of a step is mostly that of making one, so a short one is hardly worth it: people in
    a queue wait until there is room for one that is, and stand quietly until then. Of those who
    walk anyway it favours no option.

    Only people make room, walls do not.  So somebody who has nobody on the side of their target
    within ``waits_for`` gains nothing by standing, and it costs as much as the shortest step.
    Alone before a narrow corner, people else stood for half a minute.  Turning on the spot is a
    way to go on, and costs less by what the cosine of the angle between facing and target gains.
    Slow people, see below, lose a short step only: that share of ``length``.

    Slow people make short steps: for somebody who wants to cover less than ``length`` in the
    longest movement, 1.5 s, l is what they want to cover.  With the full length, people who want
    less than 0.2 m/s would stand for ever.

    Args:
        weight: factor in the sum.
        length: l of people who are not slow, metres from which on a step is worth its effort.
        waits_for: distance within which people wait for others, metres.

    Raises:
        ModelError: a number out of range.
    """

    name = "stepping"
    default_weight = 1.0
    kernel = _stepping
    bound = _stepping_bound

    def __init__(
        self,
        weight: float | None = None,
        length: Annotated[float, Range(0.0, unit="m", above=True)] = 0.4,
        waits_for: Annotated[float, Range(0.0, unit="m")] = 2.0,
    ) -> None:
        super().__init__(weight)
        self.length = length
        self.waits_for = waits_for
