"""Geometries in WKT without a word of what they are: all their polygons are floor."""

import re
from collections.abc import Iterator

import shapely

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_wkt
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.parts import polygons_of
from mesa_mobility.floorplan.formats.assembling.projection import as_metres
from mesa_mobility.floorplan.formats.content import Content

_TYPES = "POLYGON|LINESTRING|LINEARRING|POINT|GEOMETRYCOLLECTION"
_BEGIN = re.compile(rf"(?:SRID\s*=\s*(?P<srid>\d+)\s*;\s*)?(?:MULTI)?(?:{_TYPES})\b", re.IGNORECASE)
_COMMENT = re.compile(r"^[ \t]*#.*$", re.MULTILINE)
_COLLECTION = re.compile(r"GEOMETRYCOLLECTION\s*(?:ZM|Z|M)?\s*(?=\(|EMPTY)", re.IGNORECASE)

DEEPEST, MOST = 8, 10_000
"""Collections within each other, and geometries of a file."""

DEGREES = 4326
"""The SRID of longitude and latitude."""


def is_bare(text: str) -> bool:
    """Whether a text begins with a geometry rather than with what it is."""
    return _BEGIN.match(_COMMENT.sub("", text).lstrip()) is not None


def read_bare(text: str, where: str) -> Content:
    """The floor that all polygons of a text make together.

    Args:
        text: geometries, one after the other, each of which may span lines.
        where: name of the source in an error message.

    Raises:
        FloorPlanError: a geometry cannot be read, or there is no polygon.
    """
    return assembled(drawn_of(text, where), where)


def drawn_of(text: str, where: str) -> Drawn:
    """The parts of geometries, before they are put together; see ``read_bare``."""
    drawn, others = Drawn(), dict[str, int]()
    geometries = [
        (number, srid, part)
        for number, (srid, each) in enumerate(_geometries(text, where), start=1)
        for part in _flat(each, f"{where}: geometry {number}")
    ]
    whole = shapely.GeometryCollection([part for _, _, part in geometries])
    in_degrees = any(srid == DEGREES for _, srid, _ in geometries)
    for (number, _, _), part in zip(
        geometries, as_metres(whole, in_degrees, drawn.notes), strict=True
    ):
        areas = polygons_of(part, f"geometry {number}", drawn.notes)
        drawn.areas += areas
        if not areas and not part.is_empty:
            others[part.geom_type] = others.get(part.geom_type, 0) + 1
    for kind, count in others.items():
        drawn.notes.append(f"left out {count} {kind}: only polygons are floor")
    return drawn


def _geometries(text: str, where: str) -> Iterator[tuple[int, str]]:
    """SRID and text of each geometry."""
    rest = _COMMENT.sub("", text).strip()
    for _ in range(MOST):
        if not rest:
            return
        begin = _BEGIN.match(rest)
        if begin is None:
            raise FloorPlanError(f"{where}: {rest[:40]!a}, expected a geometry in WKT")
        end = _end(rest, begin.end())
        srid = begin["srid"]
        body = rest[:end].partition(";")[2] if srid else rest[:end]
        yield int(srid[:9]) if srid else 0, body.strip()
        rest = rest[end:].lstrip(" \t\r\n;,")
    raise FloorPlanError(f"{where}: more than {MOST:,} geometries, expected fewer")


def _end(text: str, start: int) -> int:
    """Where the geometry ends whose type's name ends at ``start``."""
    depth = 0
    for found in re.compile(r"[()]|\bEMPTY\b", re.IGNORECASE).finditer(text, start):
        depth += {"(": 1, ")": -1}.get(found[0], 0)
        if depth <= 0:
            return found.end()
    return len(text)


def _flat(text: str, at: str, depth: int = 0) -> Iterator[shapely.Geometry]:
    """The geometries of a text, those of collections one by one: GEOS ends the process where
    collections nest too deeply."""
    head = _COLLECTION.match(text)
    if head is None:
        yield read_wkt(text, at, "a geometry")
        return
    if depth >= DEEPEST:
        raise FloorPlanError(f"{at}: collections nest deeper than {DEEPEST}")
    rest = text[head.end() :].strip()
    if rest.upper() == "EMPTY":
        return
    if not rest.endswith(")"):
        raise FloorPlanError(f"{at}: the WKT cannot be read (a collection does not end)")
    rest = rest[1:-1].strip()
    while rest:
        end = _end(rest, 0)
        yield from _flat(rest[:end].strip(), at, depth + 1)
        rest = rest[end:].lstrip(" \t\r\n,")
