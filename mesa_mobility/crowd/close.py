"""Who may come in the way of a pedestrian, and where they will be.

An option whose sample falls within somebody at that very time hits it, whatever
happens between samples; one whose samples all stay farther away than both can move
between samples does not. Only what is left needs the exact test.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.collision import MARGIN, box_of
from mesa_mobility.crowd.options import SAMPLE_FRAMES, SAMPLES, OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.under_way import position_at
from mesa_mobility.jit import lean

SLACK = 1e-5
"""Metres for the rounding of single precision."""


class Stance(NamedTuple):
    """A pedestrian at its decision: place (m), cosine and sine of its facing, core radius (m)."""

    row: int
    x: float
    y: float
    c: float
    s: float
    core: float


SOMEBODY = np.dtype(
    [
        ("who", "i8"),
        ("x", "f8"),
        ("y", "f8"),
        ("sweep", "f8"),
        ("apart", "f8"),
        ("laid", "?"),
        ("ahead", "f4", (2, SAMPLES)),
    ],
    align=True,
)
"""What is known of somebody whose movement may come in the way, in the frame of the pedestrian
that decides, metres.

Fields: ``who`` row; ``x``, ``y``, ``sweep`` a circle around all that they still cover, the distance
to keep included; ``apart`` that distance; ``ahead`` (2, 16) where they will be at the sample times,
if ``laid``.
"""


class Close(NamedTuple):
    """People whose movement may come in the way.

    Fields: ``people`` (n,) records of ``SOMEBODY``; ``run`` (2, 32) space to work in.
    """

    people: NDArray[np.void]
    run: NDArray[np.float64]


def make_close(people: int) -> Close:
    """Space for so many people."""
    return Close(np.empty(people, SOMEBODY), np.empty((2, 2 * SAMPLES)))


@lean()
def off_box2(x: float, y: float, x0: float, y0: float, x1: float, y1: float) -> float:
    """Squared distance from (x, y) to a box, m2; 0 within it."""
    dx, dy = max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)
    return dx * dx + dy * dy


@lean()
def find_close(
    me: Stance,
    near: NDArray[np.int64],
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    state: CrowdState,
    to: Close,
) -> tuple[int, int]:
    """Write those of ``near`` who may come into a box, given in the pedestrian's frame.

    Returns:
        Their number, and where in ``to.people`` those stand, up to its end, who are too close
        already: for them the exact test has a rule of its own.
    """
    count, touching = 0, len(to.people)
    for j in near:
        apart = me.core + state.core[j] + MARGIN
        dx, dy = state.sweep[j, 0] - me.x, state.sweep[j, 1] - me.y
        sweep = state.sweep[j, 2] + apart + SLACK
        x, y = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        if off_box2(x, y, x0, y0, x1, y1) >= sweep * sweep:
            continue
        dx, dy = state.x[j] - me.x, state.y[j] - me.y
        if dx * dx + dy * dy < apart * apart:
            touching -= 1
            to.people[touching].who = j
            continue
        somebody = to.people[count]
        somebody.who = j
        somebody.x, somebody.y, somebody.sweep = x, y, sweep
        somebody.apart = apart
        somebody.laid = False
        count += 1
    return count, touching


@lean()
def lay_ahead(
    a: int, me: Stance, frame: int, table: OptionTable, state: CrowdState, close: Close
) -> None:
    """Write where number a of those who are close will be at the sample times, unless done."""
    somebody = close.people[a]
    if somebody.laid:
        return
    somebody.laid = True
    j = somebody.who
    run_x, run_y, to_x, to_y = close.run[0], close.run[1], somebody.ahead[0], somebody.ahead[1]
    last = state.knots[j] - 1
    past = frame - state.start[j]
    first = past // SAMPLE_FRAMES
    if state.option[j] >= 0:
        # The knots to come, in one array with the end after them, so that all samples are alike.
        own = table.path[state.option[j]]
        own_x, own_y = own[0], own[1]
        x, y, c, s = state.from_x[j], state.from_y[j], state.from_c[j], state.from_s[j]
        for k in range(SAMPLES):
            run_x[k] = x + c * own_x[k] - s * own_y[k]
            run_y[k] = y + s * own_x[k] + c * own_y[k]
        end_x, end_y = state.to_x[j], state.to_y[j]
        for k in range(SAMPLES + 1):
            run_x[last + k], run_y[last + k] = end_x, end_y
        first = min(first, last)
        u = min((past - SAMPLE_FRAMES * first) / SAMPLE_FRAMES, 1.0)
        from_x, from_y, next_x, next_y = (
            run_x[first:], run_y[first:], run_x[first + 1 :], run_y[first + 1 :],
        )  # fmt: skip
        for k in range(SAMPLES):
            dx = from_x[k] + u * (next_x[k] - from_x[k]) - me.x
            dy = from_y[k] + u * (next_y[k] - from_y[k]) - me.y
            to_x[k] = me.c * dx + me.s * dy
            to_y[k] = me.c * dy - me.s * dx
    else:
        for k in range(SAMPLES):
            jx, jy = position_at(state, table, j, frame + SAMPLE_FRAMES * k)
            to_x[k] = me.c * (jx - me.x) + me.s * (jy - me.y)
            to_y[k] = me.c * (jy - me.y) - me.s * (jx - me.x)


@lean()
def meets(
    me: Stance,
    frame: int,
    own: NDArray[np.float32],
    stride: float,
    count: int,
    first: int,
    table: OptionTable,
    state: CrowdState,
    close: Close,
    unsure: NDArray[np.int64],
) -> tuple[int, int]:
    """Whom a path meets, for certain or maybe.

    Args:
        me: the pedestrian.
        frame: now.
        own: (3, 16) the path at the sample times, in the pedestrian's own frame.
        stride: longest way between two of its samples, metres.
        count: how many people are close.
        first: number of the person to look at first: options next to one another in
            rank mostly meet the same.
        table: options of all capabilities.
        state: the crowd.
        close: these people; where one will be is written when it is first needed.
        unsure: gets rows of those whom only the exact test can tell.

    Returns:
        Number of somebody who is met for certain, or -1; number of rows in ``unsure``.
    """
    doubtful = 0
    half = np.float32(0.5 * stride + 3.0 * SLACK)
    x0, y0, x1, y1 = box_of(own, SAMPLES - 1)
    own_x, own_y = own[0], own[1]
    for b in range(count):
        # The first changes places with number 0.
        a = first if b == 0 else (0 if b == first else b)
        somebody = close.people[a]
        sweep = somebody.sweep
        if off_box2(somebody.x, somebody.y, x0, y0, x1, y1) >= sweep * sweep:
            continue
        lay_ahead(a, me, frame, table, state, close)
        x, y = somebody.ahead[0], somebody.ahead[1]
        j = somebody.who
        least = np.float32(somebody.apart - SLACK)
        far = np.float32(least + half + 0.5 * state.stride[j])
        least2, far2 = least * least, far * far
        hit, near = False, False
        for k in range(SAMPLES):
            dx, dy = own_x[k] - x[k], own_y[k] - y[k]
            d2 = dx * dx + dy * dy
            hit |= d2 < least2
            near |= d2 < far2
        if hit:
            return a, doubtful
        if near:
            unsure[doubtful] = j
            doubtful += 1
    return -1, doubtful
