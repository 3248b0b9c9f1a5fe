"""Which options of measured people hit no wall."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.collision.exact import exit_distance, near_walls, wall_reach
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.planning.feasibility import Trial, path_gone_or_walled
from mesa_mobility.crowd.state.paths import to_world
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings


@entry_point()
def hit_walls(
    i: int,
    options: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    around: Surroundings,
    walls: NDArray[np.float64],
    path: NDArray[np.float64],
    hit: NDArray[np.bool_],
) -> None:
    """Write whether each option of the person in row i hits a wall.

    ``walls`` (all, 5) and ``path`` (3, 16) are workspace.
    """
    farthest = 0.0
    for o in options:
        farthest = max(farthest, table.options[o].reach)
    x, y, destination = state.x[i], state.y[i], state.destination[i]
    near = walls[: near_walls(around, x, y, destination, wall_reach(farthest, state.core[i]), walls)]
    exits_near = farthest >= exit_distance(around, x, y, destination)
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    for k in range(len(options)):
        o = options[k]
        pieces = to_world(i, o, c, s, table, state, path)
        trial = Trial(path, pieces, np.int64(SAMPLE_FRAMES), np.float64(table.options[o].reach))
        hit[k] = path_gone_or_walled(i, trial, 0, state, near, around, exits_near) == -3
