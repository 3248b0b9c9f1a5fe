"""Which options of measured people hit nothing."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.collision.exact import exit_distance, near_walls, wall_reach
from mesa_mobility.crowd.options.table import SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.planning.feasibility import Obstacles, Trial, path_gone_or_blocked
from mesa_mobility.crowd.state.paths import to_world
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.surroundings import Surroundings

FREE, WALL, PERSON = 0, 1, 2
"""What an option hits."""


@entry_point()
def what_is_hit(
    i: int,
    options: NDArray[np.int64],
    ahead: NDArray[np.int64],
    hard_bodies: bool,
    table: OptionTable,
    state: CrowdState,
    around: Surroundings,
    walls: NDArray[np.float64],
    hit: NDArray[np.int8],
) -> None:
    """Write what each option of the person in row i hits.

    ``ahead`` are rows of people, who walk on as the crowd's records say; ``walls`` (all + 1, 48) is
    workspace.
    """
    path = walls[len(walls) - 1].reshape(3, 16)
    farthest = 0.0
    for o in options:
        farthest = max(farthest, table.options[o].reach)
    x, y, destination = state.x[i], state.y[i], state.destination[i]
    reach = wall_reach(farthest, state.core[i])
    near = walls[: near_walls(around, x, y, destination, reach, walls)]
    exits_near = farthest >= exit_distance(around, x, y, destination)
    obstacles = Obstacles(near, around, ahead, exits_near, hard_bodies)
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    for k in range(len(options)):
        o = options[k]
        pieces = to_world(i, o, c, s, table, state, path)
        trial = Trial(path, pieces, np.int64(SAMPLE_FRAMES), np.float64(table.options[o].reach))
        gone = path_gone_or_blocked(i, trial, 0, table, state, obstacles)
        hit[k] = WALL if gone == -3 else PERSON if gone == -2 else FREE
