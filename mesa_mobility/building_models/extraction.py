"""All that is taken from a building model: its storeys and the elements that matter to people."""

from typing import Any

import ifcopenshell

from mesa_mobility.building_models.bodies import meshes_of
from mesa_mobility.building_models.elements import (
    fillings,
    found_of,
    matters,
    panels_of,
    parts_of,
    text,
    type_of,
    whole_ways,
)
from mesa_mobility.building_models.records import Units, record, storey, way_record

MOST = 100_000
"""Elements of a building."""

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


def all_of(path: str, with_furniture: bool) -> dict[str, Any]:
    """All that is taken from a file.

    Args:
        path: the file.
        with_furniture: whether furniture is among it.

    Raises:
        ValueError: units that cannot be, or too many elements.
        Exception: whatever IfcOpenShell makes of a damaged file.
    """
    model = ifcopenshell.open(path)
    units = Units.of(model)
    groups = {kind: found_of(model, names) for kind, names in KINDS.items()}
    ways = {kind: whole_ways(model, name) for kind, name in WAYS.items()}
    storeys = found_of(model, ("IfcBuildingStorey",))
    moving = found_of(model, ("IfcTransportElement",))
    lifts = [each for each in moving if "ELEVATOR" in type_of(each)]
    parts_of_ways = {
        part.id() for found in ways.values() for each in found for part in parts_of(each)
    }
    groups["slab"] = [each for each in groups["slab"] if each.id() not in parts_of_ways]
    groups["wall"] += [part for each in groups["wall"] for part in panels_of(each)]
    counts = {kind: len(found) for kind, found in (groups | ways).items()}
    counts |= {"lift": len(lifts), "storey": len(storeys)}
    counts["escalator"] = sum("ESCALATOR" in type_of(each) for each in moving)
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
        {"kind": kind, **record(each, meshes.get(each.id()), units)}
        for kind, found in (groups | {"lift": lifts}).items()
        for each in found
    ]
    elements += [
        {"kind": kind, **way_record(each, meshes, units)}
        for kind, found in ways.items()
        for each in found
    ]
    names = [each.Name for each in found_of(model, ("IfcBuilding",)) if each.Name]
    return {
        "name": text(names[0]) if names else "",
        "counts": counts,
        "storeys": [storey(each, units) for each in storeys],
        "elements": elements,
    }
