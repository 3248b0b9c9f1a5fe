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
from mesa_mobility.crowd.state.paths import box_of, position_at
from mesa_mobility.crowd.state.people_grid import COVERED, Grid
from mesa_mobility.crowd.state.records import CrowdState

SLACK = 1e-5
"""Metres for the rounding of single precision."""

_AHEAD = 4
"""People whose paths are prefetched."""


class Decider(NamedTuple):
    """Somebody who decides.

    Attributes:
        row: in the crowd.
        kind: index of the pedestrian type.
        x: metres.
        y: metres.
        c: cosine of the heading.
        s: sine of the heading.
        core: core radius, metres.
        record: (9 + fields,) the person as cost terms read them (see ``costs.layout``).
    """

    row: int
    kind: int
    x: float
    y: float
    c: float
    s: float
    core: float
    record: NDArray[np.float64]


class Close(NamedTuple):
    """People whose movement may come in the way.

    Lengths are in metres, and places in the coordinates of the pedestrian who decides.

    Attributes:
        who: (n,) rows of these people in the crowd.
        known: (2,) how many of the first ones may come in the way, and from which index on to the
            end are those who are too close already.
        sweeps: (3, n + padding) x, y and radius of circles around the people's remaining paths. The
            radius includes the distance to keep.
        ahead: (n, 3, 16) x and y at the sample times, and the distance that the cores keep.
    """

    known: NDArray[np.int64]
    who: NDArray[np.int64]
    sweeps: NDArray[np.float32]
    ahead: NDArray[np.float32]


def make_close(people: int) -> Close:
    """Arrays for a number of people."""
    return Close(
        np.zeros(2, np.int64),
        np.empty(people, np.int64),
        np.zeros((3, people + WIDE), np.float32),
        in_lines((people, 3, SAMPLES), np.float32),
    )


@force_inlined()
def lay_close(
    me: Decider,
    near: NDArray[np.int64],
    grid: Grid,
    frame: int,
    table: OptionTable,
    state: CrowdState,
    to: Close,
) -> None:
    """Write the people at indices ``near`` of the frame's grid.

    For those who are too close already the exact test has a rule of its own.
    """
    for a in near:
        prefetch(state, grid.people[a], 256)
    keep, count, touching = me.core + MARGIN + SLACK, 0, len(to.who)
    for a in near:
        j = grid.people[a]
        apart = me.core + state.core[j] + MARGIN
        dx, dy = grid.x[a] - me.x, grid.y[a] - me.y
        if dx * dx + dy * dy < apart * apart:
            touching -= 1
            to.who[touching] = j
            continue
        to.who[count] = j
        dx, dy = grid.table[COVERED, a] - me.x, grid.table[COVERED + 1, a] - me.y
        to.sweeps[0, count], to.sweeps[1, count] = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        to.sweeps[2, count] = grid.table[COVERED + 2, a] + keep + SLACK
        to.ahead[count, 2, :] = np.float32(apart - SLACK)
        count += 1
    to.known[0], to.known[1] = count, touching
    for a in range(count):
        if a + _AHEAD < count:
            prefetch(table.path, max(state.option[to.who[a + _AHEAD]], 0), 192)
        _lay_ahead(a, me, frame, table, state, to)


@internal()
def _lay_ahead(
    a: int, me: Decider, frame: int, table: OptionTable, state: CrowdState, close: Close
) -> None:
    """Write the positions of close person a at the sample times."""
    j, ahead = close.who[a], close.ahead
    if state.option[j] >= 0 and state.spacing[j] == SAMPLE_FRAMES:
        past = frame - state.start[j]
        first = min(past // SAMPLE_FRAMES, SAMPLES - 1)
        share = min((past - SAMPLE_FRAMES * first) / SAMPLE_FRAMES, 1.0)
        dx, dy = state.from_x[j] - me.x, state.from_y[j] - me.y
        c, s = state.from_c[j], state.from_s[j]
        turn = me.c * c + me.s * s, me.c * s - me.s * c
        place = me.c * dx + me.s * dy, me.c * dy - me.s * dx
        at = 3 * SAMPLES * a
        samples_to_ego(table.path, state.option[j], first, share, turn, place, ahead, at)
        return
    for k in range(SAMPLES):
        jx, jy = position_at(state, table, j, frame + SAMPLE_FRAMES * k)
        ahead[a, 0, k] = me.c * (jx - me.x) + me.s * (jy - me.y)
        ahead[a, 1, k] = me.c * (jy - me.y) - me.s * (jx - me.x)


@internal()
def sampled_collision(
    own: NDArray[np.float32],
    stride: float,
    first: int,
    state: CrowdState,
    close: Close,
    unsure: NDArray[np.int64],
) -> tuple[int, int]:
    """People whom a path hits, certainly or possibly.

    Args:
        own: (3, 16) the path at the sample times, in the pedestrian's coordinates.
        stride: greatest distance between two successive samples, metres.
        first: index of the person to test first: options close in rank mostly hit the same
            person.
        state: the crowd.
        close: these people.
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
            x, y, least = close.ahead[a, 0], close.ahead[a, 1], close.ahead[a, 2, 0]
            j = close.who[a]
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
