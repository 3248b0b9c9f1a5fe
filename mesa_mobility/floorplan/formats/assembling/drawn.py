"""Drawings of other programs, put together to the parts of a floor plan."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import shapely
from shapely import Polygon

from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.floor.room import rooms_named_apart
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut, placed
from mesa_mobility.floorplan.formats.assembling.given_exits import exits_for
from mesa_mobility.floorplan.formats.assembling.parts import MOST_NOTES, Area, joined, reachable
from mesa_mobility.floorplan.formats.content import Content


@dataclass
class Drawn:
    """The parts of a drawing, before they are put together; metres.

    Attributes:
        areas: parts of the floor.
        obstacles: what nobody walks on.
        ways_out: areas and lines by which people leave.
        gates: lines that people cross.
        zones: areas where people walk more slowly.
        rooms: areas with their names; none if rooms are to be found between gates.
        name: of the plan.
        notes: what was found and left out, a line each.
    """

    areas: list[Area] = field(default_factory=list)
    obstacles: list[Polygon] = field(default_factory=list)
    ways_out: list[WayOut] = field(default_factory=list)
    gates: list[Gate] = field(default_factory=list)
    zones: list[SpeedZone] = field(default_factory=list)
    rooms: list[Area] = field(default_factory=list)
    name: str = ""
    notes: list[str] = field(default_factory=list)


def assembled(drawn: Drawn, where: str) -> Content:
    """The parts of a floor plan from what a file shows.

    Args:
        drawn: what it shows.
        where: name of the source in an error message.

    Raises:
        FloorPlanError: there is no floor.
    """
    notes = list(drawn.notes)
    floor = joined(drawn.areas, where, notes)
    obstacles = [each for each in drawn.obstacles if each.intersects(floor)]
    floor, exits = placed(floor, obstacles, drawn.ways_out, notes)
    room = floor.buffer(0.01)
    gates = [each for each in drawn.gates if room.covers(each.line)]
    return Content(
        floor,
        name=drawn.name,
        exits=exits,
        gates=gates,
        obstacles=obstacles,
        zones=[each for each in drawn.zones if room.covers(each.area)],
        rooms=rooms_named_apart(
            (name, area, None) for area, name in drawn.rooms if area.intersection(floor).area > 0.0
        ),
        notes=notes,
        foreign=True,
    )


def completed(content: Content, exits: str | None) -> Content:
    """A file's content with the exits that a user gives, and without floor that reaches none.

    Args:
        content: of a file. If it has exits, those given are ignored, and a note says so.
        exits: see ``exits_for``; or None.

    Raises:
        FloorPlanError: exits that cannot be placed.
    """
    if exits is not None and content.exits:
        count = len(content.exits)
        content.notes.append(
            f"--exits is ignored: the file has {count} exit{'s' if count > 1 else ''}"
        )
    elif exits is not None:
        content.exits = exits_for(exits, content.walkable, content.obstacles, content.notes)
    if content.foreign and content.exits:
        _leave_out(content, content.exits)
    return content


def _leave_out(content: Content, exits: Sequence[Exit]) -> None:
    """Make obstacles of the floor from which no exit is reached."""
    _, left = reachable(content.walkable, content.obstacles, [each.line for each in exits])
    content.obstacles += left
    rooms = [piece for piece in left if not piece.buffer(-0.1).is_empty]
    for piece in rooms[:MOST_NOTES]:
        spot = shapely.point_on_surface(piece)
        content.notes.append(
            f"left out {piece.area:.2f} m² around ({spot.x:.2f}, {spot.y:.2f}): no way leads from "
            "there to an exit"
        )
    if len(rooms) > MOST_NOTES:
        content.notes.append(f"left out {len(rooms) - MOST_NOTES} further pieces without a way out")
