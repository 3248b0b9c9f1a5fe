"""Options and movements under way laid out where they lead, several numbers at once."""

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
from mesa_mobility.compiled.simd import LANES, SAMPLES
from mesa_mobility.compiled.twins import with_twin
from mesa_mobility.compiled.vectors import (
    DOUBLE,
    LONG,
    load,
    spread,
    start_of,
    store,
    whole,
)


def _plain_lanes_to_world(
    lanes: NDArray[np.float32],
    group: int,
    ends: NDArray[np.float64],
    at: int,
    pose: tuple[float, float, float, float],
    seconds: float,
) -> None:
    px, py, c, s = pose
    for lane in range(LANES):
        x, y = np.float64(lanes[group, 0, lane]), np.float64(lanes[group, 1, lane])
        ux, uy = np.float64(lanes[group, 2, lane]), np.float64(lanes[group, 3, lane])
        k = at + lane
        ends[0, k], ends[1, k] = px + c * x - s * y, py + s * x + c * y
        ends[2, k], ends[3, k] = c * ux - s * uy, s * ux + c * uy
        ends[4, k], ends[5, k] = seconds, lanes[group, 4, lane]


@with_twin(_plain_lanes_to_world)
def lanes_to_world(typingctx, lanes, group, ends, at, pose, seconds):
    """Write where the 8 options of a group end, in the world, from column ``at`` of ``ends`` on.

    ``lanes`` (groups, fields, 8), C-contiguous, with the fields x, y, ux, uy and speed first;
    ``ends`` (6, n), C-contiguous, gets x, y, ux, uy, the seconds that they all take and the speed;
    ``pose`` is where the pedestrian stands, and cosine and sine of their heading.
    """

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        begin = start_of(context, builder, sig.args[0], args[0])
        to = start_of(context, builder, sig.args[2], args[2])
        shape = cgutils.create_struct_proxy(sig.args[0])(context, builder, args[0]).shape
        width = cgutils.create_struct_proxy(sig.args[2])(context, builder, args[2]).shape
        per_group = builder.mul(builder.extract_value(shape, 1), builder.extract_value(shape, 2))
        of = builder.mul(per_group, whole(context, builder, sig.args[1], args[1]))
        row, at = builder.extract_value(width, 1), whole(context, builder, sig.args[3], args[3])
        fields = []
        for _ in range(5):
            field = load(builder, begin, of, LANES)
            fields.append(builder.fpext(field, ir.VectorType(DOUBLE, LANES)))
            of = builder.add(of, ir.Constant(LONG, LANES))
        x, y, ux, uy, speed = fields
        pose = (builder.extract_value(args[4], k) for k in range(4))
        px, py, c, s, seconds = (spread(builder, each, LANES) for each in (*pose, args[5]))
        add, sub, mul = builder.fadd, builder.fsub, builder.fmul
        rows = (
            sub(add(px, mul(c, x)), mul(s, y)),
            add(add(py, mul(s, x)), mul(c, y)),
            sub(mul(c, ux), mul(s, uy)),
            add(mul(s, ux), mul(c, uy)),
            seconds,
            speed,
        )
        for value in rows:
            store(builder, value, to, at)
            at = builder.add(at, row)
        return context.get_dummy_value()

    given = [types.UniTuple(types.float64, 4), types.float64]
    return types.void(lanes, group, ends, at, *given), codegen


@force_inlined()
def samples_to_ego(
    paths: NDArray[np.float32],
    path: int,
    first: int,
    share: float,
    turn: tuple[float, float],
    place: tuple[float, float],
    to: NDArray[np.float32],
    at: int,
) -> None:
    """Write where somebody on a path is at the sample times to come, 16 of them.

    Args:
        paths: (n, 3, 16), C-contiguous: x, y and something else at the samples, the last ones at
            the end.
        path: which one.
        first: sample that comes before now, 15 at most.
        share: how much of the way from there to the next one is behind, 0 to 1.
        turn: cosine and sine of the angle by which the path is turned.
        place: where the path begins, metres.
        to: C-contiguous; gets x from place ``at`` on and then y.
        at: place.
    """
    target = to.flat
    along, cosine, sine = np.float32(share), np.float32(turn[0]), np.float32(turn[1])
    from_x, from_y = np.float32(place[0]), np.float32(place[1])
    for k in range(SAMPLES):
        here, there = min(first + k, SAMPLES - 1), min(first + k + 1, SAMPLES - 1)
        px, py = paths[path, 0, here], paths[path, 1, here]
        own_x = px + along * (paths[path, 0, there] - px)
        own_y = py + along * (paths[path, 1, there] - py)
        target[at + k] = from_x + (cosine * own_x - sine * own_y)
        target[at + SAMPLES + k] = from_y + (sine * own_x + cosine * own_y)
