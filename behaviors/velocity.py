"""Speed and velocity of an option: as fast as possible, as preferred, or as before."""

import math
from typing import Annotated

from numba import njit

from mesa_mobility import CompiledTerm, Me, Option, Options, Range, option_kernel


@option_kernel
def _displacement(option: Option) -> float:
    return -option.speed * option.duration


@option_kernel
def _preferred_speed(option: Option, me: Me) -> float:
    return 1.5 * abs(option.speed - me.preferred_speed)


@option_kernel
def _displacement_bound(options: Options) -> float:
    return -options.fastest * options.duration


@option_kernel
def _preferred_speed_bound(options: Options, me: Me) -> float:
    slower = me.preferred_speed - options.fastest
    return 1.5 * max(options.slowest - me.preferred_speed, slower, 0.0)


class Displacement(CompiledTerm):
    """Prefers options that go far, and so rewards speed without limit.

    -S of equation (1): minus the displacement in metres.
    On its own it makes everybody walk as fast as the recorded person ever did.
    """

    name = "displacement"
    kernel = _displacement
    bound = _displacement_bound


class PreferredSpeed(CompiledTerm):
    """Prefers options near the pedestrian's preferred speed.

    ``|S - v0 t| x 1.5 / t``: S is the displacement, v0 the preferred speed, t the
    option's duration.  In metres over the paper's 1.5 s whatever the duration, so that options of
    different durations compare.  Takes the place of ``Displacement``.
    """

    name = "preferred_speed"
    default_weight = 2.0
    kernel = _preferred_speed
    bound = _preferred_speed_bound


@njit(error_model="numpy")
def _off_preferred(vx: float, vy: float, dx: float, dy: float, preferred: float) -> float:
    # How far a velocity is from the preferred one towards a target that is (dx, dy) away, m/s.
    away = math.sqrt(dx * dx + dy * dy)
    along = preferred / away if away > 0.0 else 0.0
    vx = vx - along * dx
    vy = vy - along * dy
    return math.sqrt(vx * vx + vy * vy)


@option_kernel
def _preferred_velocity(option: Option, me: Me) -> float:
    vx = (option.x - me.x) / option.duration
    vy = (option.y - me.y) / option.duration
    dx = me.target_x - me.x
    dy = me.target_y - me.y
    return 1.5 * _off_preferred(vx, vy, dx, dy, me.preferred_speed)


@option_kernel
def _preferred_velocity_bound(options: Options, me: Me) -> float:
    vx = (options.x - me.x) / options.duration
    vy = (options.y - me.y) / options.duration
    dx = me.target_x - me.x
    dy = me.target_y - me.y
    off = _off_preferred(vx, vy, dx, dy, me.preferred_speed)
    return 1.5 * max(off - options.radius / options.duration, 0.0)


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


@njit(error_model="numpy")
def _huber(change: float, soft: float) -> float:
    return change * change * (0.5 / soft) if change < soft else change - 0.5 * soft


@option_kernel
def _velocity_change(option: Option, me: Me, p: "VelocityChange") -> float:
    vx = (option.x - me.x) / option.duration - me.vx
    vy = (option.y - me.y) / option.duration - me.vy
    own2 = me.vx * me.vx + me.vy * me.vy
    walking = min(math.sqrt(own2) * (1.0 / p.walking), 1.0)
    across = vx * me.vy - vy * me.vx
    turning2 = p.across * across * across / own2 if own2 > 0.0 else 0.0
    return walking * _huber(math.sqrt(vx * vx + vy * vy + turning2), p.softness)


@option_kernel
def _velocity_change_bound(options: Options, me: Me, p: "VelocityChange") -> float:
    vx = (options.x - me.x) / options.duration - me.vx
    vy = (options.y - me.y) / options.duration - me.vy
    own2 = me.vx * me.vx + me.vy * me.vy
    walking = min(math.sqrt(own2) * (1.0 / p.walking), 1.0)
    across = vx * me.vy - vy * me.vx
    turning2 = p.across * across * across / own2 if own2 > 0.0 else 0.0
    change2 = vx * vx + vy * vy
    spread = options.radius / options.duration
    # The norm grows by no more than the factor of turning a metre a second.
    least = math.sqrt(change2 + turning2) - math.sqrt(1.0 + p.across) * spread
    return walking * _huber(max(least, math.sqrt(change2) - spread, 0.0), p.softness)


class VelocityChange(CompiledTerm):
    """Prefers to walk on as before.

    ``h(|v - u|) min(|u| / w, 1)``: v is the mean velocity of the option, u that of the movement
    that has just ended, m/s, and w is ``walking``.  In the norm, the part of the difference across
    u counts ``turning`` times as much as that along it, which keeps people in a crowd on their way.
    Changes take effort.  Somebody who stands or creeps sets off at little cost: with the full
    difference, people who had stopped in a crowd stayed back, and waves of standing people lasted.
    h is Huber's loss: e^2 / (2 s) of a difference e up to s, ``softness``, and e - s / 2 beyond.
    With it people approach the velocity that they prefer by small changes.  Without, each change
    costs more than it gains once the weight is high, and whoever has been slowed down stays slow.

    Args:
        weight: factor in the sum.
        walking: speed from which on the difference counts in full, m/s.
        turning: how much more the difference across the way counts than that along it.
        softness: s, m/s; 0 for the difference itself.

    Raises:
        ModelError: a number out of range.
    """

    name = "velocity_change"
    default_weight = 1.0
    kernel = _velocity_change
    bound = _velocity_change_bound

    def __init__(
        self,
        weight: float | None = None,
        walking: Annotated[float, Range(0.0, unit="m/s", above=True)] = 0.6,
        turning: Annotated[float, Range(1.0)] = 1.5,
        softness: Annotated[float, Range(0.0, unit="m/s")] = 0.0,
    ) -> None:
        super().__init__(weight)
        self.walking = walking
        self.turning = turning
        self.softness = softness

    @property
    def across(self) -> float:
        """What the difference across the way adds to the square of the norm, as a factor."""
        return self.turning * self.turning - 1.0
