"""Meshes of floors, walls and prisms, each in one colour."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

FLOOR, WALL = "#e6e6e2", "#b9bab8"

WALL_HEIGHT = 1.2
"""Metres: low enough to look over."""

SQUARE = np.array([[0, 1, 2], [0, 2, 3]])
"""Triangles of a rectangle."""

Mesh = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int64]]
"""Vertices (v, 3), normals (v, 3) and triangles (t, 3)."""


class Surface(NamedTuple):
    """A mesh in one colour.

    Attributes:
        name: of the mesh.
        vertices: (v, 3) metres, z up.
        normals: (v, 3) at the vertices.
        triangles: (t, 3) vertices of each triangle.
        colour: as hexadecimal digits.
        both_sides: whether the mesh is seen from behind, too.
        opacity: 1 unless one sees through the mesh.
    """

    name: str
    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    triangles: NDArray[np.int64]
    colour: str
    both_sides: bool
    opacity: float = 1.0


def upright(walls: NDArray[np.float64], bottom: float, top: float) -> Mesh:
    """(m, 4) walls as upright rectangles between two elevations, metres."""
    corners = np.full((len(walls), 4, 3), bottom)
    corners[:, [0, 3], :2] = walls[:, None, :2]
    corners[:, [1, 2], :2] = walls[:, None, 2:]
    corners[:, 2:, 2] = top
    along = walls[:, 2:] - walls[:, :2]
    length = np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    normal = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(walls))]) / length
    triangles = (4 * np.arange(len(walls))[:, None, None] + SQUARE).reshape(-1, 3)
    return (
        corners.reshape(-1, 3).astype(np.float32),
        np.repeat(normal, 4, axis=0).astype(np.float32),
        triangles,
    )


def flat(area: shapely.Geometry, height: float) -> Mesh:
    """A level area at an elevation, metres, cut into convex pieces between the x of its corners."""
    x = np.unique(np.round(shapely.get_coordinates(area)[:, 0], 6))
    _, low, _, high = area.bounds
    cuts = shapely.box(x[:-1], low - 1.0, x[1:], high + 1.0)
    pieces = shapely.get_parts(shapely.intersection(area, cuts))
    return joined(
        _lid(np.array(each.exterior.coords), height)
        for each in pieces
        if isinstance(each, shapely.Polygon) and not each.is_empty
    )


def _lid(ring: NDArray[np.float64], height: float) -> Mesh:
    """A convex, closed (k + 1, 2) ring as a level face that is seen from above."""
    corners = ring[:-1, :2] if shapely.is_ccw(shapely.LinearRing(ring)) else ring[:0:-1, :2]
    count = len(corners)
    vertices = np.column_stack([corners, np.full(count, height)]).astype(np.float32)
    normals = np.tile(np.array([0.0, 0.0, 1.0], dtype=np.float32), (count, 1))
    fan = np.arange(1, count - 1)
    return vertices, normals, np.column_stack([np.zeros_like(fan), fan, fan + 1])


def prism(ring: NDArray[np.float64], bottom: float, high: float) -> Mesh:
    """An upright prism over a convex, closed (k + 1, 2) ring, open below."""
    sides = upright(np.column_stack([ring[:-1, :2], ring[1:, :2]]), bottom, bottom + high)
    return joined([_lid(ring, bottom + high), sides])


def post(middle: NDArray[np.float64], thick: float, bottom: float, top: float) -> Mesh:
    """An upright post with a square section of a thickness about a (2,) place, open below."""
    square = 0.5 * thick * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])
    return prism(middle + square, bottom, top - bottom)


def bar(start: NDArray[np.float64], end: NDArray[np.float64], thick: float) -> Mesh:
    """A bar between two (3,) places, the ends of the middle line of its upper side.

    It is not upright. Its section is a square of a thickness.
    """
    along = end - start
    aside = 0.5 * thick * np.array([along[1], -along[0], 0.0]) / np.hypot(along[0], along[1])
    upper = np.array([start + aside, end + aside, end - aside, start - aside])
    lower = upper - [0.0, 0.0, thick]
    sides = [[lower[k], lower[k - 3], upper[k - 3], upper[k]] for k in range(4)]
    corners = np.array([upper, lower[::-1], *sides])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    triangles = (4 * np.arange(len(corners))[:, None, None] + SQUARE).reshape(-1, 3)
    return (
        corners.reshape(-1, 3).astype(np.float32),
        np.repeat(normals, 4, axis=0).astype(np.float32),
        triangles,
    )


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh of several."""
    vertices, normals, triangles = zip(*meshes, strict=True)
    starts = np.cumsum([0, *(len(each) for each in vertices[:-1])])
    moved = [part + start for part, start in zip(triangles, starts, strict=True)]
    return np.concatenate(vertices), np.concatenate(normals), np.concatenate(moved)


def groups(meshes: Iterable[Mesh], most: int | None) -> Iterator[list[Mesh]]:
    """Meshes, together as many as have no more vertices than that."""
    group: list[Mesh] = []
    for mesh in meshes:
        if group and most is not None and sum(len(each[0]) for each in [*group, mesh]) > most:
            yield group
            group = []
        group.append(mesh)
    if group:
        yield group
