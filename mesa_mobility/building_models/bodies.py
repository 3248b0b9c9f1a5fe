"""Bodies of elements: their footprints, their heights, and the level faces of stairs."""

from typing import Any

import ifcopenshell.geom
import numpy as np
import shapely

GRID = 1e-4
"""Metres; corners of footprints lie on this grid."""

LEVEL = 0.999
"""The cosine of the slope of a face that counts as level."""


def meshes_of(model: Any, elements: list[Any]) -> dict[int, tuple[Any, Any]]:
    """(n, 3) corners in metres and (m, 3) triangles of each element that has a body, by its id."""
    if not elements:
        return {}
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("disable-opening-subtractions", True)
    iterator = ifcopenshell.geom.iterator(settings, model, 1, include=elements)
    found: dict[int, tuple[Any, Any]] = {}
    if not iterator.initialize():
        return found
    while True:
        shape = iterator.get()
        corners = np.array(shape.geometry.verts, dtype=float).reshape(-1, 3)
        triangles = np.array(shape.geometry.faces, dtype=int).reshape(-1, 3)
        if len(triangles) and np.isfinite(corners).all() and np.abs(corners).max() < 1e8:
            found[shape.id] = (corners, triangles)
        if not iterator.next():
            return found


def footprint(corners: Any, triangles: Any) -> Any:
    """The area that the faces of a body cover in plan."""
    xy = corners[triangles][:, :, :2]
    areas = shapely.polygons(xy)
    areas = areas[shapely.area(areas) > 1e-7]
    whole = shapely.union_all(areas, grid_size=GRID)
    # Slits between triangles that nearly meet are closed.
    return whole.buffer(2 * GRID, join_style="mitre").buffer(-2 * GRID, join_style="mitre")


def treads(corners: Any, triangles: Any) -> list[list[Any]]:
    """Level faces that look up: the height of each and what it covers in plan."""
    spots = corners[triangles]
    normals = np.cross(spots[:, 1] - spots[:, 0], spots[:, 2] - spots[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    level = (sizes > 1e-9) & (normals[:, 2] > LEVEL * sizes)
    heights = np.round(spots[level][:, :, 2].mean(axis=1), 3)
    found = []
    for height in np.unique(heights).tolist():
        own = spots[level][heights == height][:, :, :2]
        area = shapely.union_all(shapely.polygons(own), grid_size=GRID)
        if area.area > 1e-3:
            found.append([height, area.wkb_hex])
    return found


def extent(corners: Any, triangles: Any) -> dict[str, Any]:
    """Footprint and heights of a body."""
    heights = corners[triangles][:, :, 2]
    return {
        "area": footprint(corners, triangles).wkb_hex,
        "bottom": float(heights.min()),
        "top": float(heights.max()),
    }
