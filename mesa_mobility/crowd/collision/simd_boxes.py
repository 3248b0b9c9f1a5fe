"""Bounding boxes of several circles at once, and what reaches into a box.

Arrays are given as to ``simd_tests``.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined
from mesa_mobility.compiled.simd import LANES, WIDE
from mesa_mobility.compiled.twins import with_twin
from mesa_mobility.compiled.vectors import (
    DOUBLE,
    FLOAT,
    INT,
    LONG,
    across,
    less_of,
    load,
    load_three,
    more_of,
    same,
    start_of,
    whole,
)
from mesa_mobility.crowd.options.table import LEVELS
from mesa_mobility.crowd.state.paths import Box

NOTHING = np.float32(0.0)
ENDLESS = np.float32(np.inf)


@force_inlined()
def near_box(
    circles: NDArray[np.float32], at: int, row: int, x0: float, y0: float, x1: float, y1: float
) -> int:
    """Bits of those of 16 circles that reach into a box; arguments as of ``drop_within``."""
    of = circles.flat
    left, low, right, high = np.float32(x0), np.float32(y0), np.float32(x1), np.float32(y1)
    bits = 0
    for lane in range(WIDE):
        x, y, radius = of[at + lane], of[at + row + lane], of[at + 2 * row + lane]
        dx, dy = _beyond(x, left, right), _beyond(y, low, high)
        bits |= int(dx * dx + dy * dy < radius * radius) << lane
    return bits


@force_inlined()
def off_box2(x: float, y: float, box: Box) -> float:
    """Squared distance from (x, y) to a box, m2; 0 within it."""
    x0, y0, x1, y1 = box
    dx, dy = max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)
    return dx * dx + dy * dy


@force_inlined()
def sweeps_near(
    circles: NDArray[np.float64],
    at: int,
    row: int,
    pose: tuple[float, float, float, float],
    keep: float,
    box: Box,
) -> int:
    """Bits of those of 8 circles in the world that come nearer than ``keep`` to a box.

    The box is in the coordinates of somebody with ``pose``: place, cosine and sine of the heading.
    Other arguments as of ``drop_within``.
    """
    of = circles.flat
    px, py, c, s = pose
    bits = 0
    for lane in range(LANES):
        dx, dy = of[at + lane] - px, of[at + row + lane] - py
        x, y, radius = c * dx + s * dy, c * dy - s * dx, of[at + 2 * row + lane] + keep
        bits |= int(off_box2(x, y, box) < radius * radius) << lane
    return bits


@force_inlined()
def _beyond(place: np.float32, low: np.float32, high: np.float32) -> Any:
    """How far a place is outside of an interval."""
    away = low - place if low - place > place - high else place - high
    return away if away > NOTHING else NOTHING


def _plain_extent(
    circles: NDArray[np.float32], at: int, row: int, n: int, dropped: NDArray[np.int32]
) -> tuple[float, float, float, float]:
    of = circles.flat
    x0, y0, x1, y1 = ENDLESS, ENDLESS, -ENDLESS, -ENDLESS
    for k in range(n):
        if dropped[k] == 0:
            x, y, radius = of[at + k], of[at + row + k], of[at + 2 * row + k]
            x0, y0 = min(x0, x - radius), min(y0, y - radius)
            x1, y1 = max(x1, x + radius), max(y1, y + radius)
    return np.float64(x0), np.float64(y0), np.float64(x1), np.float64(y1)


@with_twin(_plain_extent)
def extent(typingctx, circles, at, row, n, dropped):
    """A box around those of n circles that are not dropped: least x and y, greatest x and y.

    Arguments as of ``drop_within``. If all are dropped, it is empty: the least are inf, the
    greatest -inf.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        marks = start_of(context, builder, sig.args[4], args[4])
        at, row, n = (whole(context, builder, sig.args[k], args[k]) for k in (1, 2, 3))
        ends = [(less_of, np.inf)] * 2 + [(more_of, -np.inf)] * 2
        found = [cgutils.alloca_once_value(builder, same(FLOAT, WIDE, end)) for _, end in ends]
        wide = ir.Constant(LONG, WIDE)
        with cgutils.for_range_slice(builder, ir.Constant(LONG, 0), n, wide) as (block, _):
            x, y, radius = load_three(builder, begin, builder.add(at, block), row, WIDE)
            kept = builder.icmp_signed("==", load(builder, marks, block, WIDE), same(INT, WIDE, 0))
            low = [builder.fsub(middle, radius) for middle in (x, y)]
            high = [builder.fadd(middle, radius) for middle in (x, y)]
            for (of_two, none), slot, value in zip(ends, found, low + high, strict=True):
                value = builder.select(kept, value, same(FLOAT, WIDE, none))
                builder.store(of_two(builder, value, builder.load(slot)), slot)
        box = [
            builder.fpext(across(builder, builder.load(slot), of_two), DOUBLE)
            for (of_two, _), slot in zip(ends, found, strict=True)
        ]
        return context.make_tuple(builder, sig.return_type, box)

    return types.UniTuple(types.float64, 4)(circles, at, row, n, dropped), codegen


@force_inlined()
def levels_within(ahead: NDArray[np.float32], at: int, row: int, spans: NDArray[np.float32]) -> int:
    """Bits of the levels at which somebody is nearer to a box than the distance to keep.

    ``ahead`` C-contiguous: x at the 16 samples from place ``at`` on, y ``row`` places and the
    distance twice as many farther on; ``spans`` (4, levels), C-contiguous: least x and y, greatest
    x and y of the boxes.
    """
    of, apart = ahead.flat, ahead.flat[at + 2 * row]
    most = apart * apart
    bits = 0
    for level in range(len(LEVELS)):
        sample = at + LEVELS[level]
        dx = _beyond(of[sample], spans[0, level], spans[2, level])
        dy = _beyond(of[sample + row], spans[1, level], spans[3, level])
        bits |= int(dx * dx + dy * dy < most) << level
    return bits
