"""Advance people along their committed paths."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal
from mesa_mobility.compiled.threads import BLOCK, by_blocks
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.state.paths import facing_at_waypoint, waypoint
from mesa_mobility.crowd.state.records import FALLBACK, CrowdState

LONG_AFTER = np.iinfo(np.int64).max
"""A frame after all others."""


class Moved(NamedTuple):
    """The result of advancing the crowd by some frames.

    Attributes:
        stay: rows of those who stay, ascending.
        gone: rows of those who have left, ascending.
        speeds: sum of everybody's mean speeds, m/s.
        fallen: number of people in the fallback.
        next: next frame in which a movement of those who stay ends, or one of them leaves.
    """

    stay: NDArray[np.int64]
    gone: NDArray[np.int64]
    speeds: float
    fallen: int
    next: int


def move(
    active: NDArray[np.int64], frame: int, frames: int, table: OptionTable, state: CrowdState
) -> Moved:
    """Advance everybody in rows ``active`` by ``frames`` frames, to ``frame``.

    No movement may end, and nobody may leave, before that frame.
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


@internal()
def next_event(i: int, frame: int, state: CrowdState) -> int:
    """Frame in which pedestrian i leaves, or in which their movement ends if they stay."""
    gone: int = state.gone[i]
    return gone if gone > frame else state.end[i]


@entry_point()
def _move(
    active: NDArray[np.int64],
    frame: int,
    frames: int,
    table: OptionTable,
    state: CrowdState,
    sorted_out: NDArray[np.int64],
) -> tuple[int, int, float, int, int]:
    """Write to ``sorted_out`` those who stay, and backwards from the end those who have left.

    Returns both numbers, and the other fields of ``Moved``.
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
            ax, ay = waypoint(state, table, i, k)
            bx, by = waypoint(state, table, i, k + 1)
            state.x[i], state.y[i] = ax + u * (bx - ax), ay + u * (by - ay)
            a, b = (
                facing_at_waypoint(state, table, i, k),
                facing_at_waypoint(state, table, i, k + 1),
            )
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
            soonest = min(soonest, next_event(i, frame, state))
    return staying, left, speeds, fallen, soonest
