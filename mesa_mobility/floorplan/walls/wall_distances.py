"""Distances to the nearest wall."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.geometry import point_segment_distance2
from mesa_mobility.floorplan.walls.sight import Sight, sight_on


@internal()
def wall_distance(sight: Sight, x: float, y: float, at_most: float) -> float:
    """Metres from a point to the nearest wall, `at_most` if none is nearer.

    `at_most` must not exceed the reach that the sight was prepared for.
    """
    walls, solid, table = sight.walls, sight.solid, sight.table
    nearest = at_most
    column = int(np.floor((x - table.x0) / table.cell_size))
    row = int(np.floor((y - table.y0) / table.cell_size))
    if 0 <= column < table.nx and 0 <= row < table.ny:
        at = row * table.nx + column
        for j in range(table.offsets[at], table.offsets[at + 1]):
            wall = table.indices[j]
            if wall < solid:
                ax, ay, bx, by = walls[wall]
                nearest = min(nearest, np.sqrt(point_segment_distance2(x, y, ax, ay, bx, by)))
    return nearest


@kept()
def wall_distances(
    sight: Sight, points: NDArray[np.float64], at_most: float
) -> NDArray[np.float64]:
    """(n,) `wall_distance` of (n, 2) points."""
    distances = np.empty(len(points))
    for i in range(len(points)):
        distances[i] = wall_distance(sight, points[i, 0], points[i, 1], at_most)
    return distances


def distances_to_walls(
    plan: Floor, points: NDArray[np.float64], at_most: float
) -> NDArray[np.float64]:
    """(n,) metres from (n, 2) points to the nearest wall of a plan, `at_most` if none is nearer."""
    return wall_distances(sight_on(plan, at_most), np.ascontiguousarray(points), at_most)
