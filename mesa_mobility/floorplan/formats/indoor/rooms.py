"""The floors of an indoor map: rooms with walls between them and doors through these."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely import LineString, Point
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import Area, polygons_of
from mesa_mobility.floorplan.formats.assembling.projection import as_metres
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.indoor.joining import links_of
from mesa_mobility.floorplan.formats.indoor.shapes import (
    DOORWAY,
    LIFT,
    OBSTACLE,
    PASSAGE,
    ROOM,
    STAIRS,
    Shape,
    shapes_of,
)
from mesa_mobility.floorplan.formats.storeys import Link, Storey, Storeys, numbered

HALF_WALL = 0.05
"""Metres by which rooms with doors are smaller than drawn, so that a wall is between them."""

REACH = 0.3
"""Metres from a door within which a room has it."""

LARGEST_DEGREES = 0.2
"""Extent of coordinates of longitude and latitude; what is wider has metres."""

HEIGHT = 3.0
"""Metres from one level to the next."""

MOST_LEVELS = 300
"""Levels of a file."""


def read_rooms(
    features: Sequence[object], where: str, height: float = HEIGHT, name: str = ""
) -> Content | Storeys:
    """The floors of an indoor map.

    Rooms without doors are joined where they touch. Where there are doors, walls are between rooms,
    and doors lead through them; doors of one room alone are exits, but not on levels other than 0
    that stairs or lifts leave, unless they are marked as such.

    Args:
        features: of GeoJSON.
        where: name of the file in messages.
        height: metres from one level to the next.
        name: of the building.

    Raises:
        FloorPlanError: no room, or a geometry that cannot be read.
    """
    notes: list[str] = []
    shapes, geodetic = shapes_of(features, where, notes)
    moved = _in_metres(shapes, geodetic, notes)
    shapes = [replace(s, geometry=g) for s, g in zip(shapes, moved, strict=True)]
    floors = (ROOM, PASSAGE, STAIRS)
    names = {level for each in shapes if each.kind in floors for level in each.levels}
    levels = sorted(names, key=_height)
    if len(levels) < 2:
        content = _floor(shapes, where, lambda door: True)
        content.name = content.name or name
        content.notes = [*notes, *content.notes]
        return content
    if len(levels) > MOST_LEVELS:
        raise FloorPlanError(f"{where}: {len(levels)} levels, expected at most {MOST_LEVELS}")
    numbers = _numbers(levels)
    links = links_of(shapes, dict(zip(levels, numbers, strict=True)), height, notes)
    if links:
        notes.append(f"levels are taken to be {height:g} m apart; --set height says more")
    joined = {number for each in links for number in each.levels}
    storeys = []
    for level, number in zip(levels, numbers, strict=True):
        own = [each for each in shapes if not each.levels or level in each.levels]
        inner = number != 0 and number in joined

        def is_exit(door: Shape, inner: bool = inner) -> bool:
            return door.way_out or not inner

        title = "" if level == str(number) else level
        lifts = [each for each in links if each.kind == "lift" and number in each.levels]
        content = _floor(own, f"{where}: level {level}", is_exit, lifts)
        storeys.append(Storey(number, title, number * height, content))
    return Storeys(storeys, links, name, notes)


def _numbers(levels: Sequence[str]) -> list[int]:
    """Their own numbers, if all are whole; otherwise those of their order."""
    heights = [_height(each)[0] for each in levels]
    if all(abs(each) <= 1000 and each == int(each) for each in heights):
        return [int(each) for each in heights]
    return numbered(heights)


def _height(level: str) -> tuple[float, str]:
    """A level's number, by which it is sorted; names that are none come last."""
    try:
        height = float(level)
    except ValueError:
        return 1e9, level
    return (height if np.isfinite(height) else 1e9), level


def _floor(
    shapes: Sequence[Shape],
    where: str,
    is_exit: Callable[[Shape], bool],
    lifts: Sequence[Link] = (),
) -> Content:
    """The floor of one level, which reaches the doors of lifts."""
    drawn = Drawn()
    by_kind = {
        kind: [each for each in shapes if each.kind == kind]
        for kind in (ROOM, PASSAGE, STAIRS, DOORWAY, OBSTACLE, LIFT)
    }
    for number, shape in enumerate(by_kind[OBSTACLE]):
        areas = polygons_of(shape.geometry, f"obstacle {number}", drawn.notes)
        drawn.obstacles += [each.polygon for each in areas]
    rooms = [*by_kind[ROOM], *by_kind[STAIRS]]
    areas = [
        each
        for shape in (*rooms, *by_kind[PASSAGE])
        for each in polygons_of(shape.geometry, shape.name or shape.kind, drawn.notes)
    ]
    named = [*rooms, *by_kind[PASSAGE]]
    if any(each.name for each in named):
        drawn.rooms = [
            Area(part.polygon, shape.name or shape.kind)
            for shape in named
            for part in polygons_of(shape.geometry, "", [])
        ]
    if not by_kind[DOORWAY]:
        drawn.areas = areas
        return assembled(drawn, where)
    halls = [p.polygon for each in by_kind[PASSAGE] for p in polygons_of(each.geometry, "", [])]
    own = [each for shape in rooms for each in polygons_of(shape.geometry, shape.name, [])]
    own += [
        Area(part, "passage") for part in shapely.get_parts(shapely.union_all(halls)) if part.area
    ]
    drawn.areas = _with_walls(own)
    drawn.areas += [
        Area(LineString(each.line).buffer(HALF_WALL + 0.02, cap_style="flat"), each.name)
        for each in lifts
    ]
    shafts = shapely.union_all([each.geometry for each in by_kind[LIFT]])
    doors = [
        each
        for each in by_kind[DOORWAY]
        if shafts.is_empty or shafts.distance(each.geometry) > REACH
    ]
    _add_doors(drawn, doors, own, is_exit)
    return assembled(drawn, where)


def _with_walls(areas: Sequence[Area]) -> list[Area]:
    return [
        Area(part, what)
        for polygon, what in areas
        for part in shapely.get_parts(polygon.buffer(-HALF_WALL, join_style="mitre"))
        if part.area > 0
    ]


def _add_doors(
    drawn: Drawn, doors: Sequence[Shape], rooms: Sequence[Area], is_exit: Callable[[Shape], bool]
) -> None:
    """Links between rooms, and exits where a door has one room only."""
    polygons = [each.polygon for each in rooms]
    tree = shapely.STRtree(polygons)
    astray = 0
    inner = 0
    for number, shape in enumerate(doors, start=1):
        geometry = shape.geometry
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
        elif not is_exit(shape):
            inner += 1
        else:
            name = shape.name or "exit"
            taken = [each.name for each in drawn.ways_out]
            drawn.ways_out.append(WayOut(f"{name} {number}" if name in taken else name, line))
    if inner:
        drawn.notes.append(
            f"{inner} doors are no exits: they lead out of a level that stairs or lifts leave"
        )
    if astray:
        drawn.notes.append(f"left out {astray} doors that are in no wall of a room")


def _across(spot: Point, edge: BaseGeometry, width: float) -> LineString:
    """A door at a place: a line along the wall there."""
    edge = min(shapely.get_parts(edge), key=lambda each: each.distance(spot))
    edge = shapely.remove_repeated_points(edge)
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
