"""The floor plan of what somebody has drawn, and its sources and counters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import shapely
from shapely import LineString, Polygon

from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import FloorPlan, Gate
from mesa_mobility.floorplan.floor.checks import read_polygon
from mesa_mobility.floorplan.floor.extent import check_coordinates
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled, completed
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import polygons_of
from mesa_mobility.floorplan.formats.content import content_of
from mesa_mobility.floorplan.formats.geojson import feature_of
from mesa_mobility.floorplan.formats.sources import COUNTER, SOURCE
from mesa_mobility.plugins.output import numbers_in

FLOOR, WALL, OBSTACLE, DOOR, EXIT = "floor", "wall", "obstacle", "door", "exit"

AREAS = (FLOOR, OBSTACLE, SOURCE, COUNTER)

KINDS = (*AREAS, WALL, DOOR, EXIT)
"""Kinds of shapes: areas, and lines of walls, doors and exits."""

NUMBERS = {SOURCE: ("number", "seconds"), COUNTER: ("stay", "capacity")}
"""Properties of sources and counters, as in the features of a plan."""

THICK = 0.2
"""Metres; thickness of walls."""

MOST_SHAPES, MOST_POINTS, LONGEST_NAME = 5_000, 200, 80


class Drawing(NamedTuple):
    """The floor plan of a drawing, features of its sources and counters, and what was changed or
    left out, a line each."""

    plan: FloorPlan
    people: list[dict[str, Any]]
    notes: list[str]

    def to_geojson(self) -> dict[str, Any]:
        """The FeatureCollection of the drawing."""
        whole = self.plan.to_geojson()
        return whole | {"features": [*whole["features"], *self.people]}


def drawing_of(shapes: Any, name: Any) -> Drawing:
    """A drawing as a floor plan.

    Floors that touch are joined. Doors are openings through the walls that they are drawn on. Exits
    up to 1.2 m off the edge are moved to it.

    Args:
        shapes: a list of objects with ``kind``, ``points`` [[x, y], ...] in metres and ``name``,
            those of sources and counters with ``NUMBERS``.
        name: of the plan.

    Raises:
        FloorPlanError: no such list, no floor plan, or numbers that sources do not take.
    """
    if not isinstance(shapes, list) or len(shapes) > MOST_SHAPES:
        raise FloorPlanError(f"drawing: expected at most {MOST_SHAPES:,} shapes")
    drawn = Drawn(name=str(name)[:LONGEST_NAME])
    walls: list[Polygon] = []
    openings: list[Polygon] = []
    taken: set[str] = set()
    people: list[dict[str, Any]] = []
    for number, shape in enumerate(shapes, start=1):
        kind, points, given = _read(shape, f"shape {number}")
        if kind in (FLOOR, OBSTACLE):
            areas = polygons_of(Polygon(points), f"{kind} {number}", drawn.notes)
            if kind == FLOOR:
                drawn.areas += areas
            else:
                drawn.obstacles += [each.polygon for each in areas]
        elif kind in NUMBERS:
            area = read_polygon(Polygon(points), f"{kind} {number}")
            feature = feature_of(kind, _unused(given, kind, taken), area)
            numbers = {each: shape.get(each) for each in NUMBERS[kind]}
            feature["properties"] |= {each: value for each, value in numbers.items() if value}
            people.append(feature)
        elif kind == WALL:
            walls.append(LineString(points).buffer(THICK / 2, cap_style="square"))
        else:
            called = _unused(given, kind, taken)
            if kind == EXIT:
                drawn.ways_out.append(WayOut(called, LineString(points)))
                continue
            a, b = (tuple(each) for each in points.tolist())
            drawn.gates.append(Gate(called, a, b))
            openings.append(drawn.gates[-1].line.buffer(THICK, cap_style="flat"))
    solid = shapely.union_all(walls).difference(shapely.union_all(openings))
    drawn.obstacles += [part for part in shapely.get_parts(solid) if part.area > 0.0]
    content = completed(assembled(drawn, "drawing"), None)
    plan = FloorPlan(
        content.walkable,
        exits=content.exits,
        gates=content.gates,
        obstacles=content.obstacles,
        name=content.name,
    )
    drawing = Drawing(plan, people, content.notes)
    if people:
        _check_people(drawing)
    return drawing


def _check_people(drawing: Drawing) -> None:
    """Raise FloorPlanError unless sources and counters are on the floor, with numbers they take."""
    features = drawing.to_geojson()["features"]
    content_of(((each, "drawing") for each in features), "drawing")
    free = shapely.union_all([drawing.plan.free])
    for each in drawing.people:
        if not shapely.geometry.shape(each["geometry"]).intersection(free).area > 0.0:
            raise FloorPlanError(f"drawing: {each['properties']['name']} has no floor in it")
    if not any(each["properties"]["kind"] == SOURCE for each in drawing.people):
        drawing.notes.append("nobody goes to the counters: there is no source")


def _read(shape: Any, where: str) -> tuple[str, Any, str]:
    """Kind, (n, 2) points and name of a shape."""
    if not isinstance(shape, Mapping) or shape.get("kind") not in KINDS:
        raise FloorPlanError(f"{where}: expected one of {', '.join(KINDS)}")
    kind, name = shape["kind"], shape.get("name") or ""
    try:
        points = numbers_in(where, shape.get("points"), "points [[x, y], ...]")
    except ModelError as error:
        raise FloorPlanError(str(error)) from None
    least, most = (3, MOST_POINTS) if kind in AREAS else (2, 2)
    if points.ndim != 2 or points.shape[1] != 2 or not least <= len(points) <= most:
        raise FloorPlanError(f"{where}: a {kind} has {least} to {most} points (x, y)")
    check_coordinates(points, where)
    if kind not in AREAS and not np.hypot(*(points[1] - points[0])) > 0.0:
        raise FloorPlanError(f"{where}: a {kind} has two different ends")
    return kind, points, str(name)[:LONGEST_NAME]


def _unused(name: str, kind: str, taken: set[str]) -> str:
    """A name that no other opening, source or counter has."""
    number, found = 1, name or f"{kind} 1"
    while found in taken:
        number += 1
        found = f"{name or kind} {number}"
    taken.add(found)
    return found
