"""Movements: laying an option out in the world, committing to it, and going along it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.collision import box_of
from mesa_mobility.crowd.options import FRAME_SECONDS, SAMPLE_FRAMES, SAMPLES, OptionTable
from mesa_mobility.crowd.state import FALLBACK, CrowdState
from mesa_mobility.crowd.under_way import facing_at_knot, knot
from mesa_mobility.jit import Entry, called, lean
from mesa_mobility.threads import BLOCK, by_blocks

LONG_AFTER = np.iinfo(np.int64).max
"""A frame after all others."""


@lean()
def lay_path(
    i: int,
    o: int,
    c: float,
    s: float,
    table: OptionTable,
    state: CrowdState,
    path: NDArray[np.float64],
) -> int:
    """Write option o of pedestrian i into ``path`` (3, 16) as world knots; return its pieces.

    ``c`` and ``s`` are cosine and sine of how the pedestrian faces.
    """
    x, y, heading = state.x[i], state.y[i], state.heading[i]
    own = table.path[o]
    for k in range(SAMPLES):
        path[0, k] = x + c * own[0, k] - s * own[1, k]
        path[1, k] = y + s * own[0, k] + c * own[1, k]
        path[2, k] = heading + own[2, k]
    pieces: int = table.options[o].frames // SAMPLE_FRAMES
    return pieces


@lean()
def commit(
    i: int,
    option: int,
    frame: int,
    pieces: int,
    spacing: int,
    gone: int,
    cluster: int,
    path: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Commit pedestrian i to a path (3, n) of world knots: that of an option, or of one piece."""
    seconds = pieces * spacing * FRAME_SECONDS
    state.option[i] = option
    state.start[i], state.end[i], state.gone[i] = frame, frame + pieces * spacing, gone
    state.spacing[i], state.knots[i] = spacing, pieces + 1
    state.cluster[i] = cluster
    state.from_x[i], state.from_y[i], state.from_heading[i] = path[0, 0], path[1, 0], path[2, 0]
    state.from_c[i], state.from_s[i] = math.cos(path[2, 0]), math.sin(path[2, 0])
    state.to_x[i], state.to_y[i] = path[0, pieces], path[1, pieces]
    state.to_heading[i] = path[2, pieces]
    state.vx[i] = (path[0, pieces] - path[0, 0]) / seconds
    state.vy[i] = (path[1, pieces] - path[1, 0]) / seconds
    longest2 = 0.0
    for k in range(pieces):
        dx, dy = path[0, k + 1] - path[0, k], path[1, k + 1] - path[1, k]
        longest2 = max(longest2, dx * dx + dy * dy)
    state.stride[i] = math.sqrt(longest2) * SAMPLE_FRAMES / spacing
    x0, y0, x1, y1 = box_of(path, pieces)
    state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3] = x0, y0, x1, y1


class Moved(NamedTuple):
    """What people have come to in some frames.

    Fields: who stays and who has left (``gone``), both in order; the sum of everybody's mean
    ``speeds``, m/s; how many have ``fallen`` back; the ``next`` frame in which a movement of those
    who stay ends or one of them leaves.
    """

    stay: NDArray[np.int64]
    gone: NDArray[np.int64]
    speeds: float
    fallen: int
    next: int


def move(
    active: NDArray[np.int64], frame: int, frames: int, table: OptionTable, state: CrowdState
) -> Moved:
    """Put everybody in rows ``active`` where its movement has it at ``frame``, so many later.

    Nobody may leave or come to the end of its movement before that.
    """
    sorted_out = np.empty_like(active)

    def block(first: int, last: int) -> tuple[int, int, float, int, int]:
        some = active[first:last]
        found: tuple[int, int, float, int, int] = _move(
            some, frame, frames, table, state, sorted_out[first:last]
        )
        return found

    found = by_blocks(block, len(active))
    if len(found) == 1:
        staying, left, speeds, fallen, soonest = found[0]
        return Moved(sorted_out[:staying], sorted_out[::-1][:left], speeds, fallen, soonest)
    stay, gone = [], []
    for k, (staying, left, *_) in enumerate(found):
        some = sorted_out[k * BLOCK : (k + 1) * BLOCK]
        stay.append(some[:staying])
        gone.append(some[::-1][:left])
    return Moved(
        np.concatenate(stay),
        np.concatenate(gone),
        sum(each[2] for each in found),
        sum(each[3] for each in found),
        min(each[4] for each in found),
    )


@Entry
@called()
def due(
    active: NDArray[np.int64], frame: int, state: CrowdState, found: NDArray[np.int64]
) -> tuple[int, int]:
    """Write those in rows ``active`` whose movement has ended by ``frame``; return their number.

    And the next frame in which the movement of one of the others ends, or one of them leaves.
    """
    count, soonest = 0, LONG_AFTER
    for i in active:
        found[count] = i
        if state.end[i] <= frame:
            count += 1
        else:
            soonest = min(soonest, _next_event(i, frame, state))
    return count, soonest


@lean()
def _next_event(i: int, frame: int, state: CrowdState) -> int:
    """The frame in which the movement of pedestrian i ends or, if it does so before, it leaves."""
    gone: int = state.gone[i]
    return gone if gone > frame else state.end[i]


@Entry
@called()
def _move(
    active: NDArray[np.int64],
    frame: int,
    frames: int,
    table: OptionTable,
    state: CrowdState,
    sorted_out: NDArray[np.int64],
) -> tuple[int, int, float, int, int]:
    """Write to ``sorted_out`` those who stay, and backwards from its end those who have left.

    Returns how many they are, and the rest as ``Moved`` has it.
    """
    staying, left, speeds, fallen, soonest = 0, 0, 0.0, 0, LONG_AFTER
    for i in active:
        if not state.active[i]:  # taken out of the model in this very frame
            continue
        last = state.knots[i] - 1
        u = (frame - state.start[i]) / state.spacing[i]
        k = int(u)
        if k >= last:
            state.x[i], state.y[i] = state.to_x[i], state.to_y[i]
            state.heading[i] = state.to_heading[i]
        else:
            u -= k
            ax, ay = knot(state, table, i, k)
            bx, by = knot(state, table, i, k + 1)
            state.x[i], state.y[i] = ax + u * (bx - ax), ay + u * (by - ay)
            a, b = facing_at_knot(state, table, i, k), facing_at_knot(state, table, i, k + 1)
            state.heading[i] = a + u * (b - a)
        speeds += math.sqrt(state.vx[i] * state.vx[i] + state.vy[i] * state.vy[i])
        state.active_frames[i] += frames
        if state.option[i] == FALLBACK:
            state.fallback_frames[i] += frames
            fallen += 1
        if state.gone[i] == frame:
            state.active[i] = False
            left += 1
            sorted_out[-left] = i
        else:
            sorted_out[staying] = i
            staying += 1
            soonest = min(soonest, _next_event(i, frame, state))
    return staying, left, speeds, fallen, soonest
