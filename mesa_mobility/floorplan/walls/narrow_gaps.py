"""Gaps that are too narrow for a body."""

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.walls.boundaries import opening_segments, rings, turns

if TYPE_CHECKING:
    from mesa_mobility.floorplan.plan import FloorPlan


def narrow_gaps(plan: "FloorPlan", width: float) -> NDArray[np.float64]:
    """(k, 4) segments across every gap of the free area that is narrower than `width` metres.

    A gap is narrowest between a reflex vertex of the free area, or a loose end of a wall, and the
    nearest point of another wall.
    """
    ends = opening_segments([*plan.open_exits(), *plan.closed_gates()]).reshape(-1, 2)
    vertices = [ring[turns(ring) < 0] for ring in rings(plan.free)]
    bases = np.unique(np.concatenate([ends, *vertices]), axis=0)
    found = [np.empty((0, 4))]
    for base in shapely.points(bases):
        across = shapely.shortest_line(base, walls_near(plan, base, width))
        across = across[shapely.length(across) > 0]
        # A line that only runs along or inside walls spans no gap.
        middles = shapely.line_interpolate_point(across, 0.5, normalized=True)
        open_floor = shapely.contains_properly(plan.free, middles)
        found.append(shapely.get_coordinates(across[open_floor]).reshape(-1, 4))
    return np.concatenate(found)


def walls_near(plan: "FloorPlan", place: BaseGeometry, reach: float) -> NDArray[np.object_]:
    """The walls less than `reach` metres from a place, as shapely lines."""
    xmin, ymin, xmax, ymax = place.bounds
    index = plan.wall_index
    rows = index.segments[index.near(xmin - reach, ymin - reach, xmax + reach, ymax + reach)]
    lines = shapely.linestrings(rows.reshape(-1, 2, 2))
    return lines[shapely.distance(lines, place) < reach]
