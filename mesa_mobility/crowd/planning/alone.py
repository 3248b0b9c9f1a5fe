"""The options that people would take if nobody else were there, and who is in the way of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.collision.exact import swept_collision
from mesa_mobility.crowd.options.table import SAMPLES, OptionTable
from mesa_mobility.crowd.state.paths import box_of, waypoint
from mesa_mobility.crowd.state.people_grid import Grid, cells_within
from mesa_mobility.crowd.state.records import FALLBACK, CrowdState
from mesa_mobility.crowd.state.wishes import NOBODY, Wishes


def wishes_of(
    wished: CrowdState,
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    grid: Grid,
    state: CrowdState,
    reach: float,
) -> Wishes:
    """The wishes of people, and who is in the way of each.

    Args:
        wished: (n,) records of these people, who have decided as if they were alone.
        rows: (n,) their rows in the crowd.
        frame: now.
        table: options of all capabilities.
        grid: everybody, by place.
        state: the crowd.
        reach: metres within which people may get in each other's way.
    """
    n = len(rows)
    found = Wishes(np.zeros((n, 2, SAMPLES)), np.zeros(n, np.int64), np.full(n, NOBODY))
    _find_blockers(wished, rows, frame, table, grid, state, reach, found)
    return found


@entry_point()
def _find_blockers(
    wished: CrowdState,
    rows: NDArray[np.int64],
    frame: int,
    table: OptionTable,
    grid: Grid,
    state: CrowdState,
    reach: float,
    found: Wishes,
) -> None:
    """Write the paths of ``wished``, and the person whom each hits first."""
    for k in range(len(rows)):
        if wished[k].option <= FALLBACK:
            continue
        path, pieces = found.paths[k], wished[k].knots - 1
        for p in range(SAMPLES):
            path[0, p], path[1, p] = waypoint(wished, table, k, p)
        found.pieces[k] = pieces
        x0, y0, x1, y1 = box_of(path, pieces)
        cx0, cx1, cy0, cy1 = cells_within(grid, path[0, 0], path[1, 0], reach)
        first, nearest = pieces + 1, np.inf
        for cy in range(cy0, cy1 + 1):
            if cx0 > cx1:
                break
            for a in range(grid.offsets[cy * grid.nx + cx0], grid.offsets[cy * grid.nx + cx1 + 1]):
                j = grid.people[a]
                apart = wished[k].core + state[j].core
                box, c = state[j].box, apart + 0.001
                if (
                    j == rows[k]
                    or x0 > box[2] + c
                    or x1 < box[0] - c
                    or y0 > box[3] + c
                    or y1 < box[1] - c
                ):
                    continue
                away = np.hypot(grid.x[a] - path[0, 0], grid.y[a] - path[1, 0])
                for pieces_walked in range(1, min(first, pieces) + 1):
                    if swept_collision(
                        path, pieces_walked, wished[k].spacing, frame, -1, table, state, j, apart
                    ):
                        if pieces_walked < first or away < nearest:
                            first, nearest = pieces_walked, away
                            found.blockers[k] = j
                        break
