"""Buildings as GeoJSON: one FeatureCollection in the building's coordinates, metres."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.escalator import DOWN, Escalator
from mesa_mobility.buildings.level import Level, Refuge
from mesa_mobility.buildings.lift import Lift
from mesa_mobility.buildings.lines import Line
from mesa_mobility.buildings.ramp import Ramp
from mesa_mobility.buildings.stairs import DOG_LEG, Stairs
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan.formats import geojson
from mesa_mobility.floorplan.formats.content import Content, content_of

STAIRS, RAMP, ESCALATOR, LIFT = Stairs.kind, Ramp.kind, Escalator.kind, "lift"

REFUGE = "refuge"

_OF_DOG_LEGS = ("turn", "well", "landing")

_OF_ESCALATORS = ("length", "direction", "speed", "capacity")

_OF_LIFTS = ("capacity", "speed", "door_s", "width", "depth", "everybody")


@dataclass(frozen=True)
class Parts:
    """The parts of a building, as a file has them.

    Attributes:
        levels: its levels.
        stairs: its stairs, ramps and escalators.
        lifts: its lifts.
        name: its name.
        closed: names of the exits and gates that are closed.
    """

    levels: Sequence[Level]
    stairs: Sequence[Stairs | Ramp | Escalator]
    lifts: Sequence[Lift]
    name: str
    closed: Sequence[str]


def feature_collection(parts: Parts) -> dict[str, Any]:
    """See ``Building.to_geojson``; for a building of several levels."""
    features = [feature for level in parts.levels for feature in _features(level)]
    for feature in features:
        properties = feature["properties"]
        if properties["kind"] in ("gate", "exit") and properties["name"] in parts.closed:
            properties["closed"] = True
    features += [_stairs_feature(each) for each in parts.stairs]
    features += [_lift_feature(each) for each in parts.lifts]
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
    lifts = []
    refuges: dict[int, list[Refuge]] = {}
    for number, feature in enumerate(geojson.features_of(data, where)):
        at = f"{where}: feature {number}"
        properties = feature.get("properties") if isinstance(feature, Mapping) else None
        given: Mapping[str, Any] = properties if isinstance(properties, Mapping) else {}
        if given.get("kind") == STAIRS:
            stairs.append(_stairs(feature, given, at))
            continue
        if given.get("kind") == RAMP:
            stairs.append(_ramp(feature, given, at))
            continue
        if given.get("kind") == ESCALATOR:
            stairs.append(_escalator(feature, given, at))
            continue
        if given.get("kind") == LIFT:
            lifts.append(_lift(feature, given, at))
            continue
        level = _whole(given, "level", at, 0)
        if given.get("kind") == REFUGE:
            refuges.setdefault(level, []).append(_refuge(feature, given, at))
            by_level.setdefault(level, [])
            continue
        by_level.setdefault(level, []).append((feature, at))
        if given.get("kind") == "walkable":
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
            _level(level, each, elevations[level], refuges.get(level, ()))
            for level, each in contents.items()
        ]
    except FloorPlanError as error:
        raise FloorPlanError(f"{where}: {error}") from None
    closed = [name for content in contents.values() for name in content.closed]
    return Parts(levels, stairs, lifts, name, closed)


def _level(number: int, content: Content, elevation: Any, refuges: Sequence[Refuge]) -> Level:
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
        features.append(geojson.feature_of("zone", zone.name, zone.area))
        features[-1]["properties"]["factor"] = zone.factor
    features += [geojson.feature_of(REFUGE, each.name, each.shape) for each in level.refuges]
    for feature in features:
        feature["properties"]["level"] = level.number
    return features


def _stairs_feature(stairs: Stairs | Ramp | Escalator) -> dict[str, Any]:
    feature = geojson.feature_of(stairs.kind, stairs.name, shapely.LineString(stairs.head))
    feature["properties"] |= {"level": stairs.upper, "from": stairs.upper, "to": stairs.lower}
    if isinstance(stairs, Ramp):
        feature["properties"] |= {"length": stairs.length, "factor": stairs.factor}
        return feature
    if isinstance(stairs, Escalator):
        values = {name: getattr(stairs, name) for name in _OF_ESCALATORS}
        feature["properties"] |= {name: each for name, each in values.items() if each is not None}
        return feature
    feature["properties"] |= {
        "risers": stairs.risers,
        "tread": stairs.tread,
        "type": stairs.shape,
    }
    if stairs.shape == DOG_LEG:
        given = {name: getattr(stairs, name) for name in _OF_DOG_LEGS}
        feature["properties"] |= {name: each for name, each in given.items() if each is not None}
    return feature


def _lift_feature(lift: Lift) -> dict[str, Any]:
    feature = geojson.feature_of(LIFT, lift.name, shapely.LineString(lift.door))
    feature["properties"] |= {"level": lift.numbers[0], "levels": list(lift.numbers)}
    feature["properties"] |= {name: getattr(lift, name) for name in _OF_LIFTS}
    return feature


def _lift(feature: Mapping[str, Any], given: Mapping[str, Any], at: str) -> Lift:
    levels = given.get("levels")
    if not isinstance(levels, list) or not all(type(each) is int for each in levels):
        raise FloorPlanError(f"{at}: levels must be whole numbers, found {levels!r:.60}")
    everybody = given.get("everybody", False)
    if not isinstance(everybody, bool):
        raise FloorPlanError(f"{at}: everybody must be true or false, found {everybody!r:.60}")
    more = {name: given[name] for name in _OF_LIFTS if name in given}
    try:
        return Lift(str(given.get("name") or ""), levels, _line(feature, LIFT, at), **more)
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None


def _refuge(feature: Mapping[str, Any], given: Mapping[str, Any], at: str) -> Refuge:
    area = _geometry(feature, "Polygon", REFUGE, at)
    try:
        return Refuge(str(given.get("name") or ""), cast("shapely.Polygon", area))
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None


def _geometry(feature: Mapping[str, Any], what: str, kind: str, at: str) -> BaseGeometry:
    try:
        geometry = shapely.geometry.shape(feature.get("geometry"))
    except Exception as error:  # shapely raises whatever the malformed mapping led it into
        text = " ".join(str(error).split())
        raise FloorPlanError(f"{at}: the geometry cannot be read ({text})") from None
    if geometry.geom_type != what:
        raise FloorPlanError(f"{at}: {kind} must be a {what}, found {geometry.geom_type}")
    return geometry


def _line(feature: Mapping[str, Any], kind: str, at: str) -> Line:
    geometry = _geometry(feature, "LineString", kind, at)
    return cast("Line", tuple(map(tuple, shapely.get_coordinates(geometry).tolist())))


def _stairs(feature: Mapping[str, Any], given: Mapping[str, Any], at: str) -> Stairs:
    head = _line(feature, STAIRS, at)
    upper, lower, risers = (_whole(given, name, at) for name in ("from", "to", "risers"))
    tread, shape = _number(given, "tread", at), given.get("type", "straight")
    more = {name: given[name] for name in _OF_DOG_LEGS if name in given}
    try:
        return Stairs(
            str(given.get("name") or ""), upper, lower, head, risers, tread, shape, **more
        )
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None


def _ramp(feature: Mapping[str, Any], given: Mapping[str, Any], at: str) -> Ramp:
    head, name = _line(feature, RAMP, at), str(given.get("name") or "")
    upper, lower = (_whole(given, end, at) for end in ("from", "to"))
    length, factor = _number(given, "length", at), _number({"factor": 1.0, **given}, "factor", at)
    try:
        return Ramp(name, upper, lower, head, length, factor)
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None


def _escalator(feature: Mapping[str, Any], given: Mapping[str, Any], at: str) -> Escalator:
    head, name = _line(feature, ESCALATOR, at), str(given.get("name") or "")
    upper, lower = (_whole(given, end, at) for end in ("from", "to"))
    numbers = ("speed", "capacity")
    more = {each: _number(given, each, at) for each in numbers if given.get(each) is not None}
    way, length = given.get("direction", DOWN), _number(given, "length", at)
    try:
        return Escalator(name, upper, lower, head, length, way, **more)
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None


def _whole(given: Mapping[str, Any], name: str, at: str, default: int | None = None) -> int:
    value = given.get(name, default)
    if not isinstance(value, int) or isinstance(value, bool):
        raise FloorPlanError(f"{at}: {name} must be a whole number, found {value!r:.60}")
    return value


def _number(given: Mapping[str, Any], name: str, at: str) -> float:
    value = given.get(name)
    if not is_number(value):
        raise FloorPlanError(f"{at}: {name} must be a number, found {value!r:.60}")
    return float(value)
