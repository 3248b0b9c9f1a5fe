"""Individual densities: one person on the floor of its own Voronoi cell."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Voronoi
from shapely.geometry.base import BaseGeometry

FloatArray = NDArray[np.float64]


def individual_densities(
    points: FloatArray, floor: BaseGeometry, of: NDArray[np.bool_] | None = None
) -> FloatArray:
    """Density that each person stands in: 1 / area of its Voronoi cell on the floor.

    Cells end at the walls; of a cell that walls cut to pieces the piece with the person counts.
    (Steffen and Seyfried 2010, Physica A 389:1902, with PedPy's cut at the walls.)

    Args:
        points: (n, 2) metres, on the floor, all different.
        floor: walkable area.
        of: (n,) whose density is asked for; by default everybody's.

    Returns:
        (k,) persons per square metre, of those asked for.
    """
    asked = np.arange(len(points)) if of is None else np.flatnonzero(of)
    if len(asked) == 0:
        return np.empty(0)
    x0, y0, x1, y1 = floor.bounds
    middle, far = np.array([(x0 + x1) / 2, (y0 + y1) / 2]), 10.0 * max(x1 - x0, y1 - y0, 1.0)
    # With four people far outside, every cell of those inside is bounded.
    outside = middle + far * np.array([[-1, 0], [1, 0], [0, -1], [0, 1]])
    diagram = Voronoi(np.concatenate([points, outside]))
    regions = [diagram.regions[diagram.point_region[k]] for k in asked]
    corners = np.concatenate([diagram.vertices[region] for region in regions])
    ring = np.repeat(np.arange(len(asked)), [len(region) for region in regions])
    cells = shapely.polygons(shapely.linearrings(_closed(corners, ring), indices=_closed_of(ring)))
    shapely.prepare(floor)
    inside = shapely.contains_properly(floor, cells)
    areas = shapely.area(cells)
    for k in np.flatnonzero(~inside):
        pieces = shapely.get_parts(shapely.intersection(cells[k], floor))
        here = shapely.points(points[asked[k]])
        areas[k] = shapely.area(pieces[np.argmin(shapely.distance(pieces, here))])
    return 1.0 / areas


def _closed(corners: FloatArray, ring: NDArray[np.int64]) -> FloatArray:
    """Corners of all rings with each ring's first one again at its end."""
    last = np.append(np.flatnonzero(np.diff(ring)), len(ring) - 1)
    first = np.append(0, last[:-1] + 1)
    return np.insert(corners, last + 1, corners[first], axis=0)


def _closed_of(ring: NDArray[np.int64]) -> NDArray[np.int64]:
    last = np.append(np.flatnonzero(np.diff(ring)), len(ring) - 1)
    return np.insert(ring, last + 1, ring[last])
