"""Feasibility of a path: whether it hits a wall or a person, and when it leads out.

Walls and people are tested apart, as the search makes the faster test first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.collision.discs import body_collides, body_hits_wall, overhang_of
from mesa_mobility.crowd.collision.exact import crosses_exit, gone_frame
from mesa_mobility.crowd.collision.sampled import SLACK, sampled_collision
from mesa_mobility.crowd.collision.walls import path_off2
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.planning.workspace import DecisionContext, Workspace
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import box_of, to_world
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings


@internal()
def path_gone_or_walled(
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
    hit = body_hits_wall(i, path, walked, spacing, walls, reach, table, state)
    return -3 if hit else gone


@internal()
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
    own = state.core[i] + overhang_of(i, table, state) + 0.001
    for j in near:
        c = own + state.core[j] + overhang_of(j, table, state)
        if (
            x0 > state[j].box[2] + c
            or x1 < state[j].box[0] - c
            or y0 > state[j].box[3] + c
            or y1 < state[j].box[1] - c
        ):
            continue
        if body_collides(i, path, pieces, spacing, frame, gone, table, state, j):
            return True
    return False


@internal()
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
    hard_bodies: bool,
) -> int:
    """-3 if the path hits a wall, -2 if it hits a person, else the frame of leaving or -1."""
    gone = path_gone_or_walled(
        i, path, pieces, spacing, reach, frame, table, state, walls, around, exits_near
    )
    if gone == -3 or not hard_bodies:
        return gone
    blocked = hits_anybody(i, path, pieces, spacing, frame, gone, table, state, near)
    return -2 if blocked else gone


@internal()
def option_gone_or_blocked(
    now: DecisionContext,
    frame: int,
    o: int,
    met: int,
    hard_bodies: bool,
    table: OptionTable,
    state: CrowdState,
    around: Surroundings,
    work: Workspace,
) -> tuple[int, int]:
    """Whether a deciding pedestrian can walk an option; transforms it only if necessary.

    Args:
        now: the pedestrian's decision.
        frame: now.
        o: the option's row.
        met: index of the close person to test first.
        hard_bodies: whether bodies are hard.
        table: options of all capabilities.
        state: the crowd.
        around: walls and exits.
        work: workspace, with the people and walls around.

    Returns:
        -2 or -3 if it hits something, else the frame of leaving or -1; the index of the close
        person to test first for the next option.
    """
    me, walls = now.me, now.walls
    reach, stride = np.float64(table.options[o].reach), np.float64(table.options[o].stride)
    exits_near = reach >= now.exits_from
    # Left to the exact tests: whether it hits a wall, and the people in doubt.
    walled, doubtful, gone = True, 0, -1
    if not exits_near:
        off2 = path_off2(table.path, o, work.barriers, now.n_clear_walls)
        least = me.core + MARGIN - SLACK
        if off2 < least * least:
            return -3, met
        most = me.core + me.overhang + MARGIN + 0.5 * stride + 3.0 * SLACK
        walled = now.n_clear_walls < len(walls) or off2 < most * most
        if hard_bodies:
            who, doubtful = sampled_collision(
                me, frame, table.path[o], stride, now.found, met, table, state, work.close,
                work.unsure,
            )  # fmt: skip
            if who >= 0:
                return -2, who
    elif hard_bodies:
        # People who leave on the way may miss those ahead: the exact test decides.
        doubtful = now.found
        for a in range(now.found):
            work.unsure[a] = work.close.people[a].who
    if hard_bodies:
        for a in range(now.touching, len(work.close.people)):
            work.unsure[doubtful] = work.close.people[a].who
            doubtful += 1
    if not walled and doubtful == 0:
        return gone, met
    pieces = to_world(me.row, o, me.c, me.s, table, state, work.path)
    spacing = np.int64(SAMPLE_FRAMES)
    if walled:
        gone = path_gone_or_walled(
            me.row, work.path, pieces, spacing, reach, frame, table, state, walls, around,
            exits_near,
        )  # fmt: skip
    if gone < -1 or doubtful == 0:
        return gone, met
    blocked = hits_anybody(
        me.row, work.path, pieces, spacing, frame, gone, table, state,
        work.unsure[:doubtful],
    )  # fmt: skip
    return -2 if blocked else gone, met
