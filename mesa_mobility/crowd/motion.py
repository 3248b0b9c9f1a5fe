"""Movements: laying an option out in the world, committing to it, and going along it."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import FRAME_SECONDS, SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.collision import box_of
from mesa_mobility.crowd.state import FALLBACK, CrowdState


@njit(cache=True)
def lay_path(
    i: int, o: int, table: OptionTable, state: CrowdState, path: NDArray[np.float64]
) -> int:
    """Write option o of pedestrian i into ``path`` (16, 3) as world knots; return its pieces."""
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    pieces = table.frames[o] // SAMPLE_FRAMES
    path[0, 0], path[0, 1], path[0, 2] = state.x[i], state.y[i], state.heading[i]
    for k in range(pieces):
        sample = table.path[table.path_start[o] + k]
        path[k + 1, 0] = state.x[i] + c * sample[0] - s * sample[1]
        path[k + 1, 1] = state.y[i] + s * sample[0] + c * sample[1]
        path[k + 1, 2] = state.heading[i] + sample[2]
    return pieces


@njit(cache=True)
def commit(
    i: int,
    option: int,
    frame: int,
    pieces: int,
    spacing: int,
    gone: int,
    cluster: int,
    state: CrowdState,
) -> None:
    """Commit pedestrian i to the path in its row of ``state.path``."""
    path = state.path[i]
    seconds = pieces * spacing * FRAME_SECONDS
    state.option[i] = option
    state.start[i], state.end[i], state.gone[i] = frame, frame + pieces * spacing, gone
    state.spacing[i], state.knots[i] = spacing, pieces + 1
    state.cluster[i] = cluster
    state.vx[i] = (path[pieces, 0] - path[0, 0]) / seconds
    state.vy[i] = (path[pieces, 1] - path[0, 1]) / seconds
    x0, y0, x1, y1 = box_of(path, pieces)
    state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3] = x0, y0, x1, y1


@njit(cache=True)
def move(active: NDArray[np.int64], frame: int, state: CrowdState) -> int:
    """Put everybody where its movement has it at ``frame``; return how many have left."""
    left = 0
    for i in active:
        last = state.knots[i] - 1
        u = (frame - state.start[i]) / state.spacing[i]
        k = int(u)
        path = state.path[i]
        if k >= last:
            state.x[i], state.y[i], state.heading[i] = path[last, 0], path[last, 1], path[last, 2]
        else:
            u -= k
            state.x[i] = path[k, 0] + u * (path[k + 1, 0] - path[k, 0])
            state.y[i] = path[k, 1] + u * (path[k + 1, 1] - path[k, 1])
            state.heading[i] = path[k, 2] + u * (path[k + 1, 2] - path[k, 2])
        state.active_frames[i] += 1
        if state.option[i] == FALLBACK:
            state.fallback_frames[i] += 1
        if state.gone[i] == frame:
            state.active[i] = False
            left += 1
    return left
