"""Avoiding collisions that are still some seconds away."""

import math

from mesa_mobility import CompiledTerm, pair_bound_kernel, pair_kernel
from mesa_mobility.errors import ModelError

# From the slowest relative speed that counts to the one that counts in full, m/s.
RAMP = 0.5
# Present distance in metres at which somebody counts half.
HALFWAY = 4.0


@pair_kernel
def _anticipation(  # type: ignore[no-untyped-def]
    x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead, p
):
    # Read before anything is asked, so that they are read once for all neighbours.
    distance = p[0]
    horizon = p[1]
    share = p[2]
    slowest2 = p[3] * p[3]
    ramp = 1.0 / ((p[3] + RAMP) * (p[3] + RAMP) - slowest2)
    px = nx - sx
    py = ny - sy
    away2 = px * px + py * py
    wx = nvx - (x - sx) / duration
    wy = nvy - (y - sy) / duration
    relative2 = wx * wx + wy * wy
    towards = -(px * wx + py * wy)
    time = min(max(towards / max(relative2, 1e-9), 0.0), horizon)
    dx = px + wx * time
    dy = py + wy * time
    reach2 = max(min(distance * distance, share * share * away2), 1e-9)
    near = 1.0 - (dx * dx + dy * dy) * (1.0 / reach2)
    fast = min((relative2 - slowest2) * ramp, 1.0)
    stays = tx == sx and ty == sy
    counts = towards > 0.0 and near > 0.0 and fast > 0.0 and not stays
    return near * fast * (HALFWAY / (HALFWAY + math.sqrt(away2))) if counts else 0.0


@pair_bound_kernel
def _anticipation_bound(  # type: ignore[no-untyped-def]
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, p,
):  # fmt: skip
    distance = p[0]
    horizon = p[1]
    share = p[2]
    slowest2 = p[3] * p[3]
    ramp = 1.0 / ((p[3] + RAMP) * (p[3] + RAMP) - slowest2)
    px = nx - sx
    py = ny - sy
    away2 = px * px + py * py
    away = math.sqrt(away2)
    # Velocities of the group differ from that of its middle by no more than this.
    spread = radius / duration
    wx = nvx - (x - sx) / duration
    wy = nvy - (y - sy) / duration
    relative = math.sqrt(wx * wx + wy * wy)
    towards = -(px * wx + py * wy)
    # At the time of the middle's closest approach each option is at most so much farther away.
    time = min(max(towards / max(relative * relative, 1e-9), 0.0), horizon)
    dx = px + wx * time
    dy = py + wy * time
    nearest = math.sqrt(dx * dx + dy * dy) + spread * time
    reach2 = max(min(distance * distance, share * share * away2), 1e-9)
    near = 1.0 - nearest * nearest * (1.0 / reach2)
    least = max(relative - spread, 0.0)
    fast = min((least * least - slowest2) * ramp, 1.0)
    stays = tx == sx and ty == sy
    counts = towards > away * spread and near > 0.0 and fast > 0.0 and not stays
    return near * fast * (HALFWAY / (HALFWAY + away)) if counts else 0.0


class Anticipation(CompiledTerm):
    """Avoids people whom one would come too near within the next seconds.

    Sum over neighbours of (1 - (d / l)^2) g 4 / (4 + s), as far as d is less than l: d is the
    closest approach within ``horizon`` if both walk on from now at constant velocity, oneself with
    the mean velocity of the option, and s the present distance in metres.  Neighbours who get no
    nearer do not count.  l is ``distance``, or ``share`` of the present distance if that is
    less: nobody can demand room of people who are near already, as in a queue.  g grows from 0 to
    1 with the square of the relative speed, from that of ``slowest`` to that of 0.5 m/s more, so
    people who walk with each other do not count, and those who come across or towards each other,
    or upon somebody who stands, do.  Those who are at their target leave it to others to step
    aside.

    That people respond to the predicted time to a collision, and less the farther it lies ahead,
    is measured by Karamouzas, Skinner and Guy, Physical Review Letters 113 (2014) 238701.
    ``Interference`` looks only at the end of an option, when it is too late to step aside
    gently.

    Args:
        weight: factor in the sum.
        distance: l, metres between the middles of two people who pass each other freely.
        horizon: seconds.
        share: of the present distance.
        slowest: relative speed up to which nobody counts, m/s.

    Raises:
        ModelError: a number that is not finite and positive.
    """

    name = "anticipation"
    default_weight = 5.0
    kernel = _anticipation
    bound = _anticipation_bound

    def __init__(
        self,
        weight: float | None = None,
        distance: float = 1.0,
        horizon: float = 3.0,
        share: float = 0.6,
        slowest: float = 0.9,
    ) -> None:
        super().__init__(weight)
        numbers = {"distance": distance, "horizon": horizon, "share": share, "slowest": slowest}
        for name, value in numbers.items():
            if not (math.isfinite(value) and value > 0.0):
                raise ModelError(f"anticipation: {name} is {value}, expected more than 0")
        self.distance = distance
        self.horizon = horizon
        self.share = share
        self.slowest = slowest

    def parameters(self) -> tuple[float, ...]:
        """``(distance, horizon, share, slowest)``."""
        return (self.distance, self.horizon, self.share, self.slowest)
