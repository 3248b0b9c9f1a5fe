"""Twins follow those whose copies they are, and count where these are on the strip of a seam."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.planning.grid import place_in
from mesa_mobility.crowd.planning.workspace import FrameContext, Neighbours
from mesa_mobility.crowd.state.paths import waypoint
from mesa_mobility.crowd.state.people_grid import COVERED, Grid, cover_in
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.twins import Twins, near_strip

_FAR = 1e9
"""Where the circle of a twin lies that is in nobody's way, metres."""


@internal()
def follow(i: int, scene: FrameContext) -> None:
    """Let the twins of pedestrian i follow the path that they have just committed to."""
    state, twins = scene.state, scene.twins
    t = twins.follow[i]
    while t >= 0:
        number = twins.strip[t]
        dx, dy = twins.strips[number, 6], twins.strips[number, 7]
        state.option[t], state.cluster[t] = state.option[i], state.cluster[i]
        state.start[t], state.end[t], state.gone[t] = state.start[i], state.end[i], state.gone[i]
        state.spacing[t], state.knots[t] = state.spacing[i], state.knots[i]
        state.from_x[t], state.from_y[t] = state.from_x[i] + dx, state.from_y[i] + dy
        state.from_c[t], state.from_s[t] = state.from_c[i], state.from_s[i]
        state.from_heading[t], state.to_heading[t] = state.from_heading[i], state.to_heading[i]
        state.to_x[t], state.to_y[t] = state.to_x[i] + dx, state.to_y[i] + dy
        state.vx[t], state.vy[t], state.stride[t] = state.vx[i], state.vy[i], state.stride[i]
        state.box[t, 0], state.box[t, 2] = state.box[i, 0] + dx, state.box[i, 2] + dx
        state.box[t, 1], state.box[t, 3] = state.box[i, 1] + dy, state.box[i, 3] + dy
        show(scene.grid, t, i, twins, scene.table, state)
        t = twins.follow[t]


@entry_point()
def show_all(
    rows: NDArray[np.int64], grid: Grid, twins: Twins, table: OptionTable, state: CrowdState
) -> None:
    """Show or hide the twins of all people in ``rows``, in a new grid."""
    for i in rows:
        t = twins.follow[i]
        while t >= 0:
            show(grid, t, i, twins, table, state)
            t = twins.follow[t]


@internal()
def show(grid: Grid, t: int, i: int, twins: Twins, table: OptionTable, state: CrowdState) -> None:
    """Write the circle of twin t of pedestrian i, or hide it if the path is not on the strip."""
    at = place_in(grid, state.x[t], state.y[t], t)
    on = False
    for k in range(state.knots[i]):
        x, y = waypoint(state, table, i, k)
        on = on or near_strip(twins, twins.strip[t], x, y, state.core[i])
    if on:
        cover_in(grid, at, t, state)
    else:
        grid.table[COVERED, at] = grid.table[COVERED + 1, at] = _FAR
        grid.table[COVERED + 2, at] = 0.0


@internal()
def keep_seen(count: int, twins: Twins, to: Neighbours) -> int:
    """Keep those of the first ``count`` neighbours who are where they seem to be.

    Returns how many.
    """
    kept, rows, others = 0, to.rows, to.others
    for a in range(count):
        j = rows[a]
        rows[kept] = j
        for row in range(COVERED):
            others[row, kept] = others[row, a]
        kept += int(twins.here[j])
    return kept
