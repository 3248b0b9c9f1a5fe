"""People who take no decisions: they ride on, or stand, on a belt or in a car."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.waiting import wait_until
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES
from mesa_mobility.crowd.state.records import CARRIED, Crowd


def carry(
    rows: NDArray[np.int64],
    velocity: NDArray[np.float64],
    direction: NDArray[np.float64],
    frame: int,
    end: int,
    crowd: Crowd,
) -> None:
    """Have people ride straight on until a frame, turned to where they ride, or stand.

    Args:
        rows: (n,) the people.
        velocity: (2,) m/s; 0 to stand.
        direction: (2,) or (n, 2) unit vectors to which they turn.
        frame: now.
        end: until when.
        crowd: the crowd.
    """
    way = velocity * ((end - frame) * FRAME_SECONDS)
    crowd.option[rows], crowd.gone[rows] = CARRIED, -1
    crowd.start[rows], crowd.end[rows], crowd.spacing[rows] = frame, end, end - frame
    crowd.knots[rows] = 2
    for axis, name in enumerate("xy"):
        here = getattr(crowd, name)[rows]
        there = here + way[axis]
        getattr(crowd, f"from_{name}")[rows], getattr(crowd, f"to_{name}")[rows] = here, there
        getattr(crowd, f"v{name}")[rows] = velocity[axis]
        crowd.box[rows, axis] = np.minimum(here, there)
        crowd.box[rows, axis + 2] = np.maximum(here, there)
    heading = crowd.heading[rows]
    turn = np.arctan2(direction[..., 1], direction[..., 0]) - heading
    crowd.from_heading[rows] = heading
    crowd.to_heading[rows] = heading + (turn + np.pi) % (2.0 * np.pi) - np.pi
    crowd.from_c[rows], crowd.from_s[rows] = np.cos(heading), np.sin(heading)
    crowd.stride[rows] = np.hypot(*way) * SAMPLE_FRAMES / (end - frame)
    if way.any():
        wait_until(rows, end, crowd)
