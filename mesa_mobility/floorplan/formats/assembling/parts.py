"""One walkable area from areas that were drawn apart."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates

GAP = 0.05
"""Metres between parts that count as touching."""

NARROWEST = 0.3
"""Metres along which parts must touch: nobody passes where it is less."""

TIE = 0.005
"""Metres to either side of a line that makes one polygon of two pieces."""

MOST_NOTES = 5
"""Parts that are named one by one; of more, only their number is said."""

MOST_AREAS, MOST_POINTS = 50_000, 1_000_000
"""Limits of what is put together."""


class Area(NamedTuple):
    """An area of a file, and what it is called in messages."""

    polygon: Polygon
    what: str


def polygons_of(geometry: BaseGeometry, what: str, notes: list[str]) -> list[Area]:
    """The polygons in a geometry, mended where their outlines cross themselves.

    Raises:
        FloorPlanError: coordinates that are not finite or too large.
    """
    check_coordinates(shapely.get_coordinates(geometry), what)
    found: list[Area] = []
    for flat in _single(shapely.force_2d(geometry)):
        if flat.geom_type != "Polygon":
            continue
        if not flat.is_valid:
            notes.append(f"{what} was mended: {shapely.is_valid_reason(flat)}")
            flat = shapely.make_valid(flat)
        found += [Area(part, what) for part in _polygons(flat) if part.area > 0]
    return found


def joined(areas: Sequence[Area], where: str, notes: list[str]) -> Polygon:
    """The union of areas that touch, within 5 cm. The largest such union counts.

    Args:
        areas: parts of the floor.
        where: name of the source in an error message.
        notes: takes what was joined and what is left out, with its place and gap.

    Raises:
        FloorPlanError: no areas, or too many.
    """
    if not areas:
        raise FloorPlanError(f"{where}: has no area to walk on, expected a polygon")
    count = sum(shapely.get_num_coordinates(each.polygon) for each in areas)
    if len(areas) > MOST_AREAS or count > MOST_POINTS:
        raise FloorPlanError(
            f"{where}: {len(areas):,} areas of {count:,} points, expected at most "
            f"{MOST_AREAS:,} of {MOST_POINTS:,}"
        )
    union = bridged(shapely.union_all([each.polygon for each in areas]))
    pieces = sorted(_polygons(union), key=lambda each: -each.area)
    main = pieces[0]
    inside = [each for each in areas if main.intersects(each.polygon.representative_point())]
    if len(inside) > 1:
        notes.append(f"{len(inside)} areas that touch are joined to one floor")
    for piece in pieces[1 : MOST_NOTES + 1]:
        spot = piece.representative_point()
        own = [each.what for each in areas if piece.intersects(each.polygon)]
        notes.append(
            f"left out {own[0] if own else 'a part'}: {piece.area:.2f} m² around "
            f"({spot.x:.2f}, {spot.y:.2f}), {main.distance(piece):.2f} m from the rest of the floor"
        )
    if len(pieces) > MOST_NOTES + 1:
        notes.append(f"left out {len(pieces) - MOST_NOTES - 1} further parts of the floor")
    return main


def bridged(union: BaseGeometry) -> BaseGeometry:
    """A union whose parts are joined where the gap between them is at most ``GAP``."""
    parts = _polygons(union)
    if len(parts) < 2:
        return union
    half = GAP / 2 + 1e-6
    closed = union.buffer(half, join_style="mitre").buffer(-half, join_style="mitre")
    tree = shapely.STRtree(parts)
    links = []
    for gap in _polygons(shapely.difference(closed, union)):
        wider = gap.buffer(2e-6, join_style="mitre")
        # A slit within one part is a wall.
        touched = tree.query(wider, predicate="intersects")
        if len(touched) > 1 and gap.length / 2 >= NARROWEST:
            links.append(wider)
    return shapely.union_all([union, *links]) if links else union


def tied(pieces: Sequence[Polygon], avoid: Sequence[BaseGeometry]) -> tuple[Polygon, list[Polygon]]:
    """One polygon of several pieces, and obstacles where nobody passes from one to the other.

    Args:
        pieces: at least one.
        avoid: areas in which pieces are not tied, if they have edges elsewhere.
    """
    around = shapely.union_all(list(avoid))
    largest, *rest = sorted(pieces, key=lambda each: -each.area)
    whole: BaseGeometry = largest
    obstacles: list[Polygon] = []
    while rest:
        away = [whole.distance(each) for each in rest]
        piece = rest.pop(int(np.argmin(away)))
        edges = [each.boundary.difference(around) for each in (whole, piece)]
        if any(each.is_empty for each in edges):
            edges = [whole.boundary, piece.boundary]
        a, b = shapely.get_coordinates(shapely.shortest_line(*edges))
        along = (b - a) / max(float(np.hypot(*(b - a))), 1e-9)
        tie = shapely.LineString([a - TIE * along, b + TIE * along])
        obstacles.append(tie.buffer(TIE, cap_style="square"))
        whole = shapely.union_all([whole, piece, tie.buffer(TIE / 2, cap_style="flat")])
    return max(_polygons(whole), key=lambda each: each.area), obstacles


def reachable(
    walkable: Polygon, obstacles: Sequence[Polygon], doors: Sequence[BaseGeometry]
) -> tuple[BaseGeometry, list[Polygon]]:
    """The free floor from which doors are reached, and the pieces from which none is.

    Without doors, the largest piece is the one that is reached.
    """
    pieces = _polygons(walkable.difference(shapely.union_all(list(obstacles))))
    if not pieces:
        return Polygon(), []
    if doors:
        lines = shapely.union_all(list(doors)).buffer(0.02)
        near = [bool(piece.intersection(lines).area > 0.004) for piece in pieces]
    else:
        largest = int(np.argmax(shapely.area(pieces)))
        near = [k == largest for k in range(len(pieces))]
    kept = [piece for piece, is_near in zip(pieces, near, strict=True) if is_near]
    left = [piece for piece, is_near in zip(pieces, near, strict=True) if not is_near]
    return shapely.union_all(kept), left


def _single(geometry: BaseGeometry) -> Iterable[BaseGeometry]:
    """The geometries of a collection, nested ones included."""
    for part in shapely.get_parts(geometry):
        if part.geom_type.startswith("Multi") or part.geom_type == "GeometryCollection":
            yield from _single(part)
        else:
            yield part


def _polygons(geometry: BaseGeometry) -> list[Polygon]:
    return [part for part in _single(geometry) if isinstance(part, Polygon) and not part.is_empty]
