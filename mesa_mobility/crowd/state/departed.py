"""People who have crossed an exit stay obstacles to those behind for a moment.

The model ends at the line of an exit, the world does not.  If people disappeared at once, an exit
would let more people through than the same door with a floor behind it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.paths import commit
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2
from mesa_mobility.schema import Array, Kind, Several

WALKS_ON = 45
"""Frames for which somebody stays: 1.5 s, the longest look-ahead."""

_SECONDS = WALKS_ON * FRAME_SECONDS

RELAXATION = 0.54
"""Seconds in which people who are free to walk make up for all but 1/e of the difference to their
preferred speed; measured by Moussaid et al., Proc. R. Soc. B 276 (2009) 2755-2762."""

# The mean share of the difference that is made up for while they stay.
_MADE_UP = 1.0 - RELAXATION / _SECONDS * (1.0 - math.exp(-_SECONDS / RELAXATION))


ROWS = Array("i8", low=0, below="people", rising=True)
"""Rows of people, in order, in a checkpoint."""


class Departed(Saved):
    """People who have crossed an exit within the last 1.5 s.

    Attributes:
        rows: their rows in the crowd, in order.
    """

    saved: ClassVar[Mapping[str, Kind]] = {"rows": ROWS, "_new": Several(ROWS)}

    def __init__(self) -> None:
        self.rows = np.empty(0, dtype=np.int64)
        # Those who have no movement beyond the exit yet, one array a frame.
        self._new: list[NDArray[np.int64]] = []

    def add(self, rows: NDArray[np.int64]) -> None:
        """Add people who have crossed an exit in this frame."""
        rows = np.ascontiguousarray(rows)
        self.rows = self.together_with(rows)
        self._new.append(rows)

    def set_off(self, frame: int, crowd: Crowd, exits: NDArray[np.float64]) -> None:
        """Let new ones walk on, away from the (e, 4) exits."""
        for rows in self._new:
            walk_on(rows, frame, exits, np.empty((3, 2)), crowd.records)
        self._new.clear()

    def move(self, frame: int, crowd: Crowd) -> None:
        """Advance them to ``frame`` and drop those who have been away for long enough."""
        if len(self.rows):
            # A copy: callers may still hold the previous array.
            rows = self.rows.copy()
            self.rows = rows[: move_on(rows, frame, crowd.records)]

    def together_with(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """These rows merged with those of the departed, ascending."""
        if len(self.rows) == 0:
            return rows
        merged = np.empty(len(rows) + len(self.rows), dtype=np.int64)
        merge(rows, self.rows, merged)
        return merged


@entry_point()
def merge(some: NDArray[np.int64], others: NDArray[np.int64], merged: NDArray[np.int64]) -> None:
    """Merge two ascending arrays."""
    a = 0
    for b in range(len(others)):
        while a < len(some) and some[a] < others[b]:
            merged[a + b] = some[a]
            a += 1
        merged[a + b] = others[b]
    for k in range(a, len(some)):
        merged[k + len(others)] = some[k]


@entry_point()
def walk_on(
    rows: NDArray[np.int64],
    frame: int,
    exits: NDArray[np.float64],
    path: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Let those in ``rows`` walk at right angles away from the nearest exit, as fast as they like.

    On a slant they would walk along the line and into people who stand at its end.  There is room
    beyond the exit: those who were held up in it speed up to their preferred speed, as behind a
    door of the same width within the floor.  ``path`` (3, 2) is workspace.
    """
    for i in rows:
        x, y, vx, vy = state.x[i], state.y[i], state.vx[i], state.vy[i]
        nearest, ex, ey, inside = np.inf, 0.0, 0.0, 0.0
        for e in range(len(exits)):
            ax, ay, bx, by = exits[e]
            away = point_segment_distance2(x, y, ax, ay, bx, by)
            if away < nearest:
                nearest, ex, ey = away, bx - ax, by - ay
                inside = (state.from_x[i] - ax) * ey - (state.from_y[i] - ay) * ex
        length = math.hypot(ex, ey)
        if length > 0.0:  # not all have been closed
            # Away from the side where its movement began: swaying may point it back just then.
            speed = math.hypot(vx, vy)
            speed += _MADE_UP * max(state.preferred[i] - speed, 0.0)
            speed = math.copysign(speed, -inside) / length
            vx, vy = speed * ey, -speed * ex
        path[0, 0], path[1, 0], path[2, :] = x, y, state.heading[i]
        path[0, 1], path[1, 1] = x + _SECONDS * vx, y + _SECONDS * vy
        commit(
            i,
            np.int64(state.option[i]),
            frame,
            np.int64(1),
            np.int64(WALKS_ON),
            np.int64(-1),
            state.cluster[i],
            path,
            state,
        )
        state.target_x[i], state.target_y[i] = path[0, 1], path[1, 1]
        state.route[i] = 0.0


@entry_point()
def move_on(rows: NDArray[np.int64], frame: int, state: CrowdState) -> int:
    """Advance those who are still under way at ``frame`` and move them to the front; returns their
    number."""
    count = 0
    for i in rows:
        u = min((frame - state[i].start) / WALKS_ON, 1.0)
        state[i].x = state[i].from_x + u * (state[i].to_x - state[i].from_x)
        state[i].y = state[i].from_y + u * (state[i].to_y - state[i].from_y)
        rows[count] = i
        count += int(state[i].end > frame)
    return count
