"""The fallback of section 6 of the paper, for when no option is free."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.options.table import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.planning.feasibility import Obstacles, Trial, path_gone_or_blocked
from mesa_mobility.crowd.state.paths import commit
from mesa_mobility.crowd.state.records import FALLBACK, CrowdState

FALLBACK_FRAMES = 4
"""Frames of the fallback (section 6 of the paper)."""

FALLBACK_SECONDS = FALLBACK_FRAMES * FRAME_SECONDS

FALLBACK_TURN_RATE = math.pi
"""Fastest turn during a fallback, rad/s: about the fastest turn on the spot that was recorded."""

FALLBACK_STEPS = (1.0, 0.5, 0.25, 0.0)
"""Speeds tried in a fallback, as shares of the preferred speed; the last is always possible."""


@internal()
def fall_back(
    i: int,
    frame: int,
    table: OptionTable,
    state: CrowdState,
    obstacles: Obstacles,
    standing: int,
    path: NDArray[np.float64],
) -> None:
    """Commit pedestrian i to four frames straight towards their target, as far as nothing is hit.

    This movement ends in the standing cluster. ``path`` is workspace.
    """
    dx, dy = state.target_x[i] - state.x[i], state.target_y[i] - state.y[i]
    distance = math.hypot(dx, dy)
    turn = 0.0
    if distance > 0.0:
        dx, dy = dx / distance, dy / distance
        turn = math.atan2(dy, dx) - state.heading[i]
        turn = math.atan2(math.sin(turn), math.cos(turn))
        most = FALLBACK_TURN_RATE * FALLBACK_SECONDS
        turn = min(max(turn, -most), most)
    path[0, 0], path[1, 0], path[2, 0] = state.x[i], state.y[i], state.heading[i]
    path[2, 1] = state.heading[i] + turn
    gone = -1
    for share in FALLBACK_STEPS:
        length = min(share * state.preferred[i] * FALLBACK_SECONDS, distance)
        path[0, 1], path[1, 1] = state.x[i] + length * dx, state.y[i] + length * dy
        if length == 0.0:
            break
        trial = Trial(path, np.int64(1), np.int64(FALLBACK_FRAMES), length)
        gone = path_gone_or_blocked(i, trial, frame, table, state, obstacles)
        if gone >= -1:
            break
    state.fallbacks[i] += 1
    commit(
        i,
        np.int64(FALLBACK),
        frame,
        np.int64(1),
        np.int64(FALLBACK_FRAMES),
        max(gone, -1),
        standing,
        path,
        state,
    )
