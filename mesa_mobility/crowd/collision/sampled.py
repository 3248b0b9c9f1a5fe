"""Sampled collision tests between a pedestrian's options and the people nearby.

An option certainly hits a person if one of its samples lies within that person at the same time.
It certainly does not if all its samples stay farther away than both can move between samples. Only
the remaining cases need the exact test.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.compiled.intrinsics import prefetch
from mesa_mobility.compiled.simd import WIDE, lowest_bit
from mesa_mobility.crowd.collision.simd_boxes import near_box
from mesa_mobility.crowd.collision.simd_transforms import samples_to_ego
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, SAMPLES, OptionTable, in_lines
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.paths import Box, box_of, position_at
from mesa_mobility.crowd.state.records import CrowdState

SLACK = 1e-5
"""Metres for the rounding of single precision."""


class EgoPose(NamedTuple):
    """A deciding pedestrian: position (m), cosine and sine of its heading, and core radius (m)."""

    row: int
    x: float
    y: float
    c: float
    s: float
    core: float


NEARBY = np.dtype(
    [
        ("who", "i8"),
        ("apart", "f8"),
        ("laid", "?"),
    ],
    align=True,
)
"""Record of a person who may come in the way, in the deciding pedestrian's coordinates, metres.

Fields: ``who`` row; ``apart`` the distance that the cores keep; ``laid``, whether the path is
transformed.
"""


class Close(NamedTuple):
    """People whose movement may come in the way.

    Fields: ``people`` (n,) records of ``NEARBY``.  In the deciding pedestrian's coordinates,
    metres: ``sweeps`` (3, n and padding) x, y and radius of circles around their remaining paths,
    the distance to keep included; ``ahead`` (n, 2, 16) their positions at the sample times;
    ``known`` (2,) how many of ``people`` may come in the way, and from which index on to the end
    are those who are too close already.
    """

    known: NDArray[np.int64]
    people: NDArray[np.void]
    sweeps: NDArray[np.float32]
    ahead: NDArray[np.float32]


def make_close(people: int) -> Close:
    """Arrays for a number of people."""
    return Close(
        np.zeros(2, np.int64),
        np.empty(people, NEARBY),
        np.zeros((3, people + WIDE), np.float32),
        in_lines((people, 2, SAMPLES), np.float32),
    )


@internal()
def off_box2(x: float, y: float, box: Box) -> float:
    """Squared distance from (x, y) to a box, m2; 0 within it."""
    x0, y0, x1, y1 = box
    dx, dy = max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)
    return dx * dx + dy * dy


@force_inlined()
def broad_phase_neighbours(
    me: EgoPose,
    near: NDArray[np.int64],
    sweeps: NDArray[np.float64],
    box: Box,
    state: CrowdState,
    picked: NDArray[np.int64],
    dropped: NDArray[np.int32],
    to: Close,
) -> None:
    """Write those of ``near`` who may come into a box in the pedestrian's coordinates.

    For those who are too close already the exact test has a rule of its own. ``sweeps`` (3, n) has
    x, y and radius of circles around their paths; ``picked`` and ``dropped`` are workspace.
    """
    sweep_x, sweep_y, radius = sweeps[0], sweeps[1], sweeps[2]
    px, py, c, s = me.x, me.y, me.c, me.s
    own = me.core + MARGIN + SLACK
    for a in range(len(near)):
        dx, dy = sweep_x[a] - px, sweep_y[a] - py
        x, y = c * dx + s * dy, c * dy - s * dx
        sweep = radius[a] + own
        dropped[a] = np.int32(off_box2(x, y, box) >= sweep * sweep)
    n = 0
    for a in range(len(near)):
        picked[n] = a
        n += 1 - dropped[a]
    for q in range(n):
        prefetch(state, near[picked[q]], 256)
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
    to.known[0], to.known[1] = count, touching


@internal()
def lay_ahead(
    a: int, me: EgoPose, frame: int, table: OptionTable, state: CrowdState, close: Close
) -> None:
    """Write the positions of close person a at the sample times, unless done."""
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
        turn = me.c * c + me.s * s, me.c * s - me.s * c
        place = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        at = 2 * SAMPLES * a
        samples_to_ego(table.path, state.option[j], first, share, turn, place, ahead, at)
        return
    for k in range(SAMPLES):
        jx, jy = position_at(state, table, j, frame + SAMPLE_FRAMES * k)
        ahead[a, 0, k] = me.c * (jx - me.x) + me.s * (jy - me.y)
        ahead[a, 1, k] = me.c * (jy - me.y) - me.s * (jx - me.x)


@internal()
def sampled_collision(
    me: EgoPose,
    frame: int,
    own: NDArray[np.float32],
    stride: float,
    first: int,
    table: OptionTable,
    state: CrowdState,
    close: Close,
    unsure: NDArray[np.int64],
) -> tuple[int, int]:
    """People whom a path hits, certainly or possibly.

    Args:
        me: the pedestrian.
        frame: now.
        own: (3, 16) the path at the sample times, in the pedestrian's coordinates.
        stride: greatest distance between two successive samples, metres.
        first: index of the person to test first: options close in rank mostly hit the same
            person.
        table: options of all capabilities.
        state: the crowd.
        close: these people; positions are written when they are first needed.
        unsure: gets rows of people left to the exact test.

    Returns:
        Index of a person who is certainly hit, or -1; number of rows in ``unsure``.
    """
    doubtful, count = 0, close.known[0]
    half = np.float32(0.5 * stride + 3.0 * SLACK)
    x0, y0, x1, y1 = box_of(own, SAMPLES - 1)
    own_x, own_y = own[0], own[1]
    for block in range(-WIDE, count, WIDE):
        # The first person is tested before all others.
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
