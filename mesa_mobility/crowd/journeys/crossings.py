"""When people cross the gates of their route, from the paths that they have walked."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.state.paths import waypoint
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2
from mesa_mobility.floorplan.routing.route_graph import IN_LINE


@entry_point()
def find_crossings(
    rows: NDArray[np.int64],
    lines: NDArray[np.float64],
    frame: int,
    since: NDArray[np.float64],
    table: OptionTable,
    state: CrowdState,
    when: NDArray[np.float64],
) -> None:
    """Write the frame at which people first crossed their line after ``since``, if they have.

    Args:
        rows: (n,) the people.
        lines: (n, 4) the line that each is to cross, metres; nan for none.
        frame: now.
        since: (n,) frame up to which the path of each has been checked.
        table: the options, which hold the paths.
        state: the crowd's records.
        when: (n,) result; left as it is for those who have not crossed.
    """
    for a in range(len(rows)):
        i = rows[a]
        cx, cy, dx, dy = lines[a]
        vx, vy = dx - cx, dy - cy
        bx, by = state.from_x[i], state.from_y[i]
        for k in range(state.knots[i] - 1):
            ax, ay = bx, by
            bx, by = waypoint(state, table, i, k + 1)
            begin = state.start[i] + k * state.spacing[i]
            if begin + state.spacing[i] <= since[a] or begin >= frame:
                continue
            ux, uy = bx - ax, by - ay
            det = ux * vy - uy * vx
            if det == 0.0:
                continue
            wx, wy = cx - ax, cy - ay
            u = (wx * vy - wy * vx) / det
            v = (wx * uy - wy * ux) / det
            t = begin + u * state.spacing[i]
            if 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0 and since[a] < t <= frame:
                when[a] = t
                break
        # The router treats people this near to the line as past it.
        if math.isinf(when[a]) and since[a] < frame:
            d2 = point_segment_distance2(state.x[i], state.y[i], cx, cy, dx, dy)
            if d2 <= IN_LINE * IN_LINE:
                when[a] = frame
