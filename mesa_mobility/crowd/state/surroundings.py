"""Walls and exits for compiled functions, with a grid of the walls near each place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.wall_index import cell_table
from mesa_mobility.floorplan.routing.targets import Destination

CELL_SIZE = 1.0


class Surroundings(NamedTuple):
    """Walls and exits, with a grid of nearby walls.

    Attributes:
        segments: (w, 4) x1, y1, x2, y2 of the walls, metres.
        x0: least x of the grid, metres.
        y0: least y of the grid, metres.
        nx: number of cells along x.
        ny: number of cells along y.
        size: side of a cell, metres.
        offsets: (nx * ny + 1,) the walls near cell i are ``indices[offsets[i]:offsets[i + 1]]``.
        indices: rows of ``segments``.
        exits: (e, 4) x1, y1, x2, y2 of the exits, metres.
        leads_out: (destinations, e) whether people of a destination may leave there.
        steps: (s, 4) x1, y1, x2, y2 of the edges of stairs and escalators, metres.
        climbs: (destinations,) whether people of a destination use them.
        most_walls: how many walls there are for somebody who may neither leave nor climb.
    """

    segments: NDArray[np.float64]
    x0: float
    y0: float
    nx: int
    ny: int
    size: float
    offsets: NDArray[np.int64]
    indices: NDArray[np.int32]
    exits: NDArray[np.float64]
    leads_out: NDArray[np.bool_]
    steps: NDArray[np.float64]
    climbs: NDArray[np.bool_]
    most_walls: int


def survey(
    plan: FloorPlan,
    destinations: Sequence[Destination],
    climbs: Sequence[bool],
    reach: float,
    shut: frozenset[str] = frozenset(),
) -> Surroundings:
    """Walls and exits of a floor plan as they are now.

    Args:
        plan: the floor plan.
        destinations: exits, gate or point of each number of a destination.
        climbs: whether each distinct body, which has numbers of its own, uses stairs.
        reach: how far from a person walls matter, metres.
        shut: names of gates and exits that are walls, though they are open.
    """
    gates = [each for each in plan.open_gates() if each.name in shut]
    walls = np.concatenate([plan.walls, opening_segments(gates)]) if gates else plan.walls
    cells = cell_table(walls, CELL_SIZE, reach)
    exits = plan.exits
    passable = {each.name for each in plan.open_exits()} - shut
    leads_out = np.array(
        [
            [exit_.name in passable and (names is None or exit_.name in names) for exit_ in exits]
            for names in destinations
        ],
        dtype=np.bool_,
    )
    return Surroundings(
        segments=np.ascontiguousarray(walls),
        x0=cells.x0,
        y0=cells.y0,
        nx=cells.nx,
        ny=cells.ny,
        size=cells.cell_size,
        offsets=cells.offsets,
        indices=cells.indices,
        exits=np.array([[*e.a, *e.b] for e in exits], dtype=np.float64).reshape(-1, 4),
        # A set of exits has one number for each body.
        leads_out=leads_out.reshape(len(destinations), len(exits)).repeat(len(climbs), axis=0),
        steps=plan.steps,
        climbs=np.tile(np.array(climbs, dtype=np.bool_), len(destinations)),
        most_walls=len(walls) + len(exits) + len(plan.steps),
    )
