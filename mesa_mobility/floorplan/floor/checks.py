"""Checks of floor plans. Each raises FloorPlanError with a message of one line."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates
from mesa_mobility.floorplan.floor.openings import Exit, Gate, Opening

EDGE_TOLERANCE = 0.01
"""Metres by which an exit may lie off the edge of the walkable area, and a gate outside it."""

STANDING_ROOM = 0.1
"""A piece of free area with no point this far from its edge (metres) can hold nobody."""

_CONTACT = 0.1

_WKT_TYPE = re.compile(r"\s*([A-Za-z]+?)(?:ZM|Z|M)?\b")
_WKT_TYPES = (
    "POINT",
    "LINESTRING",
    "LINEARRING",
    "POLYGON",
    "MULTIPOINT",
    "MULTILINESTRING",
    "MULTIPOLYGON",
)


@contextmanager
def one_line(what: str) -> Iterator[None]:
    """Turn an error of the geometry library into a FloorPlanError about `what`."""
    try:
        yield
    except shapely.errors.GEOSException as error:
        text = " ".join(str(error).split())[:100]
        raise FloorPlanError(f"{what}: expected lines that can be put in order, {text}") from None


def read_polygon(value: Polygon | str, what: str) -> Polygon:
    """`value` (shapely polygon or WKT) as a valid, finite, non-empty 2D polygon.

    Error messages call the polygon `what`.

    Raises:
        FloorPlanError: `value` is no such polygon.
    """
    geometry = read_wkt(value, what, "POLYGON") if isinstance(value, str) else value
    if not isinstance(geometry, BaseGeometry):
        raise FloorPlanError(
            f"{what} must be a shapely Polygon or its WKT, found {type(value).__name__}"
        )
    if geometry.geom_type == "MultiPolygon":
        raise FloorPlanError(
            f"{what} must be one connected polygon, found {len(geometry.geoms)} pieces"
        )
    if geometry.geom_type != "Polygon":
        raise FloorPlanError(f"{what} must be a Polygon, found a {geometry.geom_type}")
    if geometry.is_empty:
        raise FloorPlanError(f"{what} is empty")
    check_coordinates(shapely.get_coordinates(geometry), what)
    geometry = shapely.force_2d(geometry)
    if not geometry.is_valid:
        raise FloorPlanError(f"{what} is not valid: {shapely.is_valid_reason(geometry)}")
    if geometry.area == 0.0:
        raise FloorPlanError(f"{what} has no area")
    return geometry


def read_area(value: BaseGeometry | str, what: str) -> BaseGeometry:
    """`value` (shapely or WKT) as one or several valid, finite, non-empty 2D polygons.

    Error messages call the area `what`.

    Raises:
        FloorPlanError: `value` is no such area.
    """
    area: object = read_wkt(value, what, "POLYGON") if isinstance(value, str) else value
    if getattr(area, "geom_type", "") != "MultiPolygon":
        return read_polygon(area, what)
    assert isinstance(area, BaseGeometry)
    return shapely.MultiPolygon([read_polygon(part, what) for part in shapely.get_parts(area)])


def read_wkt(text: str, what: str, expected: str) -> BaseGeometry:
    """Read a geometry from WKT, without checking it further.

    Error messages call the geometry `what`, and name `expected` as its possible types.

    Raises:
        FloorPlanError: the text cannot be read.
    """
    # GEOS reads nested shapes recursively, and ends the process where they nest too deeply.
    word = _WKT_TYPE.match(text)
    if word is None or word[1].upper() not in _WKT_TYPES:
        begin = ascii(text.strip()[:20])
        raise FloorPlanError(f"{what}: the WKT cannot be read ({begin}, expected {expected})")
    try:
        # Coordinates that are not finite are an error here, and need no warning of shapely's.
        with np.errstate(invalid="ignore", over="ignore"):
            return shapely.from_wkt(text)
    except (shapely.errors.GEOSException, NotImplementedError) as error:
        reason = " ".join(str(error).split())[:100]
        raise FloorPlanError(f"{what}: the WKT cannot be read ({reason})") from None


def check_names(openings: Sequence[Opening]) -> None:
    """Raise FloorPlanError if two gates or exits have the same name: names open and close them."""
    seen: set[str] = set()
    for opening in openings:
        if opening.name in seen:
            raise FloorPlanError(f"{opening.kind} name {opening.name!r} is used twice")
        seen.add(opening.name)


def check_exits(walkable: Polygon, exits: Sequence[Exit], gates: Sequence[Gate]) -> None:
    """Raise FloorPlanError unless exits lie on the edge of the walkable area, and none overlap.

    There must be an exit or a gate. Exits may lie up to ``EDGE_TOLERANCE`` off the edge.
    """
    if not exits and not gates:
        raise FloorPlanError("the floor plan has no exit, and no gate that people could go to")
    edge = walkable.boundary
    near_edge = edge.buffer(EDGE_TOLERANCE)
    shapely.prepare(near_edge)
    for opening in exits:
        if not isinstance(opening, Exit):
            raise FloorPlanError(f"exits must be Exit objects, found {type(opening).__name__}")
        if not near_edge.covers(opening.line):
            away = max(
                edge.distance(shapely.Point(p)) for p in (opening.a, opening.midpoint, opening.b)
            )
            raise FloorPlanError(
                f"exit {opening.name!r} is not on the edge of the walkable area: "
                f"it is up to {away:.3f} m away, at most {EDGE_TOLERANCE} m is accepted"
            )
    lines = np.array([opening.line for opening in exits], dtype=object)
    bands = shapely.buffer(lines, EDGE_TOLERANCE, cap_style="flat")
    later, earlier = shapely.STRtree(bands).query(lines, predicate="intersects")
    for i, k in sorted(zip(later.tolist(), earlier.tolist(), strict=True)):
        if k < i and lines[i].intersection(bands[k]).length > 1.5 * EDGE_TOLERANCE:
            raise FloorPlanError(f"exits {exits[k].name!r} and {exits[i].name!r} overlap")


def check_gates(walkable: Polygon, gates: Iterable[Gate]) -> None:
    """Raise FloorPlanError unless all ``gates`` are ``Gate`` objects inside the walkable area.

    A gate may lie up to ``EDGE_TOLERANCE`` outside.
    """
    room = walkable.buffer(EDGE_TOLERANCE)
    for gate in gates:
        if not isinstance(gate, Gate):
            raise FloorPlanError(f"gates must be Gate objects, found {type(gate).__name__}")
        if not room.covers(gate.line):
            outside = gate.line.difference(room).length
            raise FloorPlanError(
                f"gate {gate.name!r} is not inside the walkable area: "
                f"{outside:.2f} m of it lie outside"
            )


def free_area(
    walkable: Polygon,
    obstacles: Sequence[Polygon],
    exits: Sequence[Exit],
    gates: Sequence[Gate],
    cut_off: bool,
) -> list[Polygon]:
    """Pieces of the walkable area minus obstacles, without pockets that can hold nobody.

    Raises:
        FloorPlanError: nothing is left, or, unless pieces may be `cut_off`, a piece that is left
            touches no exit; in a plan without exits, no gate.
    """
    free = walkable.difference(shapely.union_all(list(obstacles)))
    pieces = [
        piece
        for piece in shapely.get_parts(free)
        if piece.geom_type == "Polygon" and _holds_somebody(piece)
    ]
    if not pieces:
        raise FloorPlanError("the obstacles leave no walkable area")
    for piece in [] if cut_off else pieces:
        if exits:
            connected = _touches_any(piece, exits)
        else:
            connected = any(piece.intersects(gate.line) for gate in gates)
        if not connected:
            spot = piece.representative_point()
            raise FloorPlanError(
                f"a piece of {piece.area:.2f} m² around ({spot.x:.2f}, {spot.y:.2f}) "
                f"is disconnected from every {'exit' if exits else 'gate'}"
            )
    return pieces


def _holds_somebody(piece: Polygon) -> bool:
    """Whether some point is ``STANDING_ROOM`` from the edge."""
    # Most often this one is, and areas with thousands of corners take long to shrink.
    if piece.boundary.distance(piece.representative_point()) > STANDING_ROOM:
        return True
    return not piece.buffer(-STANDING_ROOM).is_empty


def _touches_any(piece: Polygon, exits: Sequence[Exit]) -> bool:
    near_edge = piece.boundary.buffer(2 * EDGE_TOLERANCE)
    return any(
        near_edge.intersection(opening.line).length >= min(_CONTACT, opening.length / 2)
        for opening in exits
    )
