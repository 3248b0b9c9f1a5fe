"""A format of floor plans: drawings in SVG, whose shapes say by their class what they are."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated
from xml.etree import ElementTree

from shapely import Polygon, union_all

from mesa_mobility import Exit, Gate, Range, Room
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Content, PlanFormat

LARGEST = 20_000_000  # bytes


class Svg(PlanFormat):
    """SVG: each `rect`, `polygon` and `line` of the class room, obstacle, gate or exit."""

    name = "svg"
    suffixes = (".svg",)

    def read(self, path: Path, *, unit: Annotated[float, Range(1e-6, 1e3, "m")] = 1.0) -> Content:
        """Read rooms, which make up the floor, and what stands in them. Names are their ids.

        Args:
            path: the file.
            unit: metres in a unit of the drawing, whose y grows downwards.

        Raises:
            FloorPlanError: the file cannot be read, or a shape is not as it should be.
        """
        found = Content(Polygon())
        for number, each in enumerate(_root(path).iter(), start=1):
            kind = each.get("class", "")
            name = each.get("id") or f"{kind} {number}"
            if each.get("transform"):
                raise FloorPlanError(f"{path}: {name} has a transform, expected plain coordinates")
            if kind not in ("room", "obstacle", "gate", "exit"):
                found.notes += [f"left out {name}: its class is {kind!r:.40}"] if kind else []
                continue
            points = [(unit * x, -unit * y) for x, y in _points(each, f"{path}: {name}")]
            if len(points) < (3 if kind in ("room", "obstacle") else 2):
                raise FloorPlanError(f"{path}: {name} has too few points for a {kind}")
            if kind == "exit":
                found.exits.append(Exit(name, points[0], points[1]))
            elif kind == "gate":
                found.gates.append(Gate(name, points[0], points[1]))
            elif kind == "room":
                found.rooms.append(Room(name, Polygon(points)))
            else:
                found.obstacles.append(Polygon(points))
        found.walkable = union_all([each.polygon for each in found.rooms])
        return found


def _root(path: Path) -> ElementTree.Element:
    try:
        if path.stat().st_size > LARGEST:
            raise ValueError(f"more than {LARGEST:,} bytes")
        return ElementTree.fromstring(path.read_bytes())
    except (OSError, ValueError, ElementTree.ParseError) as error:
        raise FloorPlanError(f"{path}: cannot be read as SVG ({error})") from None


def _points(shape: ElementTree.Element, at: str) -> list[tuple[float, float]]:
    try:
        if shape.tag.endswith("polygon"):
            numbers = [float(each) for each in re.findall(r"[^\s,]+", shape.get("points", ""))]
            return list(zip(numbers[::2], numbers[1::2], strict=True))
        if shape.tag.endswith("rect"):
            x, y, w, h = (float(shape.get(each, 0)) for each in ("x", "y", "width", "height"))
            return [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
        x, y, w, h = (float(shape.get(each, 0)) for each in ("x1", "y1", "x2", "y2"))
        return [(x, y), (w, h)]
    except ValueError as error:
        raise FloorPlanError(f"{at}: expected coordinates, found none ({error})") from None
