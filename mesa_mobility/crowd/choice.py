"""The choice: options in rising order of cost until one hits nothing.

For each pedestrian whose movement has ended: the cost of every option of its
cluster (equation 1), then the cheapest that hits neither wall nor body.  Terms
over pairs (interference) are never negative, so the sum of the others is a
lower bound: an option is looked at in order of that bound, dropped if it hits
something, and given its pair costs only if it may still win.  The result is
that of working everything out; most of it never is.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import FRAME_SECONDS, SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.collision import (
    Surroundings,
    crosses_exit,
    gone_frame,
    hits_neighbour,
    hits_wall,
    near_walls,
)
from mesa_mobility.crowd.kernels import call_kernel
from mesa_mobility.crowd.neighbours import Grid, neighbours_of
from mesa_mobility.crowd.screen import Screen, mark_bodies
from mesa_mobility.crowd.state import FALLBACK, CrowdState

FALLBACK_FRAMES = 4
"""Frames of the fallback (section 6 of the paper)."""

FALLBACK_TURN_RATE = math.pi
"""Fastest turn during a fallback, rad/s: about the fastest turn on the spot that was recorded."""

FALLBACK_STEPS = (1.0, 0.5, 0.25, 0.0)
"""Steps tried in a fallback, as shares of the preferred speed; the last is always possible."""


class Terms(NamedTuple):
    """Compiled cost terms: addresses, weights and parameters (row per term)."""

    option_address: NDArray[np.int64]
    option_weight: NDArray[np.float64]
    option_parameters: NDArray[np.float64]
    pair_address: NDArray[np.int64]
    pair_weight: NDArray[np.float64]
    pair_parameters: NDArray[np.float64]


class Rules(NamedTuple):
    """What holds for everybody: ``search_radius`` for neighbours (m), ``cores`` (whether bodies
    are hard) and ``standing`` (kinds,) the standing cluster of each pedestrian type."""

    search_radius: float
    cores: bool
    standing: NDArray[np.int32]


@njit(cache=True)
def option_costs(
    i: int,
    options: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Weighted sum of the option terms for some options of pedestrian i, added to ``out``."""
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    for k in range(len(options)):
        o = options[k]
        x = state.x[i] + c * table.x[o] - s * table.y[o]
        y = state.y[i] + s * table.x[o] + c * table.y[o]
        duration = table.frames[o] * FRAME_SECONDS
        for t in range(len(terms.option_address)):
            out[k] += terms.option_weight[t] * call_kernel(
                terms.option_address[t], x, y, state.heading[i] + table.heading[o],
                table.displacement[o], duration, table.displacement[o] / duration,
                state.target_x[i], state.target_y[i], state.preferred[i],
                terms.option_parameters[t],
            )  # fmt: skip


@njit(cache=True)
def pair_cost(
    i: int,
    o: int,
    table: OptionTable,
    state: CrowdState,
    velocity: NDArray[np.float64],
    near: NDArray[np.int64],
    terms: Terms,
) -> float:
    """Weighted sum of the pair terms of option o of pedestrian i over its neighbours."""
    if len(terms.pair_address) == 0:
        return 0.0
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    x = state.x[i] + c * table.x[o] - s * table.y[o]
    y = state.y[i] + s * table.x[o] + c * table.y[o]
    duration = table.frames[o] * FRAME_SECONDS
    total = 0.0
    for t in range(len(terms.pair_address)):
        part = 0.0
        for j in near:
            part += call_kernel(
                terms.pair_address[t], x, y, state.heading[i] + table.heading[o], duration,
                table.displacement[o] / duration, state.x[j], state.y[j], velocity[j, 0],
                velocity[j, 1], terms.pair_parameters[t],
            )  # fmt: skip
        total += terms.pair_weight[t] * part
    return total


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
def path_gone_or_blocked(
    i: int,
    path: NDArray[np.float64],
    pieces: int,
    spacing: int,
    reach: float,
    frame: int,
    state: CrowdState,
    walls: NDArray[np.float64],
    around: Surroundings,
    near: NDArray[np.int64],
    exits_near: bool,
    cores: bool,
) -> int:
    """-3 if the path hits a wall, -2 if it hits a person, else the frame of leaving or -1."""
    gone = -1
    walked = pieces
    if exits_near:
        piece, where = crosses_exit(path, pieces, around, state.destination[i])
        if piece >= 0:
            gone = gone_frame(frame, spacing, piece, where)
            walked = piece + 1
    if hits_wall(path, walked, walls, state.core[i], reach):
        return -3
    if not cores:
        return gone
    x0, y0, x1, y1 = _box(path, walked)
    for j in near:
        c = state.core[i] + state.core[j] + 0.001
        if (
            x0 > state.box[j, 2] + c
            or x1 < state.box[j, 0] - c
            or y0 > state.box[j, 3] + c
            or y1 < state.box[j, 1] - c
        ):
            continue
        if hits_neighbour(
            path, pieces, spacing, frame, gone, state, j, state.core[i] + state.core[j]
        ):
            return -2
    return gone


@njit(cache=True)
def _box(path: NDArray[np.float64], pieces: int) -> tuple[float, float, float, float]:
    x0 = x1 = path[0, 0]
    y0 = y1 = path[0, 1]
    for k in range(1, pieces + 1):
        x0, x1 = min(x0, path[k, 0]), max(x1, path[k, 0])
        y0, y1 = min(y0, path[k, 1]), max(y1, path[k, 1])
    return x0, y0, x1, y1


@njit(cache=True)
def _sift_down(key: NDArray[np.float64], item: NDArray[np.int64], size: int, root: int) -> None:
    """Restore the heap order (least key first; lower item first among equals) below ``root``."""
    k, v = key[root], item[root]
    while True:
        child = 2 * root + 1
        if child >= size:
            break
        right = child + 1
        if right < size and (
            key[right] < key[child] or (key[right] == key[child] and item[right] < item[child])
        ):
            child = right
        if k < key[child] or (k == key[child] and v < item[child]):
            break
        key[root], item[root] = key[child], item[child]
        root = child
    key[root], item[root] = k, v


@njit(cache=True)
def decide(
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    screen: Screen,
    state: CrowdState,
    grid: Grid,
    around: Surroundings,
    terms: Terms,
    extra: NDArray[np.float64],
    extra_offsets: NDArray[np.int64],
    rules: Rules,
) -> None:
    """Decide for the pedestrians in ``rows``, one after the other, and commit them.

    Costs see the crowd as it was when the frame began; collisions see what
    those before have committed to.

    Args:
        rows: pedestrians, in the order in which they decide.
        frame: now.
        table: options of all capabilities.
        screen: where these options are at the times of screening.
        state: the crowd; targets must be set.
        grid: neighbours' grid of this frame.
        around: walls and exits.
        terms: compiled terms.
        extra: weighted cost of the terms that are not compiled, options of each
            pedestrian in turn, or empty.
        extra_offsets: (len(rows) + 1,) where each pedestrian's part of ``extra`` starts.
        rules: what holds for everybody.
    """
    velocity = np.empty((len(state.x), 2))
    velocity[:, 0] = state.vx
    velocity[:, 1] = state.vy
    found = np.empty(len(grid.people), np.int64)
    path = np.empty((16, 3))
    marked = np.empty((3, screen.side * screen.side), np.bool_)
    eager = False
    for t in range(len(terms.pair_address)):
        eager = eager or terms.pair_weight[t] < 0.0
    for d in range(len(rows)):
        i = rows[d]
        first, last = table.offsets[state.cluster[i]], table.offsets[state.cluster[i] + 1]
        near = found[: neighbours_of(grid, i, state.x, state.y, rules.search_radius, found)]
        farthest = 0.0
        for o in range(first, last):
            farthest = max(farthest, table.reach[o])
        destination = state.destination[i]
        walls = near_walls(
            around, state.x[i], state.y[i], destination, farthest + state.core[i] + 0.01
        )
        exits_near = _exits_near(around, state.x[i], state.y[i], destination, farthest)

        item = np.empty(last - first, np.int64)
        size = 0
        # Whoever may leave by an exit may be out before it would meet anybody: no screening then.
        screened = rules.cores and not exits_near
        if screened:
            marked[:] = False
            mark_bodies(i, frame, near, state, farthest, screen.side, marked)
        for o in range(first, last):
            if screened and _is_marked(screen.cells[o], marked):
                continue
            item[size] = o
            size += 1
        item = item[:size]
        key = np.zeros(size)
        if len(extra) > 0:
            for k in range(size):
                key[k] = extra[extra_offsets[d] + item[k] - first]
        option_costs(i, item, table, state, terms, key)
        complete = np.zeros(last - first, np.bool_)
        leaving = np.empty(last - first, np.int64)
        if eager:
            for k in range(size):
                key[k] += pair_cost(i, item[k], table, state, velocity, near, terms)
        for root in range(size // 2 - 1, -1, -1):
            _sift_down(key, item, size, root)
        chosen = -1
        while size > 0:
            o = item[0]
            if complete[o - first]:
                chosen = o
                break
            pieces = lay_path(i, o, table, state, path)
            gone = path_gone_or_blocked(
                i, path, pieces, SAMPLE_FRAMES, table.reach[o], frame, state, walls, around, near,
                exits_near, rules.cores,
            )  # fmt: skip
            if gone < -1:
                size -= 1
                key[0], item[0] = key[size], item[size]
            else:
                complete[o - first] = True
                leaving[o - first] = gone
                if not eager:
                    key[0] += pair_cost(i, o, table, state, velocity, near, terms)
            if size > 0:
                _sift_down(key, item, size, 0)

        state.decisions[i] += 1
        if chosen >= 0:
            pieces = lay_path(i, chosen, table, state, state.path[i])
            gone = leaving[chosen - first]
            _commit(i, chosen, frame, pieces, SAMPLE_FRAMES, gone, table.cluster[chosen], state)
        else:
            _fall_back(i, frame, state, walls, around, near, exits_near, rules)


@njit(cache=True)
def _is_marked(cells: NDArray[np.int32], marked: NDArray[np.bool_]) -> bool:
    for level in range(len(cells)):
        if cells[level] >= 0 and marked[level, cells[level]]:
            return True
    return False


@njit(cache=True)
def _exits_near(around: Surroundings, x: float, y: float, destination: int, reach: float) -> bool:
    for e in range(len(around.exits)):
        ax, ay, bx, by = around.exits[e]
        if (
            around.leads_out[destination, e]
            and min(ax, bx) - reach <= x <= max(ax, bx) + reach
            and min(ay, by) - reach <= y <= max(ay, by) + reach
        ):
            return True
    return False


@njit(cache=True)
def _commit(
    i: int,
    option: int,
    frame: int,
    pieces: int,
    spacing: int,
    gone: int,
    cluster: int,
    state: CrowdState,
) -> None:
    path = state.path[i]
    seconds = pieces * spacing * FRAME_SECONDS
    state.option[i] = option
    state.start[i], state.end[i], state.gone[i] = frame, frame + pieces * spacing, gone
    state.spacing[i], state.knots[i] = spacing, pieces + 1
    state.cluster[i] = cluster
    state.vx[i] = (path[pieces, 0] - path[0, 0]) / seconds
    state.vy[i] = (path[pieces, 1] - path[0, 1]) / seconds
    x0, y0, x1, y1 = _box(path, pieces)
    state.box[i, 0], state.box[i, 1], state.box[i, 2], state.box[i, 3] = x0, y0, x1, y1


@njit(cache=True)
def _fall_back(
    i: int,
    frame: int,
    state: CrowdState,
    walls: NDArray[np.float64],
    around: Surroundings,
    near: NDArray[np.int64],
    exits_near: bool,
    rules: Rules,
) -> None:
    """Straight towards the target for four frames, as far as nothing is hit; then from standing."""
    seconds = FALLBACK_FRAMES * FRAME_SECONDS
    dx, dy = state.target_x[i] - state.x[i], state.target_y[i] - state.y[i]
    distance = math.hypot(dx, dy)
    turn = 0.0
    if distance > 0.0:
        dx, dy = dx / distance, dy / distance
        turn = math.atan2(dy, dx) - state.heading[i]
        turn = math.atan2(math.sin(turn), math.cos(turn))
        most = FALLBACK_TURN_RATE * seconds
        turn = min(max(turn, -most), most)
    path = state.path[i]
    trial = np.empty((2, 3))
    trial[0, 0], trial[0, 1], trial[0, 2] = state.x[i], state.y[i], state.heading[i]
    trial[1, 2] = state.heading[i] + turn
    gone = -1
    for share in FALLBACK_STEPS:
        length = min(share * state.preferred[i] * seconds, distance)
        trial[1, 0], trial[1, 1] = state.x[i] + length * dx, state.y[i] + length * dy
        if length == 0.0:
            break
        gone = path_gone_or_blocked(
            i, trial, 1, FALLBACK_FRAMES, length, frame, state, walls, around, near, exits_near,
            rules.cores,
        )  # fmt: skip
        if gone >= -1:
            break
    path[:2] = trial
    standing = rules.standing[state.kind[i]]
    state.fallbacks[i] += 1
    _commit(i, FALLBACK, frame, 1, FALLBACK_FRAMES, max(gone, -1), standing, state)


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
