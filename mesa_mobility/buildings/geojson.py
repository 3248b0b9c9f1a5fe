"""Buildings as GeoJSON: one FeatureCollection in the building's coordinates, metres."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from mesa_mobility.buildings.connections.escalator import Escalator
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.buildings.features import (
    KINDS,
    REFUGE,
    closed_of,
    feature_of_lift,
    feature_of_stairs,
    part_of,
    whole,
)
from mesa_mobility.buildings.level import Level
from mesa_mobility.buildings.refuge import Refuge
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan.formats import geojson
from mesa_mobility.floorplan.formats.content import Content, content_of


@dataclass(frozen=True)
class Parts:
    """The parts of a building, as a file has them.

    Attributes:
        levels: its levels.
        stairs: its stairs, ramps and escalators.
        lifts: its lifts.
        name: its name.
        closed: names of the exits and gates that are closed, those of flights and lifts included.
        gates: names of the gates of each of the stairs, ramps, escalators and lifts.
    """

    levels: Sequence[Level]
    stairs: Sequence[Stairs | Ramp | Escalator]
    lifts: Sequence[Lift]
    name: str
    closed: Sequence[str]
    gates: Mapping[str, Sequence[str]] = field(default_factory=dict)


def feature_collection(parts: Parts) -> dict[str, Any]:
    """See ``Building.to_geojson``; for a building of several levels."""
    features = [feature for level in parts.levels for feature in _features(level)]
    for feature in features:
        properties = feature["properties"]
        if properties["kind"] in ("gate", "exit") and properties["name"] in parts.closed:
            properties["closed"] = True
    further = [feature_of_stairs(each) for each in parts.stairs]
    further += [feature_of_lift(each) for each in parts.lifts]
    for feature in further:
        properties = feature["properties"]
        closed = [each for each in parts.gates.get(properties["name"], ()) if each in parts.closed]
        properties |= {"closed": closed} if closed else {}
    features += further
    return {"type": "FeatureCollection", "name": parts.name, "features": features}


def write(collection: dict[str, Any], path: "str | os.PathLike[str]") -> None:
    """Write a FeatureCollection to a file, complete or not at all."""
    with replacing(path, FloorPlanError) as temporary:
        temporary.write_text(json.dumps(collection, indent=1) + "\n", encoding="utf-8")


def read(source: "str | os.PathLike[str] | Mapping[str, Any]") -> Parts:
    """Read the parts of a building from a file or a mapping.

    Raises:
        FloorPlanError: no GeoJSON, a feature of an unknown kind or level or with a wrong geometry
            or property; the message names file and feature.
    """
    where, data = geojson.label(source), geojson.load(source)
    by_level: dict[int, list[tuple[object, str]]] = {}
    elevations: dict[int, float] = {}
    stairs: list[Stairs | Ramp | Escalator] = []
    lifts: list[Lift] = []
    refuges: dict[int, list[Refuge]] = {}
    closed: list[str] = []
    for number, feature in enumerate(geojson.features_of(data, where)):
        at = f"{where}: feature {number}"
        properties = feature.get("properties") if isinstance(feature, Mapping) else None
        given: Mapping[str, Any] = properties if isinstance(properties, Mapping) else {}
        kind = given.get("kind")
        part = part_of(kind, feature, given, at) if kind in KINDS else None
        if isinstance(part, Stairs | Ramp | Escalator | Lift):
            (lifts if isinstance(part, Lift) else stairs).append(part)  # type: ignore[arg-type]
            closed += closed_of(given, at)
            continue
        level = whole(given, "level", at, 0)
        own = by_level.setdefault(level, [])
        if part is not None:
            refuges.setdefault(level, []).append(part)
            continue
        own.append((feature, at))
        if kind == "walkable":
            elevations[level] = given.get("elevation", 0.0)
    name = data.get("name", "") if isinstance(data, Mapping) else ""
    if not isinstance(name, str):
        raise FloorPlanError(f"{where}: name must be a text, found {name!r:.60}")
    contents = {
        level: content_of(features, f"{where}: level {level}")
        for level, features in by_level.items()
    }
    try:
        levels = [
            level_of(level, each, elevations[level], refuges.get(level, ()))
            for level, each in contents.items()
        ]
    except FloorPlanError as error:
        raise FloorPlanError(f"{where}: {error}") from None
    closed += [name for content in contents.values() for name in content.closed]
    return Parts(levels, stairs, lifts, name, closed)


def level_of(number: int, content: Content, elevation: Any, refuges: Sequence[Refuge]) -> Level:
    """The level of what a file holds of it.

    Raises:
        FloorPlanError: it is no level.
    """
    if content.people:
        raise FloorPlanError(
            f"level {number}: sources are for floor plans, found one in a building"
        )
    if content.cut_off:
        raise FloorPlanError(f"level {number}: cut_off is for floor plans, found it in a building")
    return Level(
        number,
        content.walkable,
        elevation,
        exits=content.exits,
        gates=content.gates,
        obstacles=content.obstacles,
        zones=content.zones,
        name=content.name,
        refuges=refuges,
        rooms=content.rooms,
    )


def _features(level: Level) -> list[dict[str, Any]]:
    """The features of a level, its walkable area first."""
    features = [geojson.feature_of("walkable", level.name, level.area)]
    features[0]["properties"]["elevation"] = level.elevation
    features += [
        geojson.feature_of("obstacle", str(k), each) for k, each in enumerate(level.blocked)
    ]
    features += [
        geojson.feature_of(each.kind, each.name, each.line) for each in (*level.gates, *level.exits)
    ]
    for zone in level.zones:
        features.append(geojson.zone_feature(zone))
    features += [geojson.room_feature(each) for each in level.rooms]
    features += [geojson.feature_of(REFUGE, each.name, each.shape) for each in level.refuges]
    for feature in features:
        feature["properties"]["level"] = level.number
    return features
