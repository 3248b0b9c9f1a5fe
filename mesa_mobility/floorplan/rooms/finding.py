"""Rooms of a floor plan: as given, or found between its doors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import shapely
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Opening
from mesa_mobility.floorplan.floor.room import Room

GAP = 0.05
"""Metres by which a gate may end before the walls beside it."""

TOUCHING = 0.01
"""Metres between an obstacle and a room that it stands in."""

REACH = 0.6
"""Metres from the middle of a door, through its wall, to the room into which it leads."""

HALF_BODY = 0.25
"""Metres; what is narrower than twice as much is no room, but a part of a doorway."""


def rooms_of(plan: Floor) -> tuple[Room, ...]:
    """The rooms of a plan, with their doors; those found between its doors where it has none given.

    A room that is found ends at the lines of its gates, and holds the obstacles that stand in no
    other room. Rooms that are found are called ``room 1``, ``room 2`` and so on, the largest first.
    """
    rooms = plan.given_rooms or _found(plan)
    floor = plan.walkable.buffer(TOUCHING)
    shapely.prepare(floor)
    openings = plan.openings()
    return tuple(replace(each, doors=_doors(each.shape, openings, floor)) for each in rooms)


def floor_between_gates(plan: Floor) -> list[Polygon]:
    """The floor without obstacles, cut at the lines of its gates; gaps in which nobody has room are
    left out."""
    free = plan.walkable.difference(shapely.union_all(list(plan.obstacles.values())))
    lines = [_longer(gate) for gate in plan.gates]
    pieces = _cut(free, lines) if lines else list(shapely.get_parts(free))
    return [each for each in pieces if not each.buffer(-HALF_BODY).is_empty]


def _found(plan: Floor) -> list[Room]:
    obstacles = shapely.union_all(list(plan.obstacles.values()))
    whole = _with_furniture(floor_between_gates(plan), plan.walkable.intersection(obstacles))
    whole.sort(key=lambda each: (-round(each.area, 3), *each.bounds))
    return [Room(f"room {number}", each) for number, each in enumerate(whole, start=1)]


def _cut(free: BaseGeometry, lines: Sequence[LineString]) -> list[Polygon]:
    """The pieces into which lines cut an area."""
    noded = shapely.union_all([free.boundary, *lines])
    faces = shapely.get_parts(shapely.polygonize([noded]))
    shapely.prepare(free)
    inside = shapely.intersects(free, shapely.point_on_surface(faces))
    return list(faces[inside])


def _longer(gate: Opening) -> LineString:
    (ax, ay), (bx, by) = gate.a, gate.b
    dx, dy = GAP * (bx - ax) / gate.length, GAP * (by - ay) / gate.length
    return LineString([(ax - dx, ay - dy), (bx + dx, by + dy)])


def _with_furniture(pieces: Sequence[Polygon], obstacles: BaseGeometry) -> list[Polygon]:
    """The pieces with the obstacles that touch no other piece. The others are walls."""
    tree, own = shapely.STRtree(pieces), [[each] for each in pieces]
    for part in shapely.get_parts(obstacles):
        touched = tree.query(part, predicate="dwithin", distance=TOUCHING)
        if len(touched) == 1 and part.geom_type == "Polygon":
            own[int(touched[0])].append(part)
    unions = [shapely.union_all(each) for each in own]
    return [max(shapely.get_parts(each), key=lambda part: part.area) for each in unions]


def _doors(room: Polygon, openings: Sequence[Opening], floor: BaseGeometry) -> tuple[str, ...]:
    """Names of the openings that lead into a room: nothing is between it and their middle."""
    found = []
    for each in openings:
        way = shapely.shortest_line(shapely.Point(each.midpoint), room)
        if way.length > REACH or not floor.covers(way):
            continue
        if not any(other is not each and way.intersects(other.line) for other in openings):
            found.append(each.name)
    return tuple(found)
