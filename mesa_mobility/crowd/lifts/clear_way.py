"""Whether people who are carried would run into others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.state.paths import position_at
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2

_TOUCHING = 1e-6
"""Metres by which bodies may overlap, for rounding."""


@entry_point()
def way_is_clear(
    riders: NDArray[np.int64],
    others: NDArray[np.int64],
    shifts: NDArray[np.float64],
    velocity: NDArray[np.float64],
    end: int,
    times: tuple[int, int],
    table: OptionTable,
    state: CrowdState,
) -> bool:
    """Whether riders meet nobody until they come to stand, and nobody meets them there.

    Everybody moves in straight lines between frames, and stands at the end of their movement.

    Args:
        riders: (n,) their rows.
        others: (m,) rows of the others.
        shifts: (n + m, 2) metres from where each is drawn to one drawing of all.
        velocity: (2,) of the riders, m/s.
        end: frame at which they come to stand.
        times: the frame at which riders are where their records say, and that from which on the
            way has to be clear.
        table: the movement options.
        state: the crowd.
    """
    now, first = times
    for a in range(len(riders)):
        i = riders[a]
        x, y = state.x[i] + shifts[a, 0], state.y[i] + shifts[a, 1]
        for b in range(len(others)):
            j, k = others[b], len(riders) + b
            apart = state.core[i] + state.core[j] - _TOUCHING
            px, py = 0.0, 0.0
            # Those who stand may do so for long.
            last = max(end, state.end[j]) if state.stride[j] > 0.0 else end
            for frame in range(first, last + 1):
                seconds = (min(frame, end) - now) * FRAME_SECONDS
                ox, oy = position_at(state, table, j, float(frame))
                qx = x + velocity[0] * seconds - ox - shifts[k, 0]
                qy = y + velocity[1] * seconds - oy - shifts[k, 1]
                if frame == first:
                    px, py = qx, qy
                if point_segment_distance2(0.0, 0.0, px, py, qx, qy) < apart * apart:
                    return False
                px, py = qx, qy
    return True
