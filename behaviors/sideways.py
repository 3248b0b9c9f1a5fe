"""Walking where one faces: not sideways or backwards."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Range, bound_kernel, option_kernel


@option_kernel
def _sideways(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, preferred: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    dx = x - sx
    dy = y - sy
    back = max(-(dx * ux + dy * uy), 0.0)
    return 1.5 * (abs(dx * uy - dy * ux) + p[0] * back) / duration


@bound_kernel
def _sideways_bound(
    x: float, y: float, radius: float, ux: float, uy: float, turn: float, duration: float,
    slowest: float, fastest: float, sx: float, sy: float, tx: float, ty: float, preferred: float,
    p: tuple[float, ...],
) -> float:  # fmt: skip
    dx = x - sx
    dy = y - sy
    # An angle changes its sine and cosine by no more than itself: by 2 at most, the amount of a
    # sine by 1.
    far = math.sqrt(dx * dx + dy * dy) + radius
    across = max(abs(dx * uy - dy * ux) - radius - far * min(turn, 1.0), 0.0)
    back = max(-(dx * ux + dy * uy) - radius - far * min(turn, 2.0), 0.0)
    return 1.5 * (across + p[0] * back) / duration


class Sideways(CompiledTerm):
    """Avoids steps to the side and back.

    ``(|s| + k b) x 1.5 / t``: s is the part of the displacement across the facing direction at the
    mobility point, b the part against it, 0 if it leads forward, k is ``backwards`` and t the
    duration of the option.  In metres over the paper's 1.5 s whatever the duration, so that options
    of different durations compare.  An arc costs as well, half as much as a step to the side that
    is as far off as it turns.

    People walk where they face: on recorded paths the direction of the body gives the direction of
    motion, as that of a wheel does (Arechavaleta, Laumond, Hicheur and Berthoz, IEEE Transactions
    on Robotics 24 (2008) 5-14).  Recordings contain steps to the side and back, too, and without
    a cost people in a crowd take them for every small gain.

    Args:
        weight: factor in the sum.
        backwards: k, what a metre back costs in metres to the side.

    Raises:
        ModelError: ``backwards`` is not finite, or negative.
    """

    name = "sideways"
    default_weight = 2.0
    kernel = _sideways
    bound = _sideways_bound

    def __init__(
        self, weight: float | None = None, backwards: Annotated[float, Range(0.0)] = 1.0
    ) -> None:
        super().__init__(weight)
        self.backwards = backwards

    def parameters(self) -> tuple[float, ...]:
        """``(backwards,)``."""
        return (self.backwards,)
