"""Exits that were drawn as areas or as lines near the edge of the floor."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.openings import Exit
from mesa_mobility.floorplan.formats.assembling.edges import Edge, all_edges

NEAR = 1.2
"""Metres from the edge within which what was drawn is put on it."""

DEEPEST = 1.5
"""Metres from the edge to the far side of an area that is put on it; deeper ones are cut out."""

LEAST_SIDE = 0.2
"""Metres; shorter sides of an area that is cut out are no exits."""


class WayOut(NamedTuple):
    """A place at which people leave: an area or a line, with its name."""

    name: str
    shape: BaseGeometry


def placed(
    walkable: Polygon, obstacles: Sequence[Polygon], ways: Sequence[WayOut], notes: list[str]
) -> tuple[Polygon, list[Exit]]:
    """The exits of a floor, and the floor without the areas that people leave by.

    A line, or an area of little depth, within 1.2 m of a straight edge becomes the stretch of the
    edge beside it. Any other area is cut out of the floor; people leave when they reach it.

    Args:
        walkable: the floor.
        obstacles: on it.
        ways: by which people leave.
        notes: takes what was moved, cut out and left out.
    """
    edges = all_edges(walkable)
    exits: list[Exit] = []
    for way in ways:
        free = walkable.difference(shapely.union_all(list(obstacles)))
        found, moved = _snapped(way, edges, free)
        if found:
            if moved > 0.01:
                notes.append(f"exit {way.name!r} was moved to the edge, by {moved:.2f} m")
        elif way.shape.area > 0 and way.shape.intersects(walkable):
            walkable, found = _cut_out(way, walkable, obstacles)
            edges = all_edges(walkable)
            if found:
                notes.append(
                    f"exit {way.name!r} is an area of {way.shape.area:.2f} m²: people leave when "
                    "they reach it"
                )
        if not found:
            away = walkable.boundary.distance(way.shape)
            notes.append(
                f"left out exit {way.name!r}: it is {away:.2f} m from the edge of the floor, or no "
                "floor is before it"
            )
        several = len(found) > 1
        for number, edge in enumerate(found, start=1):
            name = f"{way.name} side {number}" if several else way.name
            exits.append(_exit(name, edge))
    return walkable, _apart(exits, notes)


def _exit(name: str, edge: Edge) -> Exit:
    return Exit(name, tuple(edge.a.tolist()), tuple(edge.b.tolist()))


def _snapped(way: WayOut, edges: Sequence[Edge], free: BaseGeometry) -> tuple[list[Edge], float]:
    """The stretch of the edge beside a line or a shallow area, and how far it was moved."""
    xy = shapely.get_coordinates(way.shape)
    best: tuple[float, float, Edge] | None = None
    for edge in edges:
        depth = (xy - edge.a) @ edge.inwards
        if depth.max() > DEEPEST or depth.max() < -NEAR:
            continue
        t = (xy - edge.a) @ edge.along
        first, last = max(float(t.min()), 0.0), min(float(t.max()), edge.length)
        if last - first < max(LEAST_SIDE, 0.5 * np.ptp(t)) or np.ptp(t) < np.ptp(depth) / 2:
            continue
        gap = max(float(depth.min()), -float(depth.max()), 0.0)
        if gap > NEAR:
            continue
        rank = last - first - gap
        if best is None or rank > best[0]:
            best = (rank, gap, edge.between(first, last))
    if best is None:
        return [], 0.0
    parts = best[2].open_parts(free)
    return ([max(parts, key=lambda each: each.length)] if parts else []), best[1]


def _cut_out(
    way: WayOut, walkable: Polygon, obstacles: Sequence[Polygon]
) -> tuple[Polygon, list[Edge]]:
    """The floor without an area, and the sides by which people reach this."""
    area = shapely.union_all([way.shape])
    left = [
        part for part in shapely.get_parts(walkable.difference(area)) if part.geom_type == "Polygon"
    ]
    if not left:
        return walkable, []
    rest = max(left, key=lambda each: each.area)
    free = rest.difference(shapely.union_all(list(obstacles)))
    border = area.boundary.buffer(1e-6)
    sides = [
        edge for edge in all_edges(rest) if border.covers(shapely.LineString([edge.a, edge.b]))
    ]
    # Sides that go on as a straight wall are found by their part on the border.
    for edge in all_edges(rest):
        line = shapely.LineString([edge.a, edge.b])
        if not border.covers(line):
            shared = shapely.line_merge(line.intersection(border))
            for part in shapely.get_parts(shared):
                t = np.sort((shapely.get_coordinates(part) - edge.a) @ edge.along)
                if len(t) > 1 and t[-1] - t[0] >= LEAST_SIDE:
                    sides.append(edge.between(float(t[0]), float(t[-1])))
    found = [part for side in sides for part in side.open_parts(free)]
    return (rest, found) if found else (walkable, [])


def _apart(exits: list[Exit], notes: list[str]) -> list[Exit]:
    """Exits of which none overlaps an earlier one."""
    kept: list[Exit] = []
    for each in exits:
        band = each.line.buffer(0.02)
        if any(band.intersection(other.line).length > 0.05 for other in kept):
            notes.append(f"left out exit {each.name!r}: it overlaps another one")
        else:
            kept.append(each)
    return kept
