"""Going to the target, and facing it: the first two terms of equation (1)."""

import math

from mesa_mobility import CompiledTerm, option_kernel


@option_kernel
def _distance(x, y, heading, displacement, duration, speed, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    return math.hypot(tx - x, ty - y)


@option_kernel
def _deviation(x, y, heading, displacement, duration, speed, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    dx = tx - x
    dy = ty - y
    if dx == 0.0 and dy == 0.0:
        return 0.0
    turn = math.atan2(dy, dx) - heading
    return abs(math.atan2(math.sin(turn), math.cos(turn)))


class TargetDistance(CompiledTerm):
    """D of equation (1): distance in metres from the mobility point to the target."""

    name = "target_distance"
    kernel = _distance


class FacingDeviation(CompiledTerm):
    """theta of equation (1): angle between facing and target at the mobility point.

    Radians, 0 to pi; 0 where the mobility point is the target itself.
    """

    name = "facing_deviation"
    default_weight = 0.5
    kernel = _deviation
