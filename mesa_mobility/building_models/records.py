"""Records of storeys and elements, with nothing in them but what JSON has; metres."""

import math
from typing import Any, NamedTuple

import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np

from mesa_mobility.building_models.bodies import extent, treads
from mesa_mobility.building_models.elements import (
    door_definitions,
    fillings,
    host_of,
    parts_of,
    said,
    storey_of,
    text,
    type_of,
)

AREAS = "GrossFloorArea", "Area", "GSA BIM Area"
"""Properties with the area of a room, of which the first counts that it has: the base quantity of
IFC, and those that Revit exports."""


class Units(NamedTuple):
    """The file's units of length and area, in metres and square metres."""

    length: float
    area: float

    @classmethod
    def of(cls, model: Any) -> "Units":
        """Those of a file.

        Raises:
            ValueError: a unit that cannot be.
        """
        found = cls(
            *(
                float(ifcopenshell.util.unit.calculate_unit_scale(model, kind))
                for kind in ("LENGTHUNIT", "AREAUNIT")
            )
        )
        for each, name in zip(found, ("length", "area"), strict=True):
            if not 0.0 < each < 1e6:
                raise ValueError(f"its unit of {name} is {each:g}")
        return found


def storey(element: Any, units: Units) -> dict[str, Any]:
    """Number, name and height of a storey."""
    place = getattr(element, "ObjectPlacement", None)
    if place is not None:
        height = float(ifcopenshell.util.placement.get_local_placement(place)[2, 3]) * units.length
    else:
        height = float(element.Elevation or 0.0) * units.length
    return {"id": element.id(), "name": text(element.Name), "elevation": finite(height)}


def record(element: Any, mesh: tuple[Any, Any] | None, units: Units) -> dict[str, Any]:
    """The record of an element."""
    values: dict[str, Any] = {
        "id": element.id(),
        "name": text(element.Name),
        "long_name": text(getattr(element, "LongName", None)),
        "storey": storey_of(element),
        "type": type_of(element),
        "external": said(element, "IsExternal", bool),
    }
    if element.is_a("IfcSpace"):
        values["stated_area"] = stated_area(element, units)
    if element.is_a("IfcDoor"):
        values |= door_record(element, units)
    if element.is_a("IfcOpeningElement"):
        host = host_of(element)
        values["host"] = host.id()
        values["in_slab"] = host.is_a("IfcSlab") or host.is_a("IfcRoof")
        values["door"] = next((each.id() for each in fillings(element) if each is not None), None)
        values["storey"] = storey_of(host)
    if mesh is not None:
        values |= extent(*mesh)
    return values


def stated_area(room: Any, units: Units) -> float | None:
    """The area that the file gives for a room, square metres."""
    for name in AREAS:
        value = said(room, name, int, float)
        if value is not None and value > 0:
            return finite(float(value) * units.area)
    return None


def door_record(door: Any, units: Units) -> dict[str, Any]:
    """Widths of a door, and the thickness of its lining."""
    lining = None
    for definition in door_definitions(door):
        if definition.is_a("IfcDoorLiningProperties") and definition.LiningThickness:
            lining = finite(float(definition.LiningThickness) * units.length)
    clear = said(door, "ClearWidth", int, float)
    return {
        "width": finite(float(door.OverallWidth) * units.length) if door.OverallWidth else None,
        "clear": finite(float(clear) * units.length) if clear is not None else None,
        "lining": lining,
    }


def way_record(way: Any, meshes: dict[int, tuple[Any, Any]], units: Units) -> dict[str, Any]:
    """The record of stairs or a ramp, with its steps and the risers that it gives."""
    own = [meshes[part.id()] for part in parts_of(way) if part.id() in meshes]
    values = record(way, None, units)
    risers = [
        getattr(part, name, None)
        for part in parts_of(way)
        for name in ("NumberOfRisers", "NumberOfRiser")
    ]
    values["risers"] = sum(int(each) for each in risers if each) or None
    if own:
        starts = np.cumsum([0, *(len(corners) for corners, _ in own[:-1])])
        corners = np.concatenate([each[0] for each in own])
        triangles = np.concatenate(
            [each[1] + start for each, start in zip(own, starts, strict=True)]
        )
        values |= extent(corners, triangles)
        values["steps"] = [step for mesh in own for step in treads(*mesh)]
    return values


def finite(value: float) -> float:
    """A number, if it is one."""
    if not math.isfinite(value) or abs(value) > 1e8:
        raise ValueError(f"has the number {value:g}")
    return value
