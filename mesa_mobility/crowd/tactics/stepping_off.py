"""People step off the line of a door that has closed on them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2
from mesa_mobility.schema import Kind

CLEAR = 1.0
"""Metres by which somebody aims beyond what is needed: a wheelchair does not set off for less. They
stop once they are clear."""

TOUCHING = 1e-3
"""Metres by which a body may be across a line, from the rounding of places."""


@entry_point()
def step_off(
    rows: NDArray[np.int64],
    lines: NDArray[np.float64],
    state: CrowdState,
    points: NDArray[np.float64],
    across: NDArray[np.bool_],
) -> None:
    """Set the points of those whose body is across a closed line.

    They go at right angles to it, to the side on which their middle is.

    Args:
        rows: (n,) people who decide.
        lines: (m, 4) gates and exits that are closed, metres.
        state: the crowd.
        points: (n, 2) to which they go, metres; written to.
        across: (n,) set to whether each steps off; False before.
    """
    for k in range(len(rows)):
        i, worst = rows[k], TOUCHING
        x, y = state[i].x, state[i].y
        for w in range(len(lines)):
            ax, ay, bx, by = lines[w]
            nx, ny = ay - by, bx - ax
            length = math.hypot(nx, ny)
            aside = ((x - ax) * nx + (y - ay) * ny) / length
            deep = state[i].core - math.sqrt(point_segment_distance2(x, y, ax, ay, bx, by))
            if deep > worst:
                worst, across[k] = deep, True
                far = math.copysign(deep + CLEAR, aside) / length
                points[k, 0], points[k, 1] = x + far * nx, y + far * ny


class StepOff(Tactic):
    """People step off the line of a gate or exit that has closed on them, whatever else they want.

    A door is no place to stand in, and people whose only way out has closed would stay there.
    """

    name = "stepping_off"

    saved: ClassVar[Mapping[str, Kind]] = {}  # the plan is the model's

    _plan: FloorPlan

    def bind(self, model: World) -> None:
        """Keep the floor plan, whose doors may close."""
        self._plan = model.floor_plan

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those away from the line who are across it."""
        shut = (self._plan.gate(name) for name in sorted(deciding.site.shut))
        closed = (*self._plan.closed_openings(), *shut)
        if desired.newcomers or not closed:
            return
        lines, points = opening_segments(closed), desired.points.copy()
        rows, crowd = deciding.pedestrians, deciding.inside.crowd
        across = np.zeros(len(rows), dtype=np.bool_)
        step_off(rows, lines, crowd.records, points, across)
        if across.any():
            # Those without a route would rather stand.
            steps = points[across] - deciding.positions[across]
            crowd.route[rows[across]] = np.hypot(steps[:, 0], steps[:, 1])
            own = crowd.agenda["speed"][rows]
            desired.points, desired.speeds = points, np.where(across, own, desired.speeds)
