"""Rooms, doors, obstacles, stairs and lifts among the features of an indoor map."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates

DOOR = 0.9
"""Metres; width of a door that does not say its own."""

MOST = 50_000
"""Features of a file."""

ROOM, PASSAGE, OBSTACLE, DOORWAY = "room", "passage", "obstacle", "door"
STAIRS, STEPS, LIFT = "stairs", "steps", "lift"
"""Rooms with stairs in them, lines along stairs, and shafts of lifts."""

_INDOOR = {"room": ROOM, "corridor": PASSAGE, "area": PASSAGE, "column": OBSTACLE}
_OPEN = ("walkway", "concourse", "lobby", "foodservice.court", "ramp")
_VOID = ("opentobelow", "void", "escalator", "movingwalkway")
_SOLID = ("column", "structure", "brick", "concrete")
_JOINING = {"stairs": STAIRS, "steps": STAIRS, "elevator": LIFT}
_WORDS = re.compile(r"\b(exit|ausgang|entrance|door)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Shape:
    """A feature.

    Attributes:
        kind: what it is.
        name: its name.
        levels: names of its levels; none where it is on all.
        geometry: where it is.
        width: of a door, or of stairs, metres.
        way_out: whether a door says that it leads outside.
        steps: number of risers of stairs; 0 where they do not say.
        up: whether a line along stairs leads up.
    """

    kind: str
    name: str
    levels: tuple[str, ...]
    geometry: BaseGeometry
    width: float = DOOR
    way_out: bool = False
    steps: int = 0
    up: bool = True


def shapes_of(features: Sequence[Any], where: str, notes: list[str]) -> tuple[list[Shape], bool]:
    """The features that matter, and whether coordinates are degrees for sure.

    Raises:
        FloorPlanError: too many features, or one that cannot be read.
    """
    if len(features) > MOST:
        raise FloorPlanError(f"{where}: {len(features):,} features, expected at most {MOST:,}")
    geodetic, others = False, 0
    ordinals = _ordinals(features)
    shapes: list[Shape] = []
    for number, feature in enumerate(features):
        shape, is_geodetic = _shape(feature, ordinals, f"{where}: feature {number}")
        geodetic |= is_geodetic
        if shape is None:
            others += 1
        else:
            shapes.append(shape)
    if others:
        notes.append(f"left out {others} features that are no rooms, doors or obstacles")
    return shapes, geodetic


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
    """A feature, if it matters, and whether its coordinates are degrees for sure."""
    if not isinstance(feature, Mapping):
        raise FloorPlanError(f"{at}: expected a Feature, found {type(feature).__name__}")
    given = feature.get("properties")
    properties = given if isinstance(given, Mapping) else {}
    geometry = _geometry(feature.get("geometry"), at)
    if geometry is None:
        return None, False
    kind = feature.get("feature_type")
    if isinstance(kind, str):
        return _of_imdf(kind, properties, ordinals, geometry), True
    tags = properties.get("tags")
    return _of_tags(tags if isinstance(tags, Mapping) else properties, geometry)


def _of_imdf(
    kind: str, properties: Mapping[str, Any], ordinals: Mapping[str, str], geometry: BaseGeometry
) -> Shape | None:
    category = str(properties.get("category") or "")
    key = str(properties.get("level_id"))[:80]
    levels = (ordinals.get(key, key),) if properties.get("level_id") else ()
    found = {"opening": DOORWAY, "fixture": OBSTACLE, "kiosk": OBSTACLE}.get(kind, "")
    if kind == "unit" and category not in _VOID:
        found = PASSAGE if category in _OPEN else ROOM
        found = OBSTACLE if category in _SOLID else _JOINING.get(category, found)
    if not found:
        return None
    way_out = category.startswith("emergencyexit")
    return Shape(found, name_of(properties.get("name")), levels, geometry, way_out=way_out)


def _of_tags(tags: Mapping[str, Any], geometry: BaseGeometry) -> tuple[Shape | None, bool]:
    """A feature with tags of OpenStreetMap, or one of unknown origin."""
    name, levels = name_of(tags.get("name")), _levels(tags.get("level"))
    indoor = tags.get("indoor")
    if "door" in tags or "entrance" in tags or indoor == "door":
        if tags.get("door") == "no":
            return None, True
        width = _width(tags.get("door:width") or tags.get("width"))
        way_out = tags.get("entrance", "no") != "no"
        return Shape(DOORWAY, name, levels, geometry.centroid, width, way_out), True
    if tags.get("highway") == "steps" and geometry.geom_type == "LineString":
        steps = str(tags.get("step_count"))[:4]
        count = int(steps) if steps.isascii() and steps.isdigit() else 0
        width, up = _width(tags.get("width"), 1.2), tags.get("incline") != "down"
        return Shape(STEPS, name, levels, geometry, width, steps=count, up=up), True
    if geometry.area > 0 and (tags.get("highway") == "elevator" or tags.get("room") == "elevator"):
        return Shape(LIFT, name, levels, geometry), True
    if isinstance(indoor, str) and geometry.area > 0:
        kind = _INDOOR.get(indoor, "")
        kind = PASSAGE if indoor == "yes" and "room" not in tags else kind
        if kind and (tags.get("room") == "stairs" or tags.get("stairs") == "yes"):
            kind = STAIRS
        return (Shape(kind, name, levels, geometry) if kind else None), True
    said = " ".join(str(each) for each in tags.values() if isinstance(each, str))[:400]
    if geometry.area > 0:
        kind = OBSTACLE if re.search(r"obstacle|column|pillar", said, re.IGNORECASE) else ROOM
        return Shape(kind, name, levels, geometry), False
    if _WORDS.search(said) and geometry.geom_type in ("LineString", "Point"):
        return Shape(DOORWAY, name, levels, geometry), False
    return None, False


def name_of(value: Any) -> str:
    """A name, or the first of those in several languages."""
    if isinstance(value, Mapping):
        value = next((each for each in value.values() if isinstance(each, str)), "")
    return " ".join(str(value or "").split())[:80]


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
    return () if value is None or isinstance(value, list | Mapping) else _named(str(value)[:200])


@lru_cache(maxsize=1000)  # features of one level share their names
def _named(text: str) -> tuple[str, ...]:
    found: list[str] = []
    for part in text.split(";"):
        between = re.fullmatch(r"\s*(-?\d{1,3})\s*-\s*(-?\d{1,3})\s*", part)
        if between and int(between[1]) <= int(between[2]):
            found += [str(each) for each in range(int(between[1]), int(between[2]) + 1)]
        elif part.strip():
            found.append(re.sub(r"\.0+$", "", part.strip())[:20])
    return tuple(found)


def _width(value: Any, default: float = DOOR) -> float:
    try:
        width = float(str(value)[:20].removesuffix("m"))
    except ValueError:
        return default
    return width if 0.3 <= width <= 20 else default
