"""Takes from an IFC what a floor plan needs, as JSON. Runs in a process of its own.

IfcOpenShell is compiled code, which a damaged file may crash, or keep busy. So this file is a
script that imports nothing of the package; ``child.py`` starts it and reads what it prints.
"""

import contextlib
import json
import math
import os
import sys
from collections.abc import Iterable, Iterator
from typing import Any

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.placement
import ifcopenshell.util.unit
import numpy as np
import shapely

MOST = 100_000
"""Elements of a building."""

GRID = 1e-4
"""Metres; corners of footprints lie on this grid."""

LEVEL = 0.999
"""The cosine of the slope of a face that counts as level."""

KINDS = {
    "room": ("IfcSpace",),
    "wall": ("IfcWall", "IfcColumn", "IfcCurtainWall"),
    "slab": ("IfcSlab",),
    "opening": ("IfcOpeningElement",),
    "door": ("IfcDoor",),
    "furniture": ("IfcFurnishingElement",),
}
"""Classes of the elements of each kind, beside stairs, ramps and lifts."""

WAYS = {"stairs": "IfcStair", "ramp": "IfcRamp"}
STEPS = ("IfcStairFlight", "IfcRampFlight", "IfcSlab")
"""Parts of stairs and ramps that people step on."""


def main(path: str, with_furniture: bool) -> dict[str, Any]:
    """All that is taken from a file.

    Args:
        path: the file.
        with_furniture: whether furniture is among it.
    """
    model = ifcopenshell.open(path)
    scale = ifcopenshell.util.unit.calculate_unit_scale(model)
    if not 0.0 < scale < 1e6:
        raise ValueError(f"its unit of length is {scale:g} m")
    groups = {kind: found_of(model, names) for kind, names in KINDS.items()}
    ways = {kind: whole_ways(model, name) for kind, name in WAYS.items()}
    lifts = [
        each for each in found_of(model, ("IfcTransportElement",)) if "ELEVATOR" in type_of(each)
    ]
    parts_of_ways = {
        part.id() for found in ways.values() for each in found for part in parts_of(each)
    }
    groups["slab"] = [each for each in groups["slab"] if each.id() not in parts_of_ways]
    groups["wall"] += [part for each in groups["wall"] for part in panels_of(each)]
    counts = {kind: len(found) for kind, found in (groups | ways).items()}
    counts |= {"lift": len(lifts), "storey": len(found_of(model, ("IfcBuildingStorey",)))}
    if sum(counts.values()) > MOST:
        raise ValueError(f"has {sum(counts.values()):,} elements, expected at most {MOST:,}")
    if not with_furniture:
        groups["furniture"] = []
    groups["opening"] = [each for each in groups["opening"] if matters(each)]
    filled = {each.id() for opening in groups["opening"] for each in fillings(opening)}
    shown = [each for kind, found in groups.items() if kind != "door" for each in found]
    shown += [each for each in groups["door"] if each.id() not in filled]
    shown += [part for found in ways.values() for each in found for part in parts_of(each)] + lifts
    meshes = meshes_of(model, shown)
    elements = [
        {"kind": kind, **record(each, meshes.get(each.id()), scale)}
        for kind, found in groups.items()
        for each in found
    ]
    elements += [
        {"kind": kind, **way_record(each, meshes, scale)}
        for kind, found in ways.items()
        for each in found
    ]
    elements += [{"kind": "lift", **record(each, meshes.get(each.id()), scale)} for each in lifts]
    names = [each.Name for each in found_of(model, ("IfcBuilding",)) if each.Name]
    return {
        "name": text(names[0]) if names else "",
        "counts": counts,
        "storeys": [storey(each, scale) for each in found_of(model, ("IfcBuildingStorey",))],
        "elements": elements,
    }


def found_of(model: Any, names: Iterable[str]) -> list[Any]:
    """The elements of some classes; a class that a schema does not have has none."""
    found: dict[int, Any] = {}
    for name in names:
        with contextlib.suppress(RuntimeError):
            found |= {each.id(): each for each in model.by_type(name)}
    return list(found.values())


def whole_ways(model: Any, name: str) -> list[Any]:
    """Stairs or ramps, and flights that are part of none."""
    whole = found_of(model, (name,))
    parts = {part.id() for each in whole for part in parts_of(each)}
    return whole + [each for each in found_of(model, (f"{name}Flight",)) if each.id() not in parts]


def parts_of(element: Any) -> list[Any]:
    """An element, and the parts of it that people step on."""
    found = [element]
    for relation in getattr(element, "IsDecomposedBy", None) or ():
        found += [each for each in relation.RelatedObjects if each.is_a() in STEPS]
    return found


def panels_of(wall: Any) -> list[Any]:
    """Plates and members of which a curtain wall consists."""
    relations = getattr(wall, "IsDecomposedBy", None) or () if wall.is_a("IfcCurtainWall") else ()
    parts = (part for relation in relations for part in relation.RelatedObjects)
    return [each for each in parts if each.is_a() in ("IfcPlate", "IfcMember")]


def fillings(opening: Any) -> list[Any]:
    """Doors and windows in an opening."""
    return [each.RelatedBuildingElement for each in getattr(opening, "HasFillings", None) or ()]


def host_of(opening: Any) -> Any:
    """What an opening is cut out of, or None."""
    found = getattr(opening, "VoidsElements", None) or ()
    return found[0].RelatingBuildingElement if found else None


def matters(opening: Any) -> bool:
    """Whether people may walk, or fall, through an opening."""
    kinds = [each.is_a() for each in fillings(opening) if each is not None]
    return host_of(opening) is not None and (not kinds or "IfcDoor" in kinds)


def meshes_of(model: Any, elements: list[Any]) -> dict[int, tuple[Any, Any]]:
    """(n, 3) corners in metres and (m, 3) triangles of each element that has a body, by its id."""
    if not elements:
        return {}
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("disable-opening-subtractions", True)
    iterator = ifcopenshell.geom.iterator(settings, model, 1, include=elements)
    found: dict[int, tuple[Any, Any]] = {}
    if not iterator.initialize():
        return found
    while True:
        shape = iterator.get()
        corners = np.array(shape.geometry.verts, dtype=float).reshape(-1, 3)
        triangles = np.array(shape.geometry.faces, dtype=int).reshape(-1, 3)
        if len(triangles) and np.isfinite(corners).all() and np.abs(corners).max() < 1e8:
            found[shape.id] = (corners, triangles)
        if not iterator.next():
            return found


def footprint(corners: Any, triangles: Any) -> Any:
    """What the faces of a body cover in plan."""
    xy = corners[triangles][:, :, :2]
    areas = shapely.polygons(xy)
    areas = areas[shapely.area(areas) > 1e-7]
    whole = shapely.union_all(areas, grid_size=GRID)
    # Slits between triangles that nearly meet are closed.
    return whole.buffer(2 * GRID, join_style="mitre").buffer(-2 * GRID, join_style="mitre")


def treads(corners: Any, triangles: Any) -> list[list[Any]]:
    """Level faces that look up: the height of each and what it covers in plan."""
    spots = corners[triangles]
    normals = np.cross(spots[:, 1] - spots[:, 0], spots[:, 2] - spots[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    level = (sizes > 1e-9) & (normals[:, 2] > LEVEL * sizes)
    heights = np.round(spots[level][:, :, 2].mean(axis=1), 3)
    found = []
    for height in np.unique(heights).tolist():
        own = spots[level][heights == height][:, :, :2]
        area = shapely.union_all(shapely.polygons(own), grid_size=GRID)
        if area.area > 1e-3:
            found.append([height, area.wkb_hex])
    return found


def storey(element: Any, scale: float) -> dict[str, Any]:
    """Number, name and height of a storey."""
    place = getattr(element, "ObjectPlacement", None)
    if place is not None:
        height = float(ifcopenshell.util.placement.get_local_placement(place)[2, 3]) * scale
    else:
        height = float(element.Elevation or 0.0) * scale
    return {"id": element.id(), "name": text(element.Name), "elevation": finite(height)}


def record(element: Any, mesh: tuple[Any, Any] | None, scale: float) -> dict[str, Any]:
    """What is taken from an element."""
    values: dict[str, Any] = {
        "id": element.id(),
        "name": text(element.Name),
        "long_name": text(getattr(element, "LongName", None)),
        "storey": storey_of(element),
        "type": type_of(element),
        "external": said(element, "IsExternal"),
    }
    if element.is_a("IfcDoor"):
        values |= door_record(element, scale)
    if element.is_a("IfcOpeningElement"):
        host = host_of(element)
        values["host"] = host.id()
        values["in_slab"] = host.is_a("IfcSlab") or host.is_a("IfcRoof")
        values["door"] = next((each.id() for each in fillings(element) if each is not None), None)
        values["storey"] = storey_of(host)
    if mesh is not None:
        values |= extent(*mesh)
    return values


def extent(corners: Any, triangles: Any) -> dict[str, Any]:
    """Footprint and heights of a body."""
    heights = corners[triangles][:, :, 2]
    return {
        "area": footprint(corners, triangles).wkb_hex,
        "bottom": float(heights.min()),
        "top": float(heights.max()),
    }


def door_record(door: Any, scale: float) -> dict[str, Any]:
    """Widths of a door, and the thickness of its lining."""
    lining = None
    for definition in door_definitions(door):
        if definition.is_a("IfcDoorLiningProperties") and definition.LiningThickness:
            lining = finite(float(definition.LiningThickness) * scale)
    clear = said(door, "ClearWidth")
    return {
        "width": finite(float(door.OverallWidth) * scale) if door.OverallWidth else None,
        "clear": finite(float(clear) * scale) if isinstance(clear, int | float) else None,
        "lining": lining,
    }


def door_definitions(door: Any) -> Iterator[Any]:
    """Sets of properties of a door and of its type."""
    for relation in getattr(door, "IsDefinedBy", None) or ():
        if relation.is_a("IfcRelDefinesByProperties"):
            yield relation.RelatingPropertyDefinition
    kind = ifcopenshell.util.element.get_type(door)
    yield from (getattr(kind, "HasPropertySets", None) or ()) if kind is not None else ()


def way_record(way: Any, meshes: dict[int, tuple[Any, Any]], scale: float) -> dict[str, Any]:
    """What is taken from stairs or a ramp: its steps, and the numbers that it gives."""
    own = [meshes[part.id()] for part in parts_of(way) if part.id() in meshes]
    values = record(way, None, scale)
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


def storey_of(element: Any) -> int | None:
    """Number of the storey that an element is in."""
    for _ in range(8):
        if element is None or element.is_a("IfcBuildingStorey"):
            break
        element = ifcopenshell.util.element.get_container(
            element
        ) or ifcopenshell.util.element.get_aggregate(element)
    return None if element is None or not element.is_a("IfcBuildingStorey") else element.id()


def type_of(element: Any) -> str:
    """The type that an element, or its class of elements, says."""
    kind = ifcopenshell.util.element.get_predefined_type(element)
    return text(
        kind or getattr(element, "ShapeType", None) or getattr(element, "OperationType", "")
    )


def said(element: Any, name: str) -> Any:
    """A property of an element by its name, of whichever set has it; None if none has."""
    for values in ifcopenshell.util.element.get_psets(element).values():
        if isinstance(values, dict) and isinstance(values.get(name), bool | int | float):
            return values[name]
    return None


def text(value: Any) -> str:
    """A text of one line, not too long."""
    return " ".join(str(value or "").split())[:80]


def finite(value: float) -> float:
    """A number, if it is one."""
    if not math.isfinite(value) or abs(value) > 1e8:
        raise ValueError(f"has the number {value:g}")
    return value


if __name__ == "__main__":
    # Compiled code may print whatever it likes.
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    if os.name == "posix" and "MESA_MOBILITY_MEMORY" in os.environ:
        import resource

        most = int(os.environ["MESA_MOBILITY_MEMORY"])
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
    try:
        result = main(sys.argv[1], "furniture" in sys.argv[2:])
    except Exception as error:  # a damaged file leads IfcOpenShell into errors of any kind
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        result = {"error": reason}
    with answer:
        json.dump(result, answer)
