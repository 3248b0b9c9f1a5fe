"""Waiting for room for a step instead of shuffling."""

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


@option_kernel
def _stepping(option: Option, me: Me, p: "Stepping") -> float:
    ground = option.speed * option.duration
    share = ground / _length(me.preferred_speed, p.length)
    return max(1.0 - share, 0.0) if ground > STANDS else 0.0


@option_kernel
def _stepping_bound(options: Options, me: Me, p: "Stepping") -> float:
    share = options.fastest * options.duration / _length(me.preferred_speed, p.length)
    return max(1.0 - share, 0.0) if options.slowest * options.duration > STANDS else 0.0


class Stepping(CompiledTerm):
    """Avoids short steps: people wait until there is room for a proper one.

    1 - s / l for an option that covers s metres, 0 from l on and where one stays where one is.
    The effort of a step is mostly that of making one, so a short one is hardly worth it: people in
    a queue wait until there is room for one that is, and stand quietly until then. Of those who
    walk anyway it favours no option.

    Slow people make short steps: for somebody who wants to cover less than ``length`` in the
    longest movement, 1.5 s, l is what they want to cover.  With the full length, people who want
    less than 0.2 m/s would stand for ever.

    Args:
        weight: factor in the sum.
        length: l of people who are not slow, metres from which on a step is worth its effort.

    Raises:
        ModelError: a length out of range.
    """

    name = "stepping"
    default_weight = 1.0
    kernel = _stepping
    bound = _stepping_bound

    def __init__(
        self,
        weight: float | None = None,
        length: Annotated[float, Range(0.0, unit="m", above=True)] = 0.4,
    ) -> None:
        super().__init__(weight)
        self.length = length
