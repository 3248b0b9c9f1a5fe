"""People step off the line of a door that has closed on them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.shapes import ShapeRecords
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2

CLEAR = 1.0
"""Metres by which somebody aims beyond what is needed: a wheelchair does not set off for less. They
stop once they are clear."""

TOUCHING = 1e-3
"""Metres by which a body may be across a line, from the rounding of places."""


@entry_point()
def step_off(
    rows: NDArray[np.int64],
    lines: NDArray[np.float64],
    shapes: ShapeRecords,
    state: CrowdState,
    points: NDArray[np.float64],
    across: NDArray[np.bool_],
) -> None:
    """Set the points of those whose body is across a closed line.

    They go at right angles to it, to the side on which their middle is.

    Args:
        rows: (n,) people who decide.
        lines: (m, 4) gates and exits that are closed, metres.
        shapes: of the types' bodies.
        state: the crowd.
        points: (n, 2) to which they go, metres; written to.
        across: (n,) set to whether each steps off; False before.
    """
    for k in range(len(rows)):
        i, worst = rows[k], TOUCHING
        shape, core = shapes[state[i].type_index], state[i].core
        c, s = math.cos(state[i].heading), math.sin(state[i].heading)
        for w in range(len(lines)):
            ax, ay, bx, by = lines[w]
            nx, ny = ay - by, bx - ax
            length = math.hypot(nx, ny)
            aside = ((state[i].x - ax) * nx + (state[i].y - ay) * ny) / length
            for d in range(shape.discs):
                off, r = core * shape.offset[d], core * shape.radius[d]
                x, y = state[i].x + off * c, state[i].y + off * s
                deep = r - math.sqrt(point_segment_distance2(x, y, ax, ay, bx, by))
                if deep > worst:
                    worst, across[k] = deep, True
                    far = math.copysign(deep + CLEAR, aside) / length
                    points[k, 0] = state[i].x + far * nx
                    points[k, 1] = state[i].y + far * ny
