"""Movements under way when obstacles or doors change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.crowd.collision.exact import (
    crosses_exit,
    hits_wall,
    near_walls,
    swept_collision,
)
from mesa_mobility.crowd.options.table import SAMPLES, OptionTable
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.state.paths import waypoint
from mesa_mobility.crowd.state.records import NO_OPTION, CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2

TOUCHING = 1e-3
"""Metres by which a body is in a line that it touches no more than others touch walls."""


@kept()
def stop_where_blocked(
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    state: CrowdState,
    around: Surroundings,
    rules: Rules,
) -> int:
    """Stop people whose path is blocked, and those who would then run into them.

    They stand where they are and decide again in this frame.  Returns their number.

    An exit closes behind those who are in it on their way out, as doors do that give way to a body:
    they go on and leave.  Others across a closed door decide again, and step off at once.
    """
    reach = table.farthest.max()
    stopped = np.zeros(len(rows), np.bool_)
    newly = np.empty(len(rows), np.int64)
    count = 0
    path = np.empty((2, SAMPLES))
    found = np.empty((around.most_walls, 5))
    for a in range(len(rows)):
        i = rows[a]
        if state.end[i] <= frame:
            continue
        if state.gone[i] >= 0 and _in_closed_exit(i, state, around):
            continue
        pieces = _remaining(i, frame, table, state, path)
        walked = pieces
        if state.gone[i] >= 0:
            piece, _ = crosses_exit(path, pieces, around, state.destination[i])
            walked = pieces if piece < 0 else piece + 1
        walls = near_walls(
            around,
            state.x[i],
            state.y[i],
            state.destination[i],
            reach + state.core[i] + 0.01,
            found,
        )
        if _on_lines(i, found[:walls], state) or hits_wall(
            path, walked, found[:walls], state.core[i], reach
        ):
            stopped[a] = True
            newly[count] = i
            count += 1
    total = count
    while count > 0 and rules.hard_bodies:
        for b in range(count):
            _stop(newly[b], frame, state, rules)
        # Where they stand they may block others, who stop as well.
        standing = newly[:count].copy()
        count = 0
        still = np.empty((2, 2))
        for a in range(len(rows)):
            j = rows[a]
            if stopped[a] or state.end[j] <= frame:
                continue
            for i in standing:
                still[0], still[1] = state.x[i], state.y[i]
                if swept_collision(
                    still,
                    np.int64(1),
                    np.int64(1),
                    frame,
                    np.int64(-1),
                    table,
                    state,
                    j,
                    state.core[i] + state.core[j],
                ):
                    stopped[a] = True
                    newly[count] = j
                    count += 1
                    break
        total += count
    for b in range(count):
        _stop(newly[b], frame, state, rules)
    return total


@kept()
def _in_closed_exit(i: int, state: CrowdState, around: Surroundings) -> bool:
    """Whether the body of pedestrian i is across an exit by which they may not leave."""
    for e in range(len(around.exits)):
        if not around.leads_out[state.destination[i], e] and _on_lines(
            i, around.exits[e : e + 1], state
        ):
            return True
    return False


@kept()
def _on_lines(i: int, lines: NDArray[np.float64], state: CrowdState) -> bool:
    """Whether the body of pedestrian i is across one of some lines (n, 4 or more), as only doors
    that close on people are."""
    x, y, r = state.x[i], state.y[i], state.core[i] - TOUCHING
    for w in range(len(lines)):
        ax, ay, bx, by = lines[w, 0], lines[w, 1], lines[w, 2], lines[w, 3]
        if point_segment_distance2(x, y, ax, ay, bx, by) < r * r:
            return True
    return False


@kept()
def _remaining(
    i: int, frame: int, table: OptionTable, state: CrowdState, path: NDArray[np.float64]
) -> int:
    """Write the position and remaining waypoints of pedestrian i; return the number of pieces."""
    path[0, 0], path[1, 0] = state.x[i], state.y[i]
    first = (frame - state.start[i]) // state.spacing[i] + 1
    pieces = state.knots[i] - first
    for k in range(pieces):
        path[0, k + 1], path[1, k + 1] = waypoint(state, table, i, first + k)
    return pieces


@kept()
def _stop(i: int, frame: int, state: CrowdState, rules: Rules) -> None:
    state.option[i], state.gone[i] = NO_OPTION, -1
    state.start[i] = state.end[i] = frame
    state.spacing[i] = state.knots[i] = 1
    state.cluster[i] = rules.standing[state.type_index[i]]
    state.vx[i] = state.vy[i] = 0.0
    state.stride[i] = 0.0
    state.from_x[i] = state.to_x[i] = state.x[i]
    state.from_y[i] = state.to_y[i] = state.y[i]
    state.from_heading[i] = state.to_heading[i] = state.heading[i]
    state.box[i, 0] = state.box[i, 2] = state.x[i]
    state.box[i, 1] = state.box[i, 3] = state.y[i]
