"""Rooms of other programs' GeoJSON: areas alone, IMDF, and OpenStreetMap indoor."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import Area, polygons_of
from mesa_mobility.floorplan.formats.assembling.projection import as_metres
from mesa_mobility.floorplan.formats.content import Content

HALF_WALL = 0.05
"""Metres by which rooms with doors are smaller than drawn, so that a wall is between them."""

DOOR = 0.9
"""Metres; width of a door that does not say its own."""

REACH = 0.3
"""Metres from a door within which a room has it."""

LARGEST_DEGREES = 0.2
"""Extent of coordinates of longitude and latitude; what is wider has metres."""

MOST = 50_000
"""Features of a file."""

ROOM, PASSAGE, OBSTACLE, DOORWAY = "room", "passage", "obstacle", "door"

_INDOOR = {"room": ROOM, "corridor": PASSAGE, "area": PASSAGE, "column": OBSTACLE}
_OPEN = ("walkway", "concourse", "lobby", "foodservice.court", "ramp")
_VOID = ("opentobelow", "void", "elevator", "escalator", "stairs", "movingwalkway")
_WORDS = re.compile(r"\b(exit|ausgang|entrance|door)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Shape:
    """A feature: what it is, its name, its levels and its geometry."""

    kind: str
    name: str
    levels: tuple[str, ...]
    geometry: BaseGeometry
    width: float = DOOR


def read_rooms(features: Sequence[Any], level: str | None, where: str) -> Content:
    """The floor of one level.

    Rooms without doors are joined where they touch. Where there are doors, walls are between rooms,
    and doors lead through them; doors of one room alone are exits.

    Args:
        features: of GeoJSON.
        level: which level to read; by default 0, or the lowest.
        where: name of the file in messages.

    Raises:
        FloorPlanError: no room, no such level, or a geometry that cannot be read.
    """
    if len(features) > MOST:
        raise FloorPlanError(f"{where}: {len(features):,} features, expected at most {MOST:,}")
    drawn, geodetic = Drawn(), False
    ordinals = _ordinals(features)
    shapes: list[Shape] = []
    others = 0
    for number, feature in enumerate(features):
        shape, is_geodetic = _shape(feature, ordinals, f"{where}: feature {number}")
        geodetic |= is_geodetic
        if shape is None:
            others += 1
        else:
            shapes.append(shape)
    if others:
        drawn.notes.append(f"left out {others} features that are no rooms, doors or obstacles")
    shapes = _on_level(shapes, level, where, drawn.notes)
    moved = _in_metres(shapes, geodetic, drawn.notes)
    passages = [(s, g) for s, g in zip(shapes, moved, strict=True) if s.kind == PASSAGE]
    rooms = [(s, g) for s, g in zip(shapes, moved, strict=True) if s.kind == ROOM]
    doors = [(s, g) for s, g in zip(shapes, moved, strict=True) if s.kind == DOORWAY]
    for number, (shape, geometry) in enumerate(zip(shapes, moved, strict=True)):
        if shape.kind == OBSTACLE:
            areas = polygons_of(geometry, f"obstacle {number}", drawn.notes)
            drawn.obstacles += [each.polygon for each in areas]
    areas = [
        each
        for shape, geometry in (*rooms, *passages)
        for each in polygons_of(geometry, shape.name or shape.kind, drawn.notes)
    ]
    if not doors:
        drawn.areas = areas
        return assembled(drawn, where)
    hall = shapely.union_all(
        [polygon for s, g in passages for polygon, _ in polygons_of(g, "", [])]
    )
    own = [each for s, g in rooms for each in polygons_of(g, s.name or s.kind, [])]
    own += [Area(part, "passage") for part in shapely.get_parts(hall) if part.area > 0]
    drawn.areas = _with_walls(own)
    _add_doors(drawn, doors, own)
    return assembled(drawn, where)


def _with_walls(areas: Sequence[Area]) -> list[Area]:
    return [
        Area(part, what)
        for polygon, what in areas
        for part in shapely.get_parts(polygon.buffer(-HALF_WALL, join_style="mitre"))
        if part.area > 0
    ]


def _add_doors(
    drawn: Drawn, doors: Sequence[tuple[Shape, BaseGeometry]], rooms: Sequence[Area]
) -> None:
    """Links between rooms, and exits where a door has one room only."""
    polygons = [each.polygon for each in rooms]
    tree = shapely.STRtree(polygons)
    astray = 0
    for number, (shape, geometry) in enumerate(doors, start=1):
        spot = geometry.centroid
        near = tree.query(spot, predicate="dwithin", distance=REACH)
        if not len(near):
            astray += 1
            continue
        edge = polygons[int(near[0])].boundary
        line = geometry if geometry.length > 0 else _across(spot, edge, shape.width)
        if len(near) > 1:
            link = line.buffer(2 * HALF_WALL + REACH / 2, cap_style="flat")
            inside = shapely.union_all([polygons[k] for k in near.tolist()]).buffer(2 * HALF_WALL)
            for part in shapely.get_parts(link.intersection(inside)):
                drawn.areas.append(Area(part, f"door {number}"))
        else:
            name = shape.name or "exit"
            taken = [each.name for each in drawn.ways_out]
            drawn.ways_out.append(WayOut(f"{name} {number}" if name in taken else name, line))
    if astray:
        drawn.notes.append(f"left out {astray} doors that are in no wall of a room")


def _across(spot: Point, edge: BaseGeometry, width: float) -> LineString:
    """A door at a place: a line along the wall there."""
    at = edge.project(spot) if edge.geom_type == "LineString" else 0.0
    if edge.geom_type != "LineString":
        edge = min(shapely.get_parts(edge), key=lambda each: each.distance(spot))
        at = edge.project(spot)
    corners = shapely.get_coordinates(edge)
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    k = int(np.clip(np.searchsorted(reached, at) - 1, 0, len(corners) - 2))
    along = corners[k + 1] - corners[k]
    along = along / np.hypot(*along) * width / 2
    middle = np.array([spot.x, spot.y])
    return LineString([middle - along, middle + along])


def _in_metres(shapes: Sequence[Shape], geodetic: bool, notes: list[str]) -> Sequence[BaseGeometry]:
    whole = shapely.GeometryCollection([each.geometry for each in shapes])
    if not geodetic and not whole.is_empty:
        west, south, east, north = whole.bounds
        small = max(east - west, north - south) < LARGEST_DEGREES
        geodetic = small and max(abs(west), abs(east)) <= 180 and max(abs(south), abs(north)) <= 90
    # Geometries are collections of their own where they have several parts.
    wrapped = shapely.GeometryCollection(
        [shapely.GeometryCollection([each.geometry]) for each in shapes]
    )
    return [shapely.get_parts(each)[0] for each in as_metres(wrapped, geodetic, notes)]


def _on_level(shapes: list[Shape], level: str | None, where: str, notes: list[str]) -> list[Shape]:
    """What is on one level, or on none in particular."""
    names = {each for shape in shapes if shape.kind != DOORWAY for each in shape.levels}
    levels = sorted(names, key=_height)
    if level is not None and level not in levels:
        raise FloorPlanError(
            f"{where}: has no level {level!r:.40}, expected one of {', '.join(levels) or 'none'}"
        )
    if len(levels) > 1 or level is not None:
        chosen = level or ("0" if "0" in levels else levels[0])
        notes.append(
            f"level {chosen} of {', '.join(levels)}; --set level={levels[-1]} reads another"
        )
        return [each for each in shapes if not each.levels or chosen in each.levels]
    return shapes


def _height(level: str) -> tuple[float, str]:
    try:
        return float(level), level
    except ValueError:
        return 1e9, level


def _ordinals(features: Sequence[Any]) -> dict[str, str]:
    """Number of each level of IMDF by its id."""
    found = {}
    for feature in features:
        if isinstance(feature, Mapping) and feature.get("feature_type") == "level":
            properties = feature.get("properties")
            ordinal = properties.get("ordinal") if isinstance(properties, Mapping) else None
            found[str(feature.get("id"))[:80]] = str(0 if ordinal is None else ordinal)[:20]
    return found


def _shape(feature: Any, ordinals: Mapping[str, str], at: str) -> tuple[Shape | None, bool]:
    """What a feature is, if it matters, and whether its coordinates are degrees for sure."""
    if not isinstance(feature, Mapping):
        raise FloorPlanError(f"{at}: expected a Feature, found {type(feature).__name__}")
    given = feature.get("properties")
    properties = given if isinstance(given, Mapping) else {}
    tags = properties.get("tags")
    tags = tags if isinstance(tags, Mapping) else properties
    imdf = feature.get("feature_type")
    geometry = _geometry(feature.get("geometry"), at)
    if geometry is None:
        return None, False
    name = str(tags.get("name") or "")[:80] if not isinstance(tags.get("name"), Mapping) else ""
    if isinstance(imdf, str):
        category = str(properties.get("category") or "")
        key = str(properties.get("level_id"))[:80]
        levels: tuple[str, ...] = (ordinals.get(key, key),) if properties.get("level_id") else ()
        kind = {"opening": DOORWAY, "fixture": OBSTACLE, "kiosk": OBSTACLE}.get(imdf, "")
        if imdf == "unit" and category not in _VOID:
            kind = PASSAGE if category in _OPEN else ROOM
            kind = OBSTACLE if category in ("column", "structure", "brick", "concrete") else kind
        return (Shape(kind, name, levels, geometry) if kind else None), True
    levels = _levels(tags.get("level"))
    indoor = tags.get("indoor")
    if "door" in tags or "entrance" in tags or indoor == "door":
        if tags.get("door") == "no":
            return None, True
        width = _width(tags.get("door:width") or tags.get("width"))
        return Shape(DOORWAY, name, levels, geometry.centroid, width), True
    if isinstance(indoor, str) and geometry.area > 0:
        kind = _INDOOR.get(indoor, "")
        kind = PASSAGE if indoor == "yes" and "room" not in tags else kind
        return (Shape(kind, name, levels, geometry) if kind else None), True
    if geometry.area > 0:
        said = " ".join(str(each) for each in tags.values() if isinstance(each, str))[:400]
        kind = OBSTACLE if re.search(r"obstacle|column|pillar", said, re.IGNORECASE) else ROOM
        return Shape(kind, name, levels, geometry), False
    said = " ".join(str(each) for each in tags.values() if isinstance(each, str))[:400]
    if _WORDS.search(said) and geometry.geom_type in ("LineString", "Point"):
        return Shape(DOORWAY, name, levels, geometry), False
    return None, False


def _geometry(value: Any, at: str) -> BaseGeometry | None:
    if value is None:
        return None
    try:
        with np.errstate(invalid="ignore"):  # coordinates that are no numbers are refused below
            geometry = shapely.force_2d(shapely.geometry.shape(value))
    except Exception as error:  # shapely raises whatever the malformed mapping led it into
        text = " ".join(str(error).split())[:100]
        raise FloorPlanError(f"{at}: the geometry cannot be read ({text})") from None
    try:
        check_coordinates(shapely.get_coordinates(geometry), "it")
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None
    return None if geometry.is_empty else geometry


def _levels(value: Any) -> tuple[str, ...]:
    """Levels that a text such as 0, 0;1 or 0-2 names."""
    if value is None or isinstance(value, list | Mapping):
        return ()
    found: list[str] = []
    for part in str(value)[:200].split(";"):
        between = re.fullmatch(r"\s*(-?\d{1,3})\s*-\s*(-?\d{1,3})\s*", part)
        if between and int(between[1]) <= int(between[2]):
            found += [str(each) for each in range(int(between[1]), int(between[2]) + 1)]
        elif part.strip():
            found.append(re.sub(r"\.0+$", "", part.strip())[:20])
    return tuple(found)


def _width(value: Any) -> float:
    try:
        width = float(str(value)[:20].removesuffix("m"))
    except ValueError:
        return DOOR
    return width if 0.3 <= width <= 20 else DOOR
