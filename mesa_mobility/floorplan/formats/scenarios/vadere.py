"""Scenarios of Vadere: bounds, obstacles, targets, stairs and people."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import Area, polygons_of
from mesa_mobility.floorplan.formats.assembling.texts import LARGEST_FILE, parsed, read_text
from mesa_mobility.floorplan.formats.assembling.values import (
    list_of,
    mapping_of,
    number_of,
    ring_of,
)
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.people import left_out
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.scenarios.vadere_people import people_of

ON_STAIRS = 0.5
"""Share of people's speed on stairs that are drawn flat."""

_LEFT_OUT = (
    "targetChangers",
    "measurementAreas",
    "aerosolClouds",
    "droplets",
)
"""Parts of a topography that say nothing of the floor."""

MOST = 20_000
"""Obstacles, targets or stairs of a topography."""


class Vadere(PlanFormat):
    """Scenario of Vadere: obstacles, targets by which people leave, sources and people."""

    name = "vadere"
    suffixes = (".scenario",)

    def has_people(self, path: Path) -> bool:
        """All such files do."""
        return True

    def read(self, path: Path) -> Content:
        """Read the topography of a scenario, with its people.

        Raises:
            FloorPlanError: the file cannot be read, or is no such scenario.
        """
        data = parsed(read_text(path, LARGEST_FILE, "JSON of a scenario"), str(path))
        return content_of_scenario(data, str(path))


def content_of_scenario(data: Any, where: str) -> Content:
    """The floor plan of a scenario.

    Args:
        data: the JSON of its file.
        where: name of the file in messages.

    Raises:
        FloorPlanError: it has no topography, or a faulty one.
    """
    whole = mapping_of(data, where)
    scenario = mapping_of(whole.get("scenario", whole), f"{where}: scenario")
    at = f"{where}: topography"
    topography = mapping_of(scenario.get("topography"), at)
    attributes = mapping_of(topography.get("attributes"), f"{at}: attributes")
    if not attributes:
        raise FloorPlanError(f"{where}: has no topography, expected a scenario of Vadere")
    drawn = Drawn(name=str(whole.get("name") or "")[:200])
    drawn.areas.append(Area(_floor(attributes, at), "the bounds"))
    for number, each in _each(topography, "obstacles", at):
        name = f"{at}: obstacle {number}"
        drawn.obstacles += [p.polygon for p in polygons_of(_shape(each, name), name, drawn.notes)]
    targets: dict[int, tuple[BaseGeometry, str, float]] = {}
    for number, each in _each(topography, "targets", at):
        name, way = "", _way_out("target", number, each, at)
        if _absorbs(each, f"{at}: target {number}"):
            drawn.ways_out.append(way)
            name = way.name
        if isinstance(each.get("id"), int):
            targets[each["id"]] = (way.shape, name, _wait(each, f"{at}: target {number}"))
    for number, each in _each(topography, "absorbingAreas", at):
        drawn.ways_out.append(_way_out("absorbing area", number, each, at))
    for number, each in _each(topography, "stairs", at):
        _add_stairs(drawn, each, f"{at}: stairs {number}")
    counts = {kind: len(list_of(topography.get(kind), f"{at}: {kind}")) for kind in _LEFT_OUT}
    drawn.notes += left_out(counts)
    sources = [
        _shape(each, f"{at}: source {number}") for number, each in _each(topography, "sources", at)
    ]
    people = people_of(topography, sources, targets, at, drawn.notes)
    content = assembled(drawn, where)
    content.people = people
    return content


def _wait(target: Mapping[str, Any], at: str) -> float:
    """Seconds for which people wait at a target, on average."""
    waiter = mapping_of(target.get("waiter"), f"{at}: waiter")
    if waiter.get("enabled") is not True:
        return max(number_of(target.get("waitingTime"), f"{at}: waitingTime", 0.0), 0.0)
    own = mapping_of(waiter.get("distribution"), f"{at}: waiter")
    wait = number_of(own.get("waitingTime", own.get("mean")), f"{at}: waiter", 0.0)
    if not wait <= 86_400:
        raise FloorPlanError(f"{at}: waits {wait:g} s, expected 0 to 86,400 s")
    return max(wait, 0.0)


def _floor(attributes: Mapping[str, Any], at: str) -> shapely.Polygon:
    """The bounds without the wall around them."""
    bounds = mapping_of(attributes.get("bounds"), f"{at}: bounds")
    x, y, width, height = (
        number_of(bounds.get(key), f"{at}: bounds: {key}") for key in ("x", "y", "width", "height")
    )
    wall = number_of(attributes.get("boundingBoxWidth"), f"{at}: boundingBoxWidth", 0.0)
    if attributes.get("bounded") is False:
        wall = 0.0
    if not (0 <= 2 * wall < min(width, height)):
        raise FloorPlanError(f"{at}: bounds of {width:g} by {height:g} m leave no floor")
    return shapely.box(x + wall, y + wall, x + width - wall, y + height - wall)


def _each(topography: Mapping[str, Any], kind: str, at: str) -> list[tuple[int, Any]]:
    found = list_of(topography.get(kind), f"{at}: {kind}")
    if len(found) > MOST:
        raise FloorPlanError(f"{at}: {len(found):,} {kind}, expected at most {MOST:,}")
    return [(k, mapping_of(each, f"{at}: {kind} {k}")) for k, each in enumerate(found, start=1)]


def _absorbs(target: Mapping[str, Any], at: str) -> bool:
    """Whether people leave at a target; older files say so in a word of their own."""
    absorber = target.get("absorber")
    if absorber is None:
        return target.get("absorbing", True) is not False
    return mapping_of(absorber, f"{at}: absorber").get("enabled", True) is not False


def _way_out(kind: str, number: int, element: Mapping[str, Any], at: str) -> WayOut:
    name = str(element.get("id", number))[:40]
    return WayOut(f"{kind} {name}", _shape(element, f"{at}: {kind} {number}"))


def _add_stairs(drawn: Drawn, element: Mapping[str, Any], at: str) -> None:
    direction = mapping_of(element.get("upwardDirection"), f"{at}: upwardDirection")
    x, y = (number_of(direction.get(key), f"{at}: upwardDirection", 0.0) for key in ("x", "y"))
    length = math.hypot(x, y)
    downhill = (-x / length, -y / length) if length > 0 else None
    for part in polygons_of(_shape(element, at), at, drawn.notes):
        name = f"stairs {len(drawn.zones) + 1}"
        drawn.zones.append(SpeedZone(part.polygon, factor=ON_STAIRS, name=name, downhill=downhill))
    drawn.notes.append(
        f"stairs {len(drawn.zones)} are a zone in which people walk at {ON_STAIRS} of their speed"
    )


def _shape(element: Mapping[str, Any], at: str) -> BaseGeometry:
    shape = mapping_of(element.get("shape"), f"{at}: shape")
    kind = shape.get("type")
    if kind == "RECTANGLE":
        keys = ("x", "y", "width", "height")
        x, y, width, height = (number_of(shape.get(key), f"{at}: {key}") for key in keys)
        if width <= 0 or height <= 0:
            raise FloorPlanError(f"{at}: {width:g} by {height:g} m, expected more than 0")
        return shapely.box(x, y, x + width, y + height)
    if kind == "CIRCLE":
        centre = mapping_of(shape.get("center"), f"{at}: center")
        x, y = (number_of(centre.get(key), f"{at}: center") for key in ("x", "y"))
        radius = number_of(shape.get("radius"), f"{at}: radius")
        if radius <= 0:
            raise FloorPlanError(f"{at}: radius {radius:g} m, expected more than 0")
        return shapely.Point(x, y).buffer(radius)
    if kind == "POLYGON":
        return ring_of(shape.get("points"), f"{at}: points")
    raise FloorPlanError(f"{at}: shape {kind!r:.40}, expected RECTANGLE, POLYGON or CIRCLE")
