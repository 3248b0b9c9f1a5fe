"""Going to the target, and facing it: the first two terms of equation (1)."""

import math

from mesa_mobility import CompiledTerm, option_kernel


@option_kernel
def _distance(x, y, ux, uy, duration, speed, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    dx = tx - x
    dy = ty - y
    return math.sqrt(dx * dx + dy * dy)


@option_kernel
def _deviation(x, y, ux, uy, duration, speed, tx, ty, preferred, p):  # type: ignore[no-untyped-def]
    # The angle from its tangent by the polynomial 4.4.49 of Abramowitz and Stegun, to 2e-8 rad:
    # unlike a call of atan2, arithmetic alone runs for several options at once.
    dx = tx - x
    dy = ty - y
    along = ux * dx + uy * dy
    across = abs(ux * dy - uy * dx)
    ahead = abs(along)
    most = max(across, ahead)
    t = min(across, ahead) / (most if most > 0.0 else 1.0)
    q = t * t
    angle = 0.0028662257
    angle = angle * q - 0.0161657367
    angle = angle * q + 0.0429096138
    angle = angle * q - 0.0752896400
    angle = angle * q + 0.1065626393
    angle = angle * q - 0.1420889944
    angle = angle * q + 0.1999355085
    angle = angle * q - 0.3333314528
    angle = (angle * q + 1.0) * t
    angle = 0.5 * math.pi - angle if across > ahead else angle
    return math.pi - angle if along < 0.0 else angle


class TargetDistance(CompiledTerm):
    """D of equation (1): distance in metres from the mobility point to the target."""

    name = "target_distance"
    kernel = _distance


class FacingDeviation(CompiledTerm):
    """theta of equation (1): angle between facing and target at the mobility point.

    Radians, 0 to pi, exact to 2e-8; 0 where the mobility point is the target itself.
    """

    name = "facing_deviation"
    default_weight = 0.5
    kernel = _deviation
