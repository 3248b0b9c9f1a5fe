"""Floor and walls of a plan as meshes, and the colours of a scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan

COLOURS = ("#3f6ea8", "#b65a43", "#5b8f5a", "#8c6bb1", "#c59a3d", "#4f9d9d", "#7d7d7d", "#a8577e")
"""Of the people, in turn."""

FLOOR, WALL = "#e6e6e2", "#8b8b88"

WALL_HEIGHT = 1.2
"""Metres: low enough to look over."""

MARGIN = 0.5
"""Metres by which the floor reaches beyond the walls."""

_SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


class Surface(NamedTuple):
    """A mesh in one colour.

    Attributes:
        name: of the mesh.
        vertices: (v, 3) metres, z up.
        normals: (v, 3) at the vertices.
        triangles: (t, 3) vertices of each triangle.
        colour: as hexadecimal digits.
        both_sides: whether the mesh is seen from behind, too.
    """

    name: str
    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    triangles: NDArray[np.int64]
    colour: str
    both_sides: bool


def surfaces(plan: FloorPlan, most_vertices: int | None = None) -> Iterator[Surface]:
    """The floor, and the walls as upright rectangles.

    Args:
        plan: floor and walls.
        most_vertices: of a mesh of walls, which are divided among as many meshes as that takes; all
            of them are in one mesh if None.
    """
    x0, y0, x1, y1 = plan.bounds
    x0, y0, x1, y1 = x0 - MARGIN, y0 - MARGIN, x1 + MARGIN, y1 + MARGIN
    floor = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], dtype=np.float32)
    up = np.tile(np.array([0, 0, 1], dtype=np.float32), (4, 1))
    yield Surface("floor", floor, up, _SQUARE, FLOOR, False)
    walls = np.asarray(plan.walls, dtype=np.float64)
    at_once = len(walls) if most_vertices is None else most_vertices // 4
    for start in range(0, len(walls), at_once):
        yield Surface("walls", *_upright(walls[start : start + at_once]), WALL, True)


def _upright(
    walls: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int64]]:
    """Vertices, normals and triangles of (m, 4) walls as upright rectangles."""
    corners = np.zeros((len(walls), 4, 3))
    corners[:, [0, 3], :2] = walls[:, None, :2]
    corners[:, [1, 2], :2] = walls[:, None, 2:]
    corners[:, 2:, 2] = WALL_HEIGHT
    along = walls[:, 2:] - walls[:, :2]
    length = np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    normal = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(walls))]) / length
    triangles = (4 * np.arange(len(walls))[:, None, None] + _SQUARE).reshape(-1, 3)
    return (
        corners.reshape(-1, 3).astype(np.float32),
        np.repeat(normal, 4, axis=0).astype(np.float32),
        triangles,
    )


def linear(colour: str) -> list[float]:
    """Red, green and blue without gamma, as renderers take them, of hexadecimal digits."""
    channels = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    values = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return [round(value, 5) for value in values]
