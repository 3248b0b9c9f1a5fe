"""Speed and velocity of an option: as fast as possible, as preferred, or as before."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Range, bound_kernel, option_kernel


@option_kernel
def _displacement(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, preferred: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    return -speed * duration


@option_kernel
def _preferred_speed(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, preferred: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    return 1.5 * abs(speed - preferred)


@bound_kernel
def _displacement_bound(
    x: float, y: float, radius: float, ux: float, uy: float, turn: float, duration: float,
    slowest: float, fastest: float, sx: float, sy: float, tx: float, ty: float, preferred: float,
    p: tuple[float, ...],
) -> float:  # fmt: skip
    return -fastest * duration


@bound_kernel
def _preferred_speed_bound(
    x: float, y: float, radius: float, ux: float, uy: float, turn: float, duration: float,
    slowest: float, fastest: float, sx: float, sy: float, tx: float, ty: float, preferred: float,
    p: tuple[float, ...],
) -> float:  # fmt: skip
    return 1.5 * max(slowest - preferred, preferred - fastest, 0.0)


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


@option_kernel
def _preferred_velocity(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, preferred: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    dx = tx - sx
    dy = ty - sy
    away = math.sqrt(dx * dx + dy * dy)
    along = preferred / away if away > 0.0 else 0.0
    vx = (x - sx) / duration - along * dx
    vy = (y - sy) / duration - along * dy
    return 1.5 * math.sqrt(vx * vx + vy * vy)


@bound_kernel
def _preferred_velocity_bound(
    x: float, y: float, radius: float, ux: float, uy: float, turn: float, duration: float,
    slowest: float, fastest: float, sx: float, sy: float, tx: float, ty: float, preferred: float,
    p: tuple[float, ...],
) -> float:  # fmt: skip
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


@option_kernel(own_velocity=True)
def _velocity_change(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, preferred: float, own_vx: float, own_vy: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    vx = (x - sx) / duration - own_vx
    vy = (y - sy) / duration - own_vy
    own2 = own_vx * own_vx + own_vy * own_vy
    walking = min(math.sqrt(own2) * (1.0 / p[0]), 1.0)
    across = vx * own_vy - vy * own_vx
    turning2 = p[1] * across * across / own2 if own2 > 0.0 else 0.0
    return walking * math.sqrt(vx * vx + vy * vy + turning2)


@bound_kernel(own_velocity=True)
def _velocity_change_bound(
    x: float, y: float, radius: float, ux: float, uy: float, turn: float, duration: float,
    slowest: float, fastest: float, sx: float, sy: float, tx: float, ty: float, preferred: float,
    own_vx: float, own_vy: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    vx = (x - sx) / duration - own_vx
    vy = (y - sy) / duration - own_vy
    own2 = own_vx * own_vx + own_vy * own_vy
    walking = min(math.sqrt(own2) * (1.0 / p[0]), 1.0)
    across = vx * own_vy - vy * own_vx
    turning2 = p[1] * across * across / own2 if own2 > 0.0 else 0.0
    change2 = vx * vx + vy * vy
    spread = radius / duration
    # The norm grows by no more than the factor of turning a metre a second.
    least = math.sqrt(change2 + turning2) - math.sqrt(1.0 + p[1]) * spread
    return walking * max(least, math.sqrt(change2) - spread, 0.0)


class VelocityChange(CompiledTerm):
    """Prefers to walk on as before.

    ``|v - u| min(|u| / w, 1)``: v is the mean velocity of the option, u that of the movement that
    has just ended, m/s, and w is ``walking``.  In the norm, the part of the difference across u
    counts ``turning`` times as much as that along it, which keeps people in a crowd on their way.
    Changes take effort.  Somebody who stands or creeps sets off at little cost: with the full
    difference, people who had stopped in a crowd stayed back, and waves of standing people lasted.

    Args:
        weight: factor in the sum.
        walking: speed from which on the difference counts in full, m/s.
        turning: how much more the difference across the way counts than that along it.

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
    ) -> None:
        super().__init__(weight)
        self.walking = walking
        self.turning = turning

    def parameters(self) -> tuple[float, ...]:
        """``walking``, and the square of ``turning`` less 1."""
        return (self.walking, self.turning * self.turning - 1.0)
