"""Elements of an IFC: which there are, what is part of what, and what they say of themselves."""

import contextlib
from collections.abc import Iterable, Iterator
from typing import Any

import ifcopenshell.util.element

STEPS = ("IfcStairFlight", "IfcRampFlight", "IfcSlab")
"""Parts of stairs and ramps that people step on."""


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
    """The element that an opening is cut out of, or None."""
    found = getattr(opening, "VoidsElements", None) or ()
    return found[0].RelatingBuildingElement if found else None


def matters(opening: Any) -> bool:
    """Whether people may walk, or fall, through an opening."""
    kinds = [each.is_a() for each in fillings(opening) if each is not None]
    return host_of(opening) is not None and (not kinds or "IfcDoor" in kinds)


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


def said(element: Any, name: str, *kinds: type) -> Any:
    """A property of an element by its name, of the first set in which it is of one of some kinds;
    None if none has it."""
    for values in ifcopenshell.util.element.get_psets(element).values():
        if isinstance(values, dict) and type(values.get(name)) in kinds:
            return values[name]
    return None


def door_definitions(door: Any) -> Iterator[Any]:
    """Sets of properties of a door and of its type."""
    for relation in getattr(door, "IsDefinedBy", None) or ():
        if relation.is_a("IfcRelDefinesByProperties"):
            yield relation.RelatingPropertyDefinition
    kind = ifcopenshell.util.element.get_type(door)
    yield from (getattr(kind, "HasPropertySets", None) or ()) if kind is not None else ()


def text(value: Any) -> str:
    """A text of one line, not too long."""
    return " ".join(str(value or "").split())[:80]
