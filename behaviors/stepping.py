"""Standing still rather than shuffling."""

from mesa_mobility import CompiledTerm, bound_kernel, option_kernel

STANDS = 0.01
"""Whoever covers no more ground than this in a movement stands, metres."""


@option_kernel
def _stepping(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    return 1.0 if speed * duration > STANDS else 0.0


@bound_kernel
def _stepping_bound(  # type: ignore[no-untyped-def]
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, preferred, p
):
    return 1.0 if slowest * duration > STANDS else 0.0


class Stepping(CompiledTerm):
    """1 where an option covers ground, 0 where one stays where one is.

    A step is an effort, however short: people in a queue wait until there is room for one that is
    worth it and stand quietly until then. Of those who walk anyway it favours no option.
    """

    name = "stepping"
    default_weight = 0.35
    kernel = _stepping
    bound = _stepping_bound
