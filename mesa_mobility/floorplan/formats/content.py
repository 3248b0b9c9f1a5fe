"""The parts of a floor plan as files hold them, before they are checked together."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates
from mesa_mobility.floorplan.floor.openings import Exit, Gate, Opening
from mesa_mobility.floorplan.floor.outline import SIMPLIFY
from mesa_mobility.floorplan.floor.room import OF_ROOMS, ROOM, Room
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats import sources
from mesa_mobility.floorplan.formats.people import People

OF_ZONES = [each for each in fields(SpeedZone) if each.name not in ("polygon", "name")]
"""Fields of ``SpeedZone`` that a file gives as properties, besides its name."""

KINDS = ("walkable", "obstacle", "gate", "exit", "zone", ROOM, *sources.KINDS)
"""Values of the property `kind` of a feature."""


@dataclass
class Content:
    """The parts of a floor plan, as a file has them; distances in metres.

    Attributes:
        walkable: the walkable area.
        name: of the plan.
        exits: lines on the edge of the walkable area.
        gates: lines within it.
        obstacles: areas to subtract.
        zones: areas where people walk more slowly.
        rooms: named areas; none if they are to be found between the gates.
        closed: names of the exits and gates that are closed.
        cut_off: whether obstacles may cut pieces off from every exit.
        simplify: metres by which walls may recede.
        notes: what the reader has changed or left out, a line each.
        foreign: whether another program drew it. Floor from which no exit is reached is then left
            out, and named in a note.
        people: those of a scenario, or of sources, whom the model `scenario` puts on the floor.
    """

    walkable: Polygon
    name: str = ""
    exits: list[Exit] = field(default_factory=list)
    gates: list[Gate] = field(default_factory=list)
    obstacles: list[Polygon] = field(default_factory=list)
    zones: list[SpeedZone] = field(default_factory=list)
    rooms: list[Room] = field(default_factory=list)
    closed: list[str] = field(default_factory=list)
    cut_off: bool = False
    simplify: float = SIMPLIFY
    notes: list[str] = field(default_factory=list)
    foreign: bool = False
    people: list[People] = field(default_factory=list)


def content_of(features: Iterable[tuple[object, str]], where: str) -> Content:
    """The parts of a floor plan from features.

    Args:
        features: GeoJSON features with a property `kind`, each with its name in an error message.
        where: name of the source in an error message.

    Raises:
        FloorPlanError: not one walkable area, or a feature of an unknown kind or with the wrong
            geometry.
    """
    found: list[tuple[str, str, BaseGeometry, Mapping[str, Any], str]] = []
    for feature, at in features:
        found.append((*_parse(feature, at), at))
    areas = [(name, geometry) for kind, name, geometry, _, _ in found if kind == "walkable"]
    if len(areas) != 1:
        raise FloorPlanError(f"{where}: expected one walkable area, found {len(areas)}")
    content = Content(name=areas[0][0], walkable=areas[0][1])
    drawn: dict[str, list[sources.Drawn]] = {kind: [] for kind in sources.KINDS}
    for kind, name, geometry, properties, at in found:
        if kind == "walkable":
            content.cut_off = _flag(properties, "cut_off", at)
            content.simplify = properties.get("simplify", SIMPLIFY)
        elif kind == "obstacle":
            content.obstacles.append(geometry)
        elif kind in ("gate", "exit"):
            opening = _opening(Gate if kind == "gate" else Exit, name, geometry, at)
            (content.gates if kind == "gate" else content.exits).append(opening)
            if _flag(properties, "closed", at):
                content.closed.append(name)
        elif kind == "zone":
            try:
                given = {
                    each.name: properties[each.name] for each in OF_ZONES if each.name in properties
                }
                content.zones.append(SpeedZone(geometry, name=name, **{"factor": 0.0, **given}))
            except FloorPlanError as error:
                raise FloorPlanError(f"{at}: {error}") from None
        elif kind in drawn:
            drawn[kind].append(sources.Drawn(name, geometry, properties, at))
        else:
            given = {each: properties[each] for each in OF_ROOMS if each in properties}
            try:
                content.rooms.append(Room(name, geometry, **given))
            except FloorPlanError as error:
                raise FloorPlanError(f"{at}: {error}") from None
    content.people = sources.people_of(drawn[sources.SOURCE], drawn[sources.COUNTER])
    return content


def _flag(properties: Mapping[str, Any], name: str, at: str) -> bool:
    value = properties.get(name, False)
    if not isinstance(value, bool):
        raise FloorPlanError(f"{at}: {name} must be true or false, found {value!r:.60}")
    return value


def _parse(feature: object, at: str) -> tuple[str, str, BaseGeometry, Mapping[str, Any]]:
    if not isinstance(feature, Mapping):
        raise FloorPlanError(f"{at}: expected a Feature, found {type(feature).__name__}")
    properties = feature.get("properties") or {}
    kind = properties.get("kind") if isinstance(properties, Mapping) else None
    if kind not in KINDS:
        raise FloorPlanError(
            f"{at}: property kind must be one of {', '.join(KINDS)}, found {kind!r}"
        )
    try:
        with np.errstate(invalid="ignore"):  # coordinates that are no numbers are refused below
            geometry = shapely.geometry.shape(feature.get("geometry"))
    except Exception as error:  # shapely raises whatever the malformed mapping led it into
        text = " ".join(str(error).split())
        raise FloorPlanError(f"{at}: the geometry cannot be read ({text})") from None
    try:
        check_coordinates(shapely.get_coordinates(geometry), kind)
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None
    expected = "LineString" if kind in ("gate", "exit") else "Polygon"
    if geometry.geom_type != expected:
        raise FloorPlanError(f"{at}: {kind} must be a {expected}, found {geometry.geom_type}")
    return kind, str(properties.get("name") or ""), geometry, properties


def _opening(cls: type[Any], name: str, geometry: BaseGeometry, at: str) -> Any:
    xy = shapely.get_coordinates(geometry)
    if len(xy) != 2:
        raise FloorPlanError(f"{at}: {cls.__name__.lower()} must have two points, found {len(xy)}")
    try:
        opening: Opening = cls(name, tuple(xy[0].tolist()), tuple(xy[1].tolist()))
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None
    return opening
