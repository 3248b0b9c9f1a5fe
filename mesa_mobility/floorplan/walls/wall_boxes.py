"""Walls in boxes, eight to a box. Most are far from a line, and a box excludes eight at once.

A box is kept as its middle and half its extent, eight boxes side by side for the registers of a
processor: first those around eight walls each, then those of the walls themselves.
"""

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined
from mesa_mobility.compiled.simd import LANES

FEW = 3
"""Outer boxes that are not worth a row."""


def boxes_around(
    segments: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Boxes of (m, 4) segments, and around up to eight of them that are near each other.

    Returns (g, 4, 8) eight boxes in each row, with x and y of their middles and half their widths
    and heights in metres; and (b, 8) the numbers of the segments in each of the b outer boxes.
    These are in the first rows, but for `FEW`, and their segments in the last b. What fills up a
    row is nowhere.
    """
    a, b = segments[:, :2], segments[:, 2:]
    low, high = np.minimum(a, b), np.maximum(a, b)
    parts = (
        _near_each_other(np.arange(len(segments), dtype=np.int64), (low + high) / 2)
        if len(segments)
        else []
    )
    numbers = np.zeros((len(parts), LANES), dtype=np.int64)
    inner = np.empty((len(parts), 4, LANES))
    # A few boxes are looked into at once.
    outer = np.empty((-(-len(parts) // LANES) if len(parts) > FEW else 0, 4, LANES))
    for boxes in (inner, outer):
        boxes[:, :2], boxes[:, 2:] = 0.0, -np.inf
    for k, part in enumerate(parts):
        numbers[k, : len(part)] = part
        inner[k, :, : len(part)] = _box(low[part], high[part])
        if len(outer):
            outer[k // LANES, :, k % LANES] = _box(low[part].min(axis=0), high[part].max(axis=0))
    return np.concatenate([outer, inner]), numbers


def _box(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4,) or (4, n) middles and half extents."""
    return np.concatenate([(low + high).T / 2, (high - low).T / 2])


def _near_each_other(
    which: NDArray[np.int64], middles: NDArray[np.float64]
) -> list[NDArray[np.int64]]:
    """Those of some segments in parts of eight, the last one of what is left."""
    if len(which) <= LANES:
        return [which]
    axis = int(np.argmax(np.ptp(middles[which], axis=0)))
    which = which[np.argsort(middles[which, axis], kind="stable")]
    half = -(-len(which) // (2 * LANES)) * LANES
    return _near_each_other(which[:half], middles) + _near_each_other(which[half:], middles)


@force_inlined()
def near_line(
    boxes: NDArray[np.float64],
    row: int,
    px: float,
    py: float,
    qx: float,
    qy: float,
    reach: float,
) -> int:
    """Bits of those of the 8 boxes of a row that may lie within ``reach`` of the segment pq.

    Of boxes around both, and of the box's extent across the line through p and q.
    """
    dx, dy = qx - px, qy - py
    far = math.sqrt(dx * dx + dy * dy) * reach
    mx, my = 0.5 * (px + qx), 0.5 * (py + qy)
    wide_x, wide_y = 0.5 * abs(dx) + reach, 0.5 * abs(dy) + reach
    bits = 0
    for lane in range(LANES):
        off_x, off_y = boxes[row, 0, lane] - mx, boxes[row, 1, lane] - my
        hx, hy = boxes[row, 2, lane], boxes[row, 3, lane]
        near = (abs(off_x) <= hx + wide_x) & (abs(off_y) <= hy + wide_y)
        aside = abs(dx * off_y - dy * off_x)
        near &= aside <= hx * abs(dy) + hy * abs(dx) + far
        bits |= int(near) << lane
    return bits
