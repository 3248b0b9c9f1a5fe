"""Going to the target, and facing it: the first two terms of equation (1)."""

import math

from numba import njit

from mesa_mobility import CompiledTerm, Me, Option, Options, option_kernel


@option_kernel
def _distance(option: Option, me: Me) -> float:
    dx = me.target_x - option.x
    dy = me.target_y - option.y
    return math.sqrt(dx * dx + dy * dy)


@option_kernel
def _distance_bound(options: Options, me: Me) -> float:
    dx = me.target_x - options.x
    dy = me.target_y - options.y
    return max(math.sqrt(dx * dx + dy * dy) - options.radius, 0.0)


@njit(error_model="numpy")
def _angle(along: float, across: float) -> float:
    # The angle from its tangent by the polynomial 4.4.49 of Abramowitz and Stegun, to 2e-8 rad:
    # unlike a call of atan2, arithmetic alone runs for several options at once.
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


@option_kernel
def _deviation(option: Option, me: Me) -> float:
    dx = me.target_x - option.x
    dy = me.target_y - option.y
    ux = option.facing_x
    uy = option.facing_y
    return _angle(ux * dx + uy * dy, abs(ux * dy - uy * dx))


@option_kernel
def _deviation_bound(options: Options, me: Me) -> float:
    dx = me.target_x - options.x
    dy = me.target_y - options.y
    ux = options.facing_x
    uy = options.facing_y
    # Seen from within the radius, the target is off by no more than the arc sine of share; its
    # tangent is more and needs no call.
    share2 = options.radius * options.radius / max(dx * dx + dy * dy, 1e-300)
    seen = math.sqrt(share2 / (1.0 - share2)) if share2 < 0.9 else math.pi
    off = _angle(ux * dx + uy * dy, abs(ux * dy - uy * dx))
    return max(off - options.turn - seen, 0.0)


class TargetDistance(CompiledTerm):
    """Prefers options that end near the target.

    D of equation (1): metres from the mobility point to the target.
    """

    name = "target_distance"
    kernel = _distance
    bound = _distance_bound


class FacingDeviation(CompiledTerm):
    """Prefers options that end facing the target.

    theta of equation (1): angle between facing and target at the mobility point.  Radians,
    0 to pi, exact to 2e-8; 0 where the mobility point is the target itself.
    """

    name = "facing_deviation"
    default_weight = 0.5
    kernel = _deviation
    bound = _deviation_bound
