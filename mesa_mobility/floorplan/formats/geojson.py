"""Floor plans as GeoJSON: one FeatureCollection, coordinates in metres."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.outline import SIMPLIFY
from mesa_mobility.floorplan.floor.room import OF_ROOMS, ROOM, Room
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats.assembling.texts import parsed
from mesa_mobility.floorplan.formats.content import OF_ZONES, Content, content_of
from mesa_mobility.floorplan.formats.indoor.rooms import HEIGHT, read_rooms
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.sources import SOURCE
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.plugins.annotations import Range


class GeoJson(PlanFormat):
    """GeoJSON: one FeatureCollection, coordinates in metres; or rooms of other programs."""

    name = "geojson"
    suffixes = (".geojson", ".json")

    def read(
        self, path: Path, *, height: Annotated[float, Range(1.5, 20)] = HEIGHT
    ) -> Content | Storeys:
        """See ``read`` of this module; ``height`` is for files of other programs."""
        return read(path, height)

    def has_people(self, path: Path) -> bool:
        """Whether it has sources."""
        features = features_of(load(path), str(path))
        given = (each.get("properties") for each in features if isinstance(each, Mapping))
        return any(isinstance(each, Mapping) and each.get("kind") == SOURCE for each in given)

    def write(self, plan: Floor, path: Path) -> None:
        """Write a floor plan; see ``FloorPlan.write_geojson``."""
        write(plan, path)


def feature_collection(plan: Floor) -> dict[str, Any]:
    """The plan as a GeoJSON FeatureCollection, coordinates in metres.

    Every feature has the properties `kind` (walkable, obstacle, gate, exit, zone or room)
    and `name`; a closed gate or exit has `closed` true, a zone its `factor`, a room its `use`.
    Rooms that were found are not written: they are found again.
    Reading it back gives the same coordinates to the last bit; obstacle ids count from 0 again.
    """
    if plan.in_sheets:
        raise FloorPlanError(
            "a plan of several sheets has no GeoJSON of its own, expected that of its building"
        )
    features = [feature_of("walkable", plan.name, plan.walkable)]
    if plan.cut_off:
        features[0]["properties"]["cut_off"] = True
    if plan.simplify != SIMPLIFY:
        features[0]["properties"]["simplify"] = plan.simplify
    features += [
        feature_of("obstacle", str(i), polygon) for i, polygon in enumerate(plan.obstacles.values())
    ]
    for opening in plan.openings():
        feature = feature_of(opening.kind, opening.name, opening.line)
        if not plan.is_open(opening.name):
            feature["properties"]["closed"] = True
        features.append(feature)
    for zone in plan.zones:
        features.append(zone_feature(zone))
    features += [room_feature(room) for room in plan.given_rooms]
    return {"type": "FeatureCollection", "features": features}


def write(plan: Floor, path: "str | os.PathLike[str]") -> None:
    """Write `to_geojson` to a file, complete or not at all."""
    with replacing(path, FloorPlanError) as temporary:
        temporary.write_text(
            json.dumps(feature_collection(plan), indent=1) + "\n", encoding="utf-8"
        )


def label(source: "str | os.PathLike[str] | Mapping[str, Any]") -> str:
    """Name of a source in an error message: its path."""
    return "GeoJSON" if isinstance(source, Mapping) else str(source)


def read(
    source: "str | os.PathLike[str] | Mapping[str, Any]", height: float = HEIGHT
) -> Content | Storeys:
    """Read a FeatureCollection from a file or a mapping.

    Features without a property ``kind`` are rooms of other programs, with ``height`` metres from
    one level to the next; see ``read_rooms``.

    Raises:
        FloorPlanError: the file cannot be read, is not JSON or not a FeatureCollection, or a
            feature has an unknown kind or the wrong geometry; the message names file and feature.
    """
    where = label(source)
    features = features_of(load(source), where)
    if features and not any(map(_has_kind, features)):
        return read_rooms(features, where, height)
    return content_of(
        ((feature, f"{where}: feature {number}") for number, feature in enumerate(features)), where
    )


def _has_kind(feature: Any) -> bool:
    """Whether a feature says what it is as this package's files do, or is no feature at all."""
    if not isinstance(feature, Mapping):
        return True
    properties = feature.get("properties")
    return isinstance(properties, Mapping) and "kind" in properties


def load(source: "str | os.PathLike[str] | Mapping[str, Any]") -> object:
    """The JSON of a file; a mapping as it is.

    Raises:
        FloorPlanError: the file cannot be read or is not JSON.
    """
    if isinstance(source, Mapping):
        return source
    try:
        text = Path(source).read_text(encoding="utf-8")
    except OSError as error:
        raise FloorPlanError(f"{source}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise FloorPlanError(f"{source}: is not text, expected GeoJSON") from None
    return parsed(text, str(source))


def features_of(data: object, where: str) -> list[Any]:
    """The features of a FeatureCollection; FloorPlanError, naming ``where``, for anything else."""
    if not isinstance(data, Mapping) or data.get("type") != "FeatureCollection":
        raise FloorPlanError(f"{where}: expected a GeoJSON FeatureCollection")
    features = data.get("features")
    if not isinstance(features, list):
        raise FloorPlanError(f"{where}: features must be a list")
    return features


def zone_feature(zone: SpeedZone) -> dict[str, Any]:
    """The feature of a speed zone, with all that is not as it is by default."""
    feature = feature_of("zone", zone.name, zone.area)
    feature["properties"] |= {
        each.name: getattr(zone, each.name)
        for each in OF_ZONES
        if getattr(zone, each.name) != each.default
    }
    return feature


def room_feature(room: Room) -> dict[str, Any]:
    """The feature of a room, with its use and its stated area if it has them."""
    feature = feature_of(ROOM, room.name, room.shape)
    feature["properties"] |= {name: value for name in OF_ROOMS if (value := getattr(room, name))}
    return feature


def feature_of(kind: str, name: str, geometry: BaseGeometry) -> dict[str, Any]:
    """A GeoJSON feature of a kind, with its name."""
    return {
        "type": "Feature",
        "properties": {"kind": kind, "name": name},
        "geometry": json.loads(json.dumps(shapely.geometry.mapping(geometry))),
    }
