"""Whether a path can be walked: what stops it, walls or people, or when it leads out.

Walls and people are told apart, as the choice asks first for what is told sooner.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.collision import (
    Surroundings,
    box_of,
    crosses_exit,
    gone_frame,
    hits_neighbour,
    hits_wall,
)
from mesa_mobility.crowd.options import OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean


@lean()
def path_gone_or_walled(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    reach: float,
    frame: int,
    state: CrowdState,
    walls: NDArray[np.float64],
    around: Surroundings,
    exits_near: bool,
) -> int:
    """-3 if the path hits a wall, else the frame of leaving or -1."""
    gone = -1
    walked = pieces
    if exits_near:
        piece, where = crosses_exit(path, pieces, around, state.destination[i])
        if piece >= 0:
            gone = gone_frame(frame, spacing, piece, where)
            walked = piece + 1
    return -3 if hits_wall(path, walked, walls, state.core[i], reach) else gone


@lean()
def hits_anybody(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    frame: int,
    gone: int,
    table: OptionTable,
    state: CrowdState,
    near: NDArray[np.int64],
) -> bool:
    """Whether the path of pedestrian i hits one of those in rows ``near``."""
    x0, y0, x1, y1 = box_of(path, pieces)
    for j in near:
        c = state.core[i] + state.core[j] + 0.001
        if (
            x0 > state[j].box[2] + c
            or x1 < state[j].box[0] - c
            or y0 > state[j].box[3] + c
            or y1 < state[j].box[1] - c
        ):
            continue
        if hits_neighbour(
            path, pieces, spacing, frame, gone, table, state, j, state.core[i] + state.core[j]
        ):
            return True
    return False


@lean()
def path_gone_or_blocked(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    reach: float,
    frame: int,
    table: OptionTable,
    state: CrowdState,
    walls: NDArray[np.float64],
    around: Surroundings,
    near: NDArray[np.int64],
    exits_near: bool,
    cores: bool,
) -> int:
    """-3 if the path hits a wall, -2 if it hits a person, else the frame of leaving or -1."""
    gone = path_gone_or_walled(
        i, path, pieces, spacing, reach, frame, state, walls, around, exits_near
    )
    if gone == -3 or not cores:
        return gone
    blocked = hits_anybody(i, path, pieces, spacing, frame, gone, table, state, near)
    return -2 if blocked else gone
