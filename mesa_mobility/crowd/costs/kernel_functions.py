"""What the functions of cost kernels take, for type checkers and for a check of their number."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from mesa_mobility.errors import ModelError

_F: TypeAlias = float
_P: TypeAlias = tuple[float, ...]

OptionFunction: TypeAlias = Callable[[_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float]

OptionFunctionWithVelocity: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

BoundFunction: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

BoundFunctionWithVelocity: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

PairFunction: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

PairBoundFunction: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

WallFunction: TypeAlias = Callable[
    [_F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _F, _P], float
]

_END = "x, y, facing_x, facing_y, duration, speed"
_GROUP = "x, y, radius, facing_x, facing_y, turn, duration, slowest, fastest"
_WAY = "start_x, start_y, target_x, target_y"
_OTHER = "neighbour_x, neighbour_y, neighbour_vx, neighbour_vy, neighbour_ex, neighbour_ey, lead"

OPTION = f"{_END}, {_WAY}, preferred_speed"
BOUND = f"{_GROUP}, {_WAY}, preferred_speed"
PAIR = f"{_END}, {_WAY}, {_OTHER}"
PAIR_BOUND = f"{_GROUP}, {_WAY}, {_OTHER}"
WALL = f"{_END}, {_WAY}, wall_x1, wall_y1, wall_x2, wall_y2, core"
"""Names of the arguments before those that are asked for and the parameters."""


def check_arguments(function: Callable[..., float], names: str) -> None:
    """Raise ModelError unless a function takes these arguments, whatever it calls them."""
    expected = names.count(",") + 1
    code = function.__code__
    if code.co_argcount != expected or code.co_flags & 0x0C:
        raise ModelError(
            f"kernel {function.__name__}: takes {code.co_argcount} arguments, expected {expected}: "
            f"{names}"
        )
