"""The preferred velocity: speed and direction."""

import math

from mesa_mobility import CompiledTerm, bound_kernel, option_kernel


@option_kernel
def _preferred_velocity(  # type: ignore[no-untyped-def]
    x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p
):
    dx = tx - sx
    dy = ty - sy
    away = math.sqrt(dx * dx + dy * dy)
    along = preferred / away if away > 0.0 else 0.0
    vx = (x - sx) / duration - along * dx
    vy = (y - sy) / duration - along * dy
    return 1.5 * math.sqrt(vx * vx + vy * vy)


@bound_kernel
def _preferred_velocity_bound(  # type: ignore[no-untyped-def]
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, preferred, p
):
    dx = tx - sx
    dy = ty - sy
    away = math.sqrt(dx * dx + dy * dy)
    along = preferred / away if away > 0.0 else 0.0
    vx = (x - sx) / duration - along * dx
    vy = (y - sy) / duration - along * dy
    return 1.5 * max(math.sqrt(vx * vx + vy * vy) - radius / duration, 0.0)


class PreferredVelocity(CompiledTerm):
    """Prefers to walk straight to the target at the preferred speed.

    ``|S - v0 e t| x 1.5 / t``: S is the displacement, e the unit vector to the target,
    v0 the preferred speed and t the option's duration.  In metres over the
    paper's 1.5 s whatever the duration, so that options of different durations compare.
    """

    name = "preferred_velocity"
    default_weight = 2.0
    kernel = _preferred_velocity
    bound = _preferred_velocity_bound
