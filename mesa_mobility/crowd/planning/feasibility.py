"""Feasibility of a path: whether it hits a wall or a person, and when it leads out.

Walls and people are tested apart, as the search makes the faster test first.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.crowd.collision.exact import (
    crosses_exit,
    gone_frame,
    hits_wall,
    swept_collision,
)
from mesa_mobility.crowd.collision.sampled import SLACK, sampled_collision
from mesa_mobility.crowd.collision.walls import path_off2
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.planning.workspace import DecisionContext, Workspace
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import box_of, to_world
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings


class Trial(NamedTuple):
    """A path on trial.

    Attributes:
        path: (3, n) x, y and facing at its waypoints.
        pieces: pieces between them.
        spacing: frames that a piece takes.
        reach: the farthest that it leads, metres.
    """

    path: NDArray[np.float64]
    pieces: int | np.int64
    spacing: int | np.int64
    reach: float


class Obstacles(NamedTuple):
    """What a path may hit.

    Attributes:
        walls: (w, 5) walls within reach, with squared distances.
        around: walls and exits.
        near: rows of people.
        exits_near: whether an open exit is within reach.
        hard_bodies: whether bodies are hard.
    """

    walls: NDArray[np.float64]
    around: Surroundings
    near: NDArray[np.int64]
    exits_near: bool
    hard_bodies: bool


@internal()
def path_gone_or_walled(
    i: int,
    trial: Trial,
    frame: int,
    state: CrowdState,
    walls: NDArray[np.float64],
    around: Surroundings,
    exits_near: bool,
) -> int:
    """-3 if the path hits a wall, else the frame of leaving or -1."""
    gone, walked = -1, trial.pieces
    if exits_near:
        piece, where = crosses_exit(trial.path, trial.pieces, around, state.destination[i])
        if piece >= 0:
            gone = gone_frame(frame, trial.spacing, piece, where)
            walked = piece + 1
    hit = hits_wall(trial.path, walked, walls, state.core[i], trial.reach)
    return -3 if hit else gone


@internal()
def hits_anybody(
    i: int,
    trial: Trial,
    frame: int,
    gone: int,
    table: OptionTable,
    state: CrowdState,
    near: NDArray[np.int64],
) -> bool:
    """Whether the path of pedestrian i hits one of those in rows ``near``."""
    path, pieces, spacing = trial.path, trial.pieces, trial.spacing
    x0, y0, x1, y1 = box_of(path, pieces)
    own = state.core[i]
    for j in near:
        c = own + 0.001 + state.core[j]
        if (
            x0 > state[j].box[2] + c
            or x1 < state[j].box[0] - c
            or y0 > state[j].box[3] + c
            or y1 < state[j].box[1] - c
        ):
            continue
        apart = own + state.core[j]
        if swept_collision(path, pieces, spacing, frame, gone, table, state, j, apart):
            return True
    return False


@internal()
def path_gone_or_blocked(
    i: int, trial: Trial, frame: int, table: OptionTable, state: CrowdState, obstacles: Obstacles
) -> int:
    """-3 if the path hits a wall, -2 if it hits a person, else the frame of leaving or -1."""
    walls, around = obstacles.walls, obstacles.around
    gone = path_gone_or_walled(i, trial, frame, state, walls, around, obstacles.exits_near)
    if gone == -3 or not obstacles.hard_bodies:
        return gone
    blocked = hits_anybody(i, trial, frame, gone, table, state, obstacles.near)
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
    me, walls, close = now.me, now.walls, work.neighbours.close
    reach, stride = np.float64(table.options[o].reach), np.float64(table.options[o].stride)
    exits_near = reach >= now.exits_from
    # Left to the exact tests: whether it hits a wall, and the people in doubt.
    walled, doubtful, gone = True, 0, -1
    if not exits_near:
        off2 = path_off2(table.path, o, now.barriers.at, now.barriers.known)
        least = me.core + MARGIN - SLACK
        if off2 < least * least:
            return -3, met
        most = me.core + MARGIN + 0.5 * stride + 3.0 * SLACK
        walled = now.barriers.known < len(walls) or off2 < most * most
        if hard_bodies:
            who, doubtful = sampled_collision(table.path[o], stride, met, state, close, work.unsure)
            if who >= 0:
                return -2, who
    elif hard_bodies:
        # People who leave on the way may miss those ahead: the exact test decides.
        doubtful = close.known[0]
        for a in range(doubtful):
            work.unsure[a] = close.who[a]
    if hard_bodies:
        for a in range(close.known[1], len(close.who)):
            work.unsure[doubtful] = close.who[a]
            doubtful += 1
    if not walled and doubtful == 0:
        return gone, met
    pieces = to_world(me.row, o, me.c, me.s, table, state, work.path)
    trial = Trial(work.path, pieces, np.int64(SAMPLE_FRAMES), reach)
    if walled:
        gone = path_gone_or_walled(me.row, trial, frame, state, walls, around, exits_near)
    if gone < -1 or doubtful == 0:
        return gone, met
    blocked = hits_anybody(me.row, trial, frame, gone, table, state, work.unsure[:doubtful])
    return -2 if blocked else gone, met
