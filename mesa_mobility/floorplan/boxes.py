"""Walls in boxes, eight to a box: most are far from most lines, and many at once are told so.

A box is kept as its middle and half its extent, eight boxes side by side for the registers of a
processor: first those around eight walls each, then those of the walls themselves.
"""

# Intrinsics take their arguments by name and give Numba types.
# mypy: disable-error-code="no-untyped-def"

from functools import partial
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from mesa_mobility.lanes import DOUBLE, LANES, LONG, load, spread, start_of, whole

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
    parts = _near_each_other(np.arange(len(segments)), (low + high) / 2) if len(segments) else []
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


@intrinsic
def near_line(typingctx, boxes, row, px, py, qx, qy, reach):
    """Bits of those of the 8 boxes of a row that may lie within ``reach`` of the segment pq.

    Of boxes around both, and of the box's extent across the line through p and q.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        row = whole(context, builder, sig.args[1], args[1])
        px, py, qx, qy, reach = args[2:]
        add, sub, mul = builder.fadd, builder.fsub, builder.fmul
        half = ir.Constant(DOUBLE, 0.5)

        def call(name: str, value: Any) -> Any:
            kind = f"v{LANES}f64" if isinstance(value.type, ir.VectorType) else "f64"
            of = ir.FunctionType(value.type, [value.type])
            name = f"llvm.{name}.{kind}"
            return builder.call(cgutils.get_or_insert_function(builder.module, of, name), [value])

        size, root = partial(call, "fabs"), partial(call, "sqrt")
        first = builder.mul(row, ir.Constant(LONG, 4 * LANES))
        cx, cy, hx, hy = (
            load(builder, begin, builder.add(first, ir.Constant(LONG, LANES * k)), LANES)
            for k in range(4)
        )
        dx, dy = sub(qx, px), sub(qy, py)
        length = root(add(mul(dx, dx), mul(dy, dy)))
        off_x = sub(cx, spread(builder, mul(half, add(px, qx)), LANES))
        off_y = sub(cy, spread(builder, mul(half, add(py, qy)), LANES))
        wide_x = spread(builder, add(mul(half, size(dx)), reach), LANES)
        wide_y = spread(builder, add(mul(half, size(dy)), reach), LANES)
        near = builder.and_(
            builder.fcmp_ordered("<=", size(off_x), add(hx, wide_x)),
            builder.fcmp_ordered("<=", size(off_y), add(hy, wide_y)),
        )
        along_x, along_y = (spread(builder, value, LANES) for value in (dx, dy))
        aside = size(sub(mul(along_x, off_y), mul(along_y, off_x)))
        across = add(mul(hx, size(along_y)), mul(hy, size(along_x)))
        room = add(across, spread(builder, mul(length, reach), LANES))
        near = builder.and_(near, builder.fcmp_ordered("<=", aside, room))
        return builder.zext(builder.bitcast(near, ir.IntType(LANES)), LONG)

    return types.int64(boxes, row, *[types.float64] * 5), codegen
