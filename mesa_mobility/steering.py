"""What compiled tactics are made of: records of people, neighbours in a grid, lines of sight.

Numba compiles a tactic that looks at each pair of people. `compiled` decorates the function that
Python calls, `inner` those that only compiled functions call. They get arrays of the crowd:

- ``deciding.inside.crowd.records``, a `CrowdState` with a record for everybody who has ever been in
  the model: ``x``, ``y`` (metres), ``vx``, ``vy`` (m/s), ``heading`` (radians), ``start``, ``end``
  (frames), ``preferred`` (m/s), ``route`` (metres);
- ``deciding.inside.grid``, a `Grid`: its arrays have the rows of the people in each cell, and
  `cells_within` gives the cells within some metres of a place. In a building, people on stairs are
  there twice, the second time in the row of a copy on the other sheet;
- ``sight_on(plan, clearance)``, the walls for `unwalled`, which tells whether one point sees
  another.

`by_shares` calls a compiled function for shares of the people, in several threads if there are
many.

``behaviors/steering`` has examples.
"""

from __future__ import annotations

import numpy as np
from shapely import box

from mesa_mobility.compiled.decorators import entry_point as compiled
from mesa_mobility.compiled.decorators import internal as inner
from mesa_mobility.compiled.decorators import kept
from mesa_mobility.compiled.threads import by_shares
from mesa_mobility.crowd.options.table import FRAME_SECONDS, LONGEST_MOVEMENT_S
from mesa_mobility.crowd.state.people_grid import Grid, cells_within
from mesa_mobility.crowd.state.records import NO_OPTION, Crowd, CrowdState
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.floorplan import Exit, FloorPlan
from mesa_mobility.floorplan.walls.line_of_sight import unwalled
from mesa_mobility.floorplan.walls.sight import Sight, sight_on

__all__ = [
    "FRAME_SECONDS",
    "LONGEST_MOVEMENT_S",
    "NO_OPTION",
    "Crowd",
    "CrowdState",
    "CrowdView",
    "Grid",
    "Sight",
    "by_shares",
    "cells_within",
    "compiled",
    "inner",
    "kept",
    "nobody",
    "sight_on",
    "unwalled",
]


def nobody() -> tuple[CrowdView, FloorPlan]:
    """A crowd without people and a small floor plan, for `Tactic.compile_ahead`."""
    plan = FloorPlan(box(0.0, 0.0, 1.0, 1.0), exits=[Exit("door", (0.0, 0.0), (0.0, 1.0))])
    return CrowdView(np.empty(0, dtype=np.int64), Crowd(2)), plan
