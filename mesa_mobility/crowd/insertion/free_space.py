"""Places where nobody is or will be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.crowd.collision.exact import swept_collision
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.planning.grid import people_within
from mesa_mobility.crowd.state.people_grid import Grid, build_grid
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.floorplan.poisson_disk import have_room


def too_close(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """Index of the first taken place, and the row of the person who is or will come too near.

    The row is -1 if a place before it is too near.  (-1, -1) if all places are free.  Nobody
    farther than ``search_radius`` can come near a place in time.
    """
    beside = _first_beside(points, 2.0 * core)
    before = points if beside < 0 else points[:beside]
    # Mostly the floor is empty, and the test need not be compiled.
    if len(rows) > 0:
        where, who = _first(True, before, core, frame, rows, table, state, search_radius)
        if where >= 0:
            return where, who
    return beside, -1


def _first_beside(points: NDArray[np.float64], distance: float) -> int:
    """Index of the first place nearer than ``distance`` to one before it, or -1."""
    room = have_room(points, distance)
    return -1 if room.all() else int(np.argmin(room))


def first_free(
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> int:
    """Index of the first free place, or -1; see ``too_close``."""
    return _first(False, points, core, frame, rows, table, state, search_radius)[0]


@kept()
def _first(
    taken: bool,
    points: NDArray[np.float64],
    core: float,
    frame: int,
    rows: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
) -> tuple[int, int]:
    """Index of the first place that is taken, or free if not ``taken``, and the row of the person
    there; -1 for no place and for nobody.
    """
    people = build_grid(rows, state.x, state.y)
    found = np.empty(len(rows), np.int64)
    for k in range(len(points)):
        x, y = points[k]
        j = _comes_near(x, y, core, frame, people, table, state, search_radius, found)
        if (j >= 0) == taken:
            return k, j
    return -1, -1


@kept()
def _comes_near(
    x: float,
    y: float,
    core: float,
    frame: int,
    people: Grid,
    table: OptionTable,
    state: CrowdState,
    search_radius: float,
    found: NDArray[np.int64],
) -> int:
    """Lowest row of a person who is or will be too near to a body at (x, y), or -1."""
    still = np.empty((2, 2))
    still[0], still[1] = x, y
    count = people_within(people, x, y, np.int64(-1), search_radius, found)
    lowest = np.int64(-1)
    for at in found[:count]:
        j = people.people[at]
        if 0 <= lowest < j:
            continue
        c = core + state.core[j]
        dx, dy = x - state.x[j], y - state.y[j]
        if dx * dx + dy * dy < c * c or (
            state.end[j] > frame
            and swept_collision(
                still, np.int64(1), np.int64(1), frame, np.int64(-1), table, state, j, c
            )
        ):
            lowest = j
    return int(lowest)
