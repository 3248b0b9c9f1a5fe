"""Walking where one faces: not sideways or backwards."""

import math
from typing import Annotated

from mesa_mobility import CompiledTerm, Me, Option, Options, Range, option_kernel


@option_kernel
def _sideways(option: Option, me: Me, p: "Sideways") -> float:
    dx = option.x - me.x
    dy = option.y - me.y
    across = abs(dx * option.facing_y - dy * option.facing_x)
    back = max(-(dx * option.facing_x + dy * option.facing_y), 0.0)
    return 1.5 * (across + p.backwards * back) / option.duration


@option_kernel
def _sideways_bound(options: Options, me: Me, p: "Sideways") -> float:
    dx = options.x - me.x
    dy = options.y - me.y
    ux = options.facing_x
    uy = options.facing_y
    # An angle changes its sine and cosine by no more than itself: by 2 at most, the amount of a
    # sine by 1.
    far = math.sqrt(dx * dx + dy * dy) + options.radius
    across = max(abs(dx * uy - dy * ux) - options.radius - far * min(options.turn, 1.0), 0.0)
    back = max(-(dx * ux + dy * uy) - options.radius - far * min(options.turn, 2.0), 0.0)
    return 1.5 * (across + p.backwards * back) / options.duration


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
