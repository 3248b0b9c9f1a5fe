"""Solids on a floor: walls and obstacles, cut at a height, and rows of seats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from shapely.geometry.polygon import orient

from mesa_mobility.animation.meshes import (
    WALL,
    WALL_HEIGHT,
    Mesh,
    Surface,
    flat,
    groups,
    joined,
    upright,
)

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan

WALL_TOP, SEAT = "#5d6066", "#7d5a55"

THICK = 0.15
"""Metres by which walls reach off the floor."""

SEAT_DEPTHS, SEAT_WIDTH, LEAST_ROWS = (0.3, 0.6), 0.55, 3
"""Depths of obstacles that are seats, their least length, and of how many parallel rows."""

_CUSHION, _BACK, _BACK_THICK, _GAP = 0.44, 0.86, 0.08, 0.05
"""Heights of a seat and its back, the thickness of the back, the gap between two backs, metres."""


@dataclass(frozen=True)
class Solid:
    """An upright prism.

    Attributes:
        kind: "wall" or "seat".
        area: its outline with holes, metres.
        top: its height above the floor, metres.
    """

    kind: str
    area: shapely.Polygon
    top: float


def solids_of(plan: FloorPlan) -> list[Solid]:
    """Solids on the floor of a plan."""
    exits = [each.line for each in plan.exits if plan.is_open(each.name)]
    return solids(shapely.union_all(shapely.get_parts(plan.walkable)), plan.free, exits)


def solids(
    area: shapely.Geometry, free: shapely.Geometry, ways_out: Sequence[shapely.LineString]
) -> list[Solid]:
    """Walls round an area, and what stands in it.

    Args:
        area: the floor with its obstacles.
        free: the floor without them.
        ways_out: lines through which one leaves it.
    """
    around = shapely.difference(area.buffer(THICK, join_style="mitre", mitre_limit=2.0), area)
    gaps = [line.buffer(1.1 * THICK, cap_style="flat") for line in ways_out]
    around = shapely.difference(around, shapely.union_all(gaps))
    obstacles = _polygons(shapely.difference(area, free))
    rows = _rows_of_seats(obstacles)
    walls = [each for each in obstacles if id(each) not in {id(row) for row in rows}]
    whole = shapely.union_all([around, *walls], grid_size=0.001)
    found = [Solid("wall", each, WALL_HEIGHT) for each in _polygons(whole)]
    return [*found, *_seats(rows, area)]


def drawn_solid(solid: Solid) -> dict[str, Any]:
    """A solid as JSON takes it: rings, metres, the outer one first; it lies to their left."""
    area = orient(solid.area)
    rings = (area.exterior, *area.interiors)
    points = [np.round(shapely.get_coordinates(each), 3).tolist() for each in rings]
    return {"kind": solid.kind, "rings": points, "top": solid.top}


def solid_surfaces(
    label: str, found: Iterable[Solid], base: float, most_vertices: int | None
) -> Iterator[Surface]:
    """Meshes of solids: sides and tops of walls, and seats.

    Args:
        label: end of the meshes' names, or "".
        found: the solids.
        base: elevation of the floor, metres.
        most_vertices: of a mesh; all of a kind are in one mesh if None.
    """
    parts: dict[tuple[str, str], list[Mesh]] = {}
    for solid in found:
        sides = ("walls", WALL) if solid.kind == "wall" else ("seats", SEAT)
        tops = ("wall_tops", WALL_TOP) if solid.kind == "wall" else sides
        for ring in (solid.area.exterior, *solid.area.interiors):
            corners = shapely.get_coordinates(ring)
            edges = np.column_stack([corners[:-1], corners[1:]])
            parts.setdefault(sides, []).append(upright(edges, base, base + solid.top))
        parts.setdefault(tops, []).append(flat(solid.area, base + solid.top))
    for (name, colour), meshes in parts.items():
        for group in groups(meshes, most_vertices):
            yield Surface(f"{name}{label}", *joined(group), colour, True)


def _polygons(area: shapely.Geometry) -> list[shapely.Polygon]:
    parts = shapely.get_parts(area)
    return [each for each in parts if isinstance(each, shapely.Polygon) and each.area > 1e-4]


def _rows_of_seats(obstacles: Sequence[shapely.Polygon]) -> list[shapely.Polygon]:
    """Obstacles that are as deep as seats, of which there are several alike."""
    like: dict[tuple[int, int], list[shapely.Polygon]] = {}
    for each in obstacles:
        long, deep, angle = _sides(each)
        if not SEAT_DEPTHS[0] <= deep <= SEAT_DEPTHS[1] or long < SEAT_WIDTH:
            continue
        if each.area > 0.98 * long * deep:
            like.setdefault((round(deep / 0.05), round(angle / 0.05)), []).append(each)
    return [each for rows in like.values() if len(rows) >= LEAST_ROWS for each in rows]


def _sides(polygon: shapely.Polygon) -> tuple[float, float, float]:
    """Length and depth of the least rectangle round it, and its direction, 0 to pi."""
    corners = shapely.get_coordinates(polygon.minimum_rotated_rectangle)
    edges = np.diff(corners[:3], axis=0)
    lengths = np.hypot(*edges.T)
    along = edges[np.argmax(lengths)]
    angle = float(np.arctan2(along[1], along[0]) % np.pi)
    return float(lengths.max()), float(lengths.min()), angle if angle < np.pi - 0.02 else 0.0


def _seats(rows: Sequence[shapely.Polygon], area: shapely.Geometry) -> Iterator[Solid]:
    """Seats of rows, which face the side on which the floor has more room."""
    if not rows:
        return
    together = shapely.union_all(list(rows)).bounds
    for row in rows:
        long, deep, angle = _sides(row)
        along = np.array([np.cos(angle), np.sin(angle)])
        behind = np.array([-along[1], along[0]])
        k = int(np.argmax(np.abs(behind)))
        room = together[k] - area.bounds[k], area.bounds[k + 2] - together[k + 2]
        if (room[0] < room[1]) == (behind[k] > 0.0):
            behind = -behind
        middle = np.array([row.centroid.x, row.centroid.y])
        yield Solid("seat", row, _CUSHION)
        count = max(round(long / SEAT_WIDTH), 1)
        for number in range(count):
            at = middle + along * long * ((number + 0.5) / count - 0.5)
            half = along * (long / count - _GAP) / 2
            outer, inner = behind * deep / 2, behind * (deep / 2 - _BACK_THICK)
            corners = [at - half + inner, at + half + inner, at + half + outer, at - half + outer]
            yield Solid("seat", shapely.Polygon(corners), _BACK)
