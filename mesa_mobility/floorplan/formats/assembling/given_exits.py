"""Exits that a user gives for a floor plan whose file has none."""

import re
from collections.abc import Sequence
from pathlib import Path

import shapely
from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.extent import check_coordinates
from mesa_mobility.floorplan.floor.openings import Exit
from mesa_mobility.floorplan.formats.assembling.edges import outer_edges
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut, placed
from mesa_mobility.floorplan.formats.assembling.parts import reachable
from mesa_mobility.floorplan.formats.assembling.texts import read_text

LONGEST = "longest"
"""The word for a door in the longest straight edge."""

DOOR = 1.2
"""Metres; width of that door."""

LARGEST_FILE, MOST = 1_000_000, 1000
"""Bytes of a file of exits, and the number of exits."""

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_LINE = re.compile(
    rf"\s*(?P<ax>{_NUMBER})\s+(?P<ay>{_NUMBER})\s*,\s*(?P<bx>{_NUMBER})\s+(?P<by>{_NUMBER})\s*"
)
_NAMED = re.compile(
    r"(?:exit\b)?(?P<name>.*?)(?:LINESTRING)?\s*\(?(?P<line>[-+.\d].*?)\)?\s*", re.I
)
_EXPECTED = "expected 'x1 y1, x2 y2' in metres"


def exits_for(
    text: str, walkable: Polygon, obstacles: Sequence[Polygon], notes: list[str]
) -> list[Exit]:
    """The exits that a text asks for.

    Args:
        text: ``longest``, a door of 1.2 m in the middle of the longest straight outer edge; lines
            ``x1 y1, x2 y2`` with semicolons between them; or the name of a file with such a line
            for each exit, after its name, if it has one.
        walkable: the floor.
        obstacles: on it.
        notes: takes what was moved to the edge.

    Raises:
        FloorPlanError: another text, a file that cannot be read, or a line that is not within 1.2 m
            of the edge.
    """
    if text.strip() == LONGEST:
        return [longest(walkable, obstacles)]
    lines = _lines(text)
    said: list[str] = []
    floor, exits = placed(walkable, obstacles, lines, said)
    assert floor is walkable
    for way in lines:
        if way.name not in [each.name for each in exits]:
            reason = next((note for note in said if f"exit {way.name!r}" in note), "")
            raise FloorPlanError(f"--exits: {reason.removeprefix('left out ')}")
    notes += said
    return exits


def longest(walkable: Polygon, obstacles: Sequence[Polygon]) -> Exit:
    """A door of 1.2 m in the middle of the longest straight outer edge with floor before it.

    An edge shorter than 1.2 m is the door as a whole.

    Raises:
        FloorPlanError: no edge has free floor before it.
    """
    free, _ = reachable(walkable, obstacles, ())
    for edge in sorted(outer_edges(walkable), key=lambda each: -each.length):
        middle = edge.length / 2
        half = min(DOOR / 2, middle)
        parts = edge.between(middle - half, middle + half).open_parts(free)
        if any(part.length > 1.98 * half for part in parts):
            door = edge.between(middle - half, middle + half)
            return Exit("door", tuple(door.a.tolist()), tuple(door.b.tolist()))
    raise FloorPlanError("--exits longest: no straight edge has free floor before its middle")


def _lines(text: str) -> list[WayOut]:
    if _LINE.fullmatch(text.split(";")[0]):
        where, texts = "--exit", text.split(";")
    else:
        where = text
        if not Path(text).is_file():
            raise FloorPlanError(
                f"--exits: got {text!r:.80}, expected longest, lines 'x1 y1, x2 y2' or a file "
                "of them"
            )
        texts = read_text(text, LARGEST_FILE, "lines of exits").splitlines()
    ways: list[WayOut] = []
    for number, each in enumerate(texts, start=1):
        if not each.strip() or each.lstrip().startswith("#"):
            continue
        named = _NAMED.fullmatch(each.strip())
        found = _LINE.fullmatch(named["line"]) if named else None
        at = where if where == "--exit" else f"{where}: line {number}"
        if named is None or found is None:
            raise FloorPlanError(f"{at}: got {each.strip()!r:.60}, {_EXPECTED}")
        ends = [(float(found["ax"]), float(found["ay"])), (float(found["bx"]), float(found["by"]))]
        check_coordinates(ends, at)
        name = named["name"].strip() or f"exit {len(ways) + 1}"
        if ends[0] == ends[1]:
            raise FloorPlanError(f"{at}: both ends are the same, {_EXPECTED}")
        if name in [way.name for way in ways]:
            raise FloorPlanError(f"{at}: exit {name!r} is given twice")
        ways.append(WayOut(name, shapely.LineString(ends)))
    if not ways or len(ways) > MOST:
        raise FloorPlanError(f"{where}: {len(ways)} exits, expected 1 to {MOST}")
    return ways
