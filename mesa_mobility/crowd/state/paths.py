"""Waypoints of committed movements.

A path is a row of waypoints, joined by straight pieces. A record keeps only a movement's start, its
end and its option. Waypoints between are computed from the option table, bit for bit as they were
when they were tested.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES, SAMPLES, OptionTable
from mesa_mobility.crowd.state.records import CrowdState

Box: TypeAlias = tuple[float, float, float, float]
"""Least x and y, and greatest x and y, metres."""


@internal()
def waypoint(state: CrowdState, table: OptionTable, j: int, k: int) -> tuple[float, float]:
    """Waypoint k of the movement of pedestrian j, metres."""
    if k >= state.knots[j] - 1:
        return state.to_x[j], state.to_y[j]
    if k <= 0:
        return state.from_x[j], state.from_y[j]
    # Only movements along an option have waypoints between.
    own = table.path[state.option[j]]
    x, y, c, s = state.from_x[j], state.from_y[j], state.from_c[j], state.from_s[j]
    return x + c * own[0, k] - s * own[1, k], y + s * own[0, k] + c * own[1, k]


@internal()
def facing_at_waypoint(state: CrowdState, table: OptionTable, j: int, k: int) -> float:
    """Heading of pedestrian j at waypoint k of their movement, radians."""
    if k >= state.knots[j] - 1:
        return float(state.to_heading[j])
    if k <= 0:
        return float(state.from_heading[j])
    return float(state.from_heading[j] + table.path[state.option[j], 2, k])


@internal()
def position_at(state: CrowdState, table: OptionTable, j: int, time: float) -> tuple[float, float]:
    """Position of pedestrian j at a time in frames; they stand after their movement has ended."""
    last = state.knots[j] - 1
    u = (time - state.start[j]) / state.spacing[j]
    k = int(u)
    if k >= last:
        return state.to_x[j], state.to_y[j]
    u -= k
    ax, ay = waypoint(state, table, j, k)
    bx, by = waypoint(state, table, j, k + 1)
    return ax + u * (bx - ax), ay + u * (by - ay)


@internal()
def box_of(path: NDArray[np.float64], pieces: int) -> Box:
    """The box around the first ``pieces`` pieces of a path (3, n)."""
    x0 = x1 = path[0, 0]
    y0 = y1 = path[1, 0]
    for k in range(1, pieces + 1):
        x0, x1 = min(x0, path[0, k]), max(x1, path[0, k])
        y0, y1 = min(y0, path[1, k]), max(y1, path[1, k])
    return x0, y0, x1, y1


@internal()
def to_world(
    i: int,
    o: int,
    c: float,
    s: float,
    table: OptionTable,
    state: CrowdState,
    path: NDArray[np.float64],
) -> int:
    """Write the path of option o, as pedestrian i would walk it from here, to ``path`` (3, 16).

    Rows of ``path`` are x, y (metres) and heading (radians) at the samples. ``c`` and ``s`` are
    cosine and sine of the pedestrian's heading.

    Returns how many samples after the first belong to the option; the rest repeat its end.
    """
    x, y, heading = state.x[i], state.y[i], state.heading[i]
    own = table.path[o]
    for k in range(SAMPLES):
        path[0, k] = x + c * own[0, k] - s * own[1, k]
        path[1, k] = y + s * own[0, k] + c * own[1, k]
        path[2, k] = heading + own[2, k]
    pieces: int = table.options[o].frames // SAMPLE_FRAMES
    return pieces


@internal()
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
    """Commit pedestrian i to the first ``pieces`` pieces of a path (3, n) in world coordinates.

    Each piece takes ``spacing`` frames, from ``frame`` on. ``gone`` is the frame at which the path
    has crossed an exit, or -1; ``cluster`` is that of its end.
    """
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
