"""Floor plans as text: one part a line, its geometry as WKT, coordinates in metres."""

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import shapely

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_wkt
from mesa_mobility.floorplan.formats.assembling.texts import LARGEST_FILE, read_text
from mesa_mobility.floorplan.formats.bare_wkt import is_bare, read_bare
from mesa_mobility.floorplan.formats.content import KINDS, Content, content_of
from mesa_mobility.floorplan.formats.plan_format import PlanFormat

_PART = re.compile(
    r"(?P<kind>\w+)\s+(?P<words>.*?)\s*(?P<wkt>(?:MULTI)?(?:POLYGON|LINESTRING)\b.*)", re.IGNORECASE
)
_PROPERTY = re.compile(r"(?P<name>\w+)=(?P<value>\S+)$")


class Wkt(PlanFormat):
    """Text: a line for each part, its geometry as WKT in metres; or geometries of floor alone."""

    name = "wkt"
    suffixes = (".wkt",)

    def read(self, path: Path) -> Content:
        """Read a floor plan; see the function ``read`` of this module."""
        return read(path)

    def has_people(self, path: Path) -> bool:
        """Whether it has sources."""
        return bool(read(path).people)


def read(path: "str | os.PathLike[str]") -> Content:
    """Read a text with a line such as ``exit street LINESTRING (20 3, 20 5)`` for each part.

    Between the kind and the geometry stand the part's name and properties, as ``closed=true`` or
    ``factor=0.5``.  Empty lines and those that begin with ``#`` count for nothing.  In a text that
    begins with a geometry, all polygons are floor.

    Raises:
        FloorPlanError: the file cannot be read, or a line is no part of a floor plan; the message
            names file and line.
    """
    text = read_text(path, LARGEST_FILE, "lines of WKT")
    if is_bare(text):
        return read_bare(text, str(path))
    return content_of(_features(text, str(path)), str(path))


def _features(text: str, where: str) -> Iterator[tuple[dict[str, Any], str]]:
    for number, line in enumerate(text.splitlines(), start=1):
        line = line.strip()
        if line and not line.startswith("#"):
            at = f"{where}: line {number}"
            yield _feature(line, at), at


def _feature(line: str, at: str) -> dict[str, Any]:
    part = _PART.fullmatch(line)
    if part is None:
        raise FloorPlanError(
            f"{at}: {line[:40]!a}, expected one of {', '.join(KINDS)}, a name and a POLYGON "
            "or LINESTRING"
        )
    kind, words = part["kind"].lower(), part["words"].split()
    properties: dict[str, Any] = {}
    while words and (found := _PROPERTY.match(words[-1])):
        words.pop()
        properties[found["name"]] = _value(found["value"])
    geometry = read_wkt(part["wkt"], f"{at}: {kind}", "POLYGON or LINESTRING")
    return {
        "properties": {**properties, "kind": kind, "name": " ".join(words)},
        "geometry": shapely.geometry.mapping(geometry),
    }


def _value(text: str) -> Any:
    """A number, true or false; a text where it is none of these, which is refused later."""
    try:
        return json.loads(text)
    except ValueError:
        return text
