"""Stairs, ramps, escalators, lifts and refuges as features of GeoJSON."""

from collections.abc import Callable, Mapping
from typing import Any, cast

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.connections.escalator import DOWN, Escalator
from mesa_mobility.buildings.connections.flights import BOTH
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.lines import Line
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import DOG_LEG, FLIGHTS, Stairs
from mesa_mobility.buildings.refuge import Refuge
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats import geojson

STAIRS, RAMP, ESCALATOR, LIFT = Stairs.kind, Ramp.kind, Escalator.kind, Lift.kind

REFUGE = "refuge"

Part = Stairs | Ramp | Escalator | Lift | Refuge

Given = Mapping[str, Any]
"""The properties of a feature."""

_OF_ALL = ("kind", "name", "level")

_OF_FLIGHTS = ("from", "to", "closed")

_OF_DOG_LEGS = ("turn", "well", "landing")

_OF_SEVERAL_FLIGHTS = ("flights", "turns", "landing")

_OF_ESCALATORS = ("length", "direction", "speed", "capacity")

_OF_LIFTS = ("capacity", "speed", "door_s", "width", "depth", "everybody")

_KNOWN = {
    STAIRS: (
        *(*_OF_FLIGHTS, "risers", "tread", "type", "handrails"),
        *dict.fromkeys((*_OF_DOG_LEGS, *_OF_SEVERAL_FLIGHTS)),
    ),
    RAMP: (*_OF_FLIGHTS, "length", "factor"),
    ESCALATOR: (*_OF_FLIGHTS, *_OF_ESCALATORS),
    LIFT: ("levels", "closed", *_OF_LIFTS),
    REFUGE: (),
}
"""The properties of each kind, beside those that all have."""


def feature_of_stairs(stairs: Stairs | Ramp | Escalator) -> dict[str, Any]:
    """The feature of stairs, a ramp or an escalator."""
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
    if stairs.handrails != BOTH:
        feature["properties"]["handrails"] = stairs.handrails
    names = {DOG_LEG: _OF_DOG_LEGS, FLIGHTS: _OF_SEVERAL_FLIGHTS}.get(stairs.shape, ())
    given = {name: getattr(stairs, name) for name in names}
    feature["properties"] |= {name: each for name, each in given.items() if each is not None}
    return feature


def feature_of_lift(lift: Lift) -> dict[str, Any]:
    """The feature of a lift."""
    feature = geojson.feature_of(LIFT, lift.name, shapely.LineString(lift.door))
    feature["properties"] |= {"level": lift.numbers[0], "levels": list(lift.numbers)}
    feature["properties"] |= {name: getattr(lift, name) for name in _OF_LIFTS}
    return feature


def part_of(kind: str, feature: Given, given: Given, at: str) -> Part:
    """The part of a building that a feature of one of ``KINDS`` holds.

    Args:
        kind: its kind.
        feature: the feature.
        given: its properties.
        at: what error messages call it.

    Raises:
        FloorPlanError: a wrong geometry or property.
    """
    known = (*_OF_ALL, *_KNOWN[kind])
    unknown = [name for name in given if name not in known]
    if unknown:
        raise FloorPlanError(
            f"{at}: {kind} has no property {unknown[0]!r:.60}, expected some of {', '.join(known)}"
        )
    try:
        return _READERS[kind](feature, given, at)
    except FloorPlanError as error:
        said = str(error)
        raise FloorPlanError(said if said.startswith(at) else f"{at}: {said}") from None


def closed_of(given: Given, at: str) -> list[str]:
    """Names of the closed gates of stairs, a ramp, an escalator or a lift."""
    names = given.get("closed", [])
    if not isinstance(names, list) or not all(isinstance(each, str) for each in names):
        raise FloorPlanError(f"{at}: closed must be a list of names of gates, found {names!r:.60}")
    return names


def _lift(feature: Given, given: Given, at: str) -> Lift:
    levels = given.get("levels")
    if not isinstance(levels, list) or not all(type(each) is int for each in levels):
        raise FloorPlanError(f"{at}: levels must be whole numbers, found {levels!r:.60}")
    if given.get("level", (levels or [0])[0]) not in levels:
        raise FloorPlanError(
            f"{at}: level must be one of its levels {levels}, found {given['level']!r:.60}"
        )
    everybody = given.get("everybody", False)
    if not isinstance(everybody, bool):
        raise FloorPlanError(f"{at}: everybody must be true or false, found {everybody!r:.60}")
    more = {name: given[name] for name in _OF_LIFTS if name in given}
    return Lift(_name(given, at), levels, _line(feature, LIFT, at), **more)


def _refuge(feature: Given, given: Given, at: str) -> Refuge:
    area = geometry_of(feature, "Polygon", REFUGE, at)
    return Refuge(_name(given, at), cast("shapely.Polygon", area))


def _stairs(feature: Given, given: Given, at: str) -> Stairs:
    head, ends = _line(feature, STAIRS, at), _ends(given, at)
    risers, tread = whole(given, "risers", at), _number(given, "tread", at)
    more = {name: given[name] for name in (*_OF_DOG_LEGS, "handrails") if name in given}
    for name in ("flights", "turns"):
        if name in given:
            if not isinstance(given[name], list | tuple):
                raise FloorPlanError(f"{at}: {name} must be a list, found {given[name]!r:.60}")
            more[name] = tuple(given[name])
    shape = given.get("type", "straight")
    return Stairs(_name(given, at), *ends, head, risers, tread, shape, **more)


def _ramp(feature: Given, given: Given, at: str) -> Ramp:
    head, ends = _line(feature, RAMP, at), _ends(given, at)
    length, factor = _number(given, "length", at), _number({"factor": 1.0, **given}, "factor", at)
    return Ramp(_name(given, at), *ends, head, length, factor)


def _escalator(feature: Given, given: Given, at: str) -> Escalator:
    head, ends = _line(feature, ESCALATOR, at), _ends(given, at)
    numbers = ("speed", "capacity")
    more: dict[str, Any] = {}
    more |= {each: _number(given, each, at) for each in numbers if given.get(each) is not None}
    way, length = given.get("direction", DOWN), _number(given, "length", at)
    return Escalator(_name(given, at), *ends, head, length, way, **more)


_READERS: Mapping[str, Callable[[Given, Given, str], Part]] = {
    STAIRS: _stairs,
    RAMP: _ramp,
    ESCALATOR: _escalator,
    LIFT: _lift,
    REFUGE: _refuge,
}

KINDS = tuple(_READERS)
"""The kinds of features that only buildings have."""


def geometry_of(feature: Given, what: str, kind: str, at: str) -> BaseGeometry:
    """The geometry of a feature, of the type ``what``; its coordinates are not checked.

    Raises:
        FloorPlanError: no such geometry.
    """
    try:
        with np.errstate(invalid="ignore"):  # coordinates that are no numbers are refused later
            geometry = shapely.geometry.shape(feature.get("geometry"))
    except Exception as error:  # shapely raises whatever the malformed mapping led it into
        text = " ".join(str(error).split())
        raise FloorPlanError(f"{at}: the geometry cannot be read ({text})") from None
    if geometry.geom_type != what:
        raise FloorPlanError(f"{at}: {kind} must be a {what}, found {geometry.geom_type}")
    return geometry


def _line(feature: Given, kind: str, at: str) -> Line:
    geometry = geometry_of(feature, "LineString", kind, at)
    return cast("Line", tuple(map(tuple, shapely.get_coordinates(geometry).tolist())))


def _ends(given: Given, at: str) -> tuple[int, int]:
    """Numbers of the upper and the lower level."""
    upper, lower = whole(given, "from", at), whole(given, "to", at)
    if whole(given, "level", at, upper) != upper:
        raise FloorPlanError(
            f"{at}: level must be that of from, {upper}, found {given['level']!r:.60}"
        )
    return upper, lower


def _name(given: Given, at: str) -> str:
    value = given.get("name")
    if not isinstance(value, str | None):
        raise FloorPlanError(f"{at}: name must be a text, found {value!r:.60}")
    return value or ""


def whole(given: Given, name: str, at: str, default: int | None = None) -> int:
    """A property that is a whole number."""
    value = given.get(name, default)
    if not isinstance(value, int) or isinstance(value, bool):
        raise FloorPlanError(f"{at}: {name} must be a whole number, found {value!r:.60}")
    return value


def _number(given: Given, name: str, at: str) -> float:
    value = given.get(name)
    if not is_number(value):
        raise FloorPlanError(f"{at}: {name} must be a number, found {value!r:.60}")
    return float(value)
