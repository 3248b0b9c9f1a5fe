"""Writing what people want to the crowd's records."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.state.records import CrowdState


@entry_point()
def settle(
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Write targets (n, 2), metres, and preferred speeds (n,), m/s, of those in ``rows``."""
    for k in range(len(rows)):
        i = rows[k]
        state[i].target_x, state[i].target_y = points[k, 0], points[k, 1]
        state[i].preferred = speeds[k]
