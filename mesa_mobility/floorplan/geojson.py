"""Floor plans as GeoJSON: one FeatureCollection, coordinates in metres."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan.extent import check_coordinates
from mesa_mobility.floorplan.openings import Exit, Gate, Opening
from mesa_mobility.floorplan.zones import SpeedZone

if TYPE_CHECKING:
    from mesa_mobility.floorplan.plan import FloorPlan

KINDS = ("walkable", "obstacle", "gate", "exit", "zone")
"""Values of the property `kind` of a feature."""


@dataclass
class Content:
    """Content of a FeatureCollection, before it is checked as a floor plan."""

    walkable: Polygon
    name: str
    exits: list[Exit] = field(default_factory=list)
    gates: list[Gate] = field(default_factory=list)
    obstacles: list[Polygon] = field(default_factory=list)
    zones: list[SpeedZone] = field(default_factory=list)
    closed: list[str] = field(default_factory=list)
    cut_off: bool = False


def feature_collection(plan: "FloorPlan") -> dict[str, Any]:
    """The plan as a FeatureCollection; see `FloorPlan.to_geojson`."""
    features = [_feature("walkable", plan.name, plan.walkable)]
    if plan.cut_off:
        features[0]["properties"]["cut_off"] = True
    features += [
        _feature("obstacle", str(i), polygon) for i, polygon in enumerate(plan.obstacles.values())
    ]
    for opening in plan.openings():
        feature = _feature(opening.kind, opening.name, opening.line)
        if not plan.is_open(opening.name):
            feature["properties"]["closed"] = True
        features.append(feature)
    for zone in plan.zones:
        feature = _feature("zone", zone.name, zone.area)
        feature["properties"]["factor"] = zone.factor
        features.append(feature)
    return {"type": "FeatureCollection", "features": features}


def write(collection: Mapping[str, Any], path: "str | os.PathLike[str]") -> None:
    """Write a FeatureCollection to `path`: complete or not at all."""
    with replacing(path, FloorPlanError) as temporary:
        temporary.write_text(json.dumps(collection, indent=1) + "\n", encoding="utf-8")


def label(source: "str | os.PathLike[str] | Mapping[str, Any]") -> str:
    """Name of a source in an error message: its path."""
    return "GeoJSON" if isinstance(source, Mapping) else str(source)


def read(source: "str | os.PathLike[str] | Mapping[str, Any]") -> Content:
    """Read a FeatureCollection from a file or a mapping.

    Raises:
        FloorPlanError: the file cannot be read, is not JSON or not a FeatureCollection, or a
            feature has an unknown kind or the wrong geometry; the message names file and feature.
    """
    if isinstance(source, Mapping):
        return _content(source, label(source))
    try:
        text = Path(source).read_text(encoding="utf-8")
    except OSError as error:
        raise FloorPlanError(f"{source}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise FloorPlanError(f"{source}: is not text, expected GeoJSON") from None
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise FloorPlanError(f"{source}: is not JSON (line {error.lineno}: {error.msg})") from None
    except RecursionError:
        raise FloorPlanError(f"{source}: is not a floor plan (nested too deeply)") from None
    except ValueError:  # Python refuses integers of thousands of digits
        raise FloorPlanError(f"{source}: has a number of thousands of digits") from None
    return _content(data, label(source))


def _content(data: object, where: str) -> Content:
    if not isinstance(data, Mapping) or data.get("type") != "FeatureCollection":
        raise FloorPlanError(f"{where}: expected a GeoJSON FeatureCollection")
    features = data.get("features")
    if not isinstance(features, list):
        raise FloorPlanError(f"{where}: features must be a list")
    found: list[tuple[str, str, BaseGeometry, Mapping[str, Any], str]] = []
    for number, feature in enumerate(features):
        found.append((*_parse(feature, f"{where}: feature {number}"), f"{where}: feature {number}"))
    areas = [(name, geometry) for kind, name, geometry, _, _ in found if kind == "walkable"]
    if len(areas) != 1:
        raise FloorPlanError(f"{where}: expected one feature of kind walkable, found {len(areas)}")
    content = Content(name=areas[0][0], walkable=areas[0][1])
    for kind, name, geometry, properties, at in found:
        if kind == "walkable":
            content.cut_off = _flag(properties, "cut_off", at)
        elif kind == "obstacle":
            content.obstacles.append(geometry)
        elif kind in ("gate", "exit"):
            opening = _opening(Gate if kind == "gate" else Exit, name, geometry, at)
            (content.gates if kind == "gate" else content.exits).append(opening)
            if _flag(properties, "closed", at):
                content.closed.append(name)
        elif kind == "zone":
            try:
                content.zones.append(SpeedZone(geometry, properties.get("factor", 0.0), name))
            except FloorPlanError as error:
                raise FloorPlanError(f"{at}: {error}") from None
    return content


def _flag(properties: Mapping[str, Any], name: str, at: str) -> bool:
    value = properties.get(name, False)
    if not isinstance(value, bool):
        raise FloorPlanError(f"{at}: {name} must be true or false, found {value!r:.60}")
    return value


def _feature(kind: str, name: str, geometry: BaseGeometry) -> dict[str, Any]:
    return {
        "type": "Feature",
        "properties": {"kind": kind, "name": name},
        "geometry": json.loads(json.dumps(shapely.geometry.mapping(geometry))),
    }


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
        geometry = shapely.geometry.shape(feature.get("geometry"))
    except Exception as error:  # shapely raises whatever the malformed mapping led it into
        text = " ".join(str(error).split())
        raise FloorPlanError(f"{at}: the geometry cannot be read ({text})") from None
    try:
        check_coordinates(shapely.get_coordinates(geometry), kind)
    except FloorPlanError as error:
        raise FloorPlanError(f"{at}: {error}") from None
    expected = "Polygon" if kind in ("walkable", "obstacle", "zone") else "LineString"
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
