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
from mesa_mobility.crowd.lanewise import near_box
from mesa_mobility.crowd.laying import lay_samples
from mesa_mobility.crowd.options import SAMPLE_FRAMES, SAMPLES, OptionTable, in_lines
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.crowd.under_way import position_at
from mesa_mobility.jit import lean, part
from mesa_mobility.lanes import WIDE, lowest_bit
from mesa_mobility.machine import fetch

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
        ("apart", "f8"),
        ("laid", "?"),
    ],
    align=True,
)
"""What is known of somebody whose movement may come in the way, in the frame of the pedestrian
that decides, metres.

Fields: ``who`` row; ``apart`` the distance to keep; ``laid``, whether it is known where they will
be.
"""


class Close(NamedTuple):
    """People whose movement may come in the way.

    Fields: ``people`` (n,) records of ``SOMEBODY``; in the frame of the pedestrian that decides,
    metres: ``sweeps`` (3, n and a few more) x, y and radius of circles around all that they still
    cover, the distance to keep included; ``ahead`` (n, 2, 16) where they will be at the sample
    times.
    """

    people: NDArray[np.void]
    sweeps: NDArray[np.float32]
    ahead: NDArray[np.float32]


def make_close(people: int) -> Close:
    """Space for so many people."""
    return Close(
        np.empty(people, SOMEBODY),
        np.zeros((3, people + WIDE), np.float32),
        in_lines((people, 2, SAMPLES), np.float32),
    )


@lean()
def off_box2(x: float, y: float, x0: float, y0: float, x1: float, y1: float) -> float:
    """Squared distance from (x, y) to a box, m2; 0 within it."""
    dx, dy = max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)
    return dx * dx + dy * dy


@part()
def find_close(
    me: Stance,
    near: NDArray[np.int64],
    sweeps: NDArray[np.float64],
    x0: float,
    y0: float,
    x1: float,
    y1: float,
    state: CrowdState,
    picked: NDArray[np.int64],
    dropped: NDArray[np.int32],
    to: Close,
) -> tuple[int, int]:
    """Write those of ``near`` who may come into a box, given in the pedestrian's frame.

    ``sweeps`` (3, n) x, y and radius of circles around all that they cover; ``picked`` and
    ``dropped`` are space to work in.

    Returns:
        Their number, and where in ``to.people`` those stand, up to its end, who are too close
        already: for them the exact test has a rule of its own.
    """
    sweep_x, sweep_y, radius = sweeps[0], sweeps[1], sweeps[2]
    px, py, c, s, own = me.x, me.y, me.c, me.s, me.core + MARGIN + SLACK
    for a in range(len(near)):
        dx, dy = sweep_x[a] - px, sweep_y[a] - py
        x, y = c * dx + s * dy, c * dy - s * dx
        sweep = radius[a] + own
        dropped[a] = np.int32(off_box2(x, y, x0, y0, x1, y1) >= sweep * sweep)
    n = 0
    for a in range(len(near)):
        picked[n] = a
        n += 1 - dropped[a]
    for q in range(n):
        fetch(state, near[picked[q]], 256)
    count, touching = 0, len(to.people)
    for q in range(n):
        a = picked[q]
        j = near[a]
        apart = me.core + state.core[j] + MARGIN
        dx, dy = state.x[j] - px, state.y[j] - py
        if dx * dx + dy * dy < apart * apart:
            touching -= 1
            to.people[touching].who = j
            continue
        dx, dy = sweep_x[a] - px, sweep_y[a] - py
        somebody = to.people[count]
        somebody.who = j
        to.sweeps[0, count], to.sweeps[1, count] = c * dx + s * dy, c * dy - s * dx
        to.sweeps[2, count] = radius[a] + own + SLACK
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
    ahead = close.ahead
    if state.option[j] >= 0 and state.spacing[j] == SAMPLE_FRAMES:
        past = frame - state.start[j]
        first = min(past // SAMPLE_FRAMES, SAMPLES - 1)
        share = min((past - SAMPLE_FRAMES * first) / SAMPLE_FRAMES, 1.0)
        dx, dy = state.from_x[j] - me.x, state.from_y[j] - me.y
        c, s = state.from_c[j], state.from_s[j]
        lay_samples(
            table.path, state.option[j], first, share, me.c * c + me.s * s, me.c * s - me.s * c,
            me.c * dx + me.s * dy, me.c * dy - me.s * dx, ahead, 2 * SAMPLES * a, SAMPLES,
        )  # fmt: skip
        return
    for k in range(SAMPLES):
        jx, jy = position_at(state, table, j, frame + SAMPLE_FRAMES * k)
        ahead[a, 0, k] = me.c * (jx - me.x) + me.s * (jy - me.y)
        ahead[a, 1, k] = me.c * (jy - me.y) - me.s * (jx - me.x)


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
    for block in range(-WIDE, count, WIDE):
        # Before all others the first is looked at.
        at, bits = first, int(count > 0)
        if block >= 0:
            at, bits = block, near_box(close.sweeps, block, close.sweeps.shape[1], x0, y0, x1, y1)
            bits &= (1 << min(count - block, WIDE)) - 1
        while bits != 0:
            a = at + lowest_bit(bits)
            bits &= bits - 1
            if block >= 0 and a == first:
                continue
            lay_ahead(a, me, frame, table, state, close)
            x, y = close.ahead[a, 0], close.ahead[a, 1]
            j = close.people[a].who
            least = np.float32(close.people[a].apart - SLACK)
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
