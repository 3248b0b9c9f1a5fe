"""Doors and openings of a storey: passages through its walls, gates, and exits."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.formats.assembling.boxes import Box, box_around
from mesa_mobility.floorplan.formats.ifc.drafts import HEAD, OFF, Draft
from mesa_mobility.floorplan.formats.ifc.records import Element, Model

INTO = 0.02
"""Metres by which a passage reaches into a room."""

REACH = 0.5
"""Metres from a wall within which a room has a door in it."""

THICKEST = 1.5
"""Metres; no wall is thicker."""

NARROWEST = 0.3
"""Metres; nobody walks through an opening that is narrower."""

LOWEST = 1.5
"""Metres from the floor to the top of an opening through which people walk."""

ABOVE = 1.0
"""Metres above the ground above which an outer door leads to no exit."""


@dataclass(frozen=True)
class Doorway:
    """An opening in a wall; metres.

    Attributes:
        name: for messages, gates and exits.
        centre: (2,) its middle.
        along: (2,) direction of the wall, of length 1.
        width: clear width.
        ends: of the wall, measured from ``centre`` at a right angle to it.
        is_door: whether a door is in it.
        external: whether it says that it leads outside.
    """

    name: str
    centre: NDArray[np.float64]
    along: NDArray[np.float64]
    width: float
    ends: tuple[float, float]
    is_door: bool
    external: bool | None

    @property
    def across(self) -> NDArray[np.float64]:
        """(2,) direction through the wall."""
        return np.array([-self.along[1], self.along[0]])

    def line(self, at: float) -> LineString:
        """The line through the opening ``at`` metres from its middle."""
        middle, half = self.centre + at * self.across, self.width / 2 * self.along
        return LineString([middle - half, middle + half])

    def between(self, first: float, last: float) -> Polygon:
        """The part between two distances from its middle."""
        one, other = (shapely.get_coordinates(self.line(at)) for at in (first, last))
        return Polygon([*one, *other[::-1]])


def add_doors(draft: Draft, model: Model, ground: float, taken: set[str]) -> None:
    """Put passages, gates and exits of a storey into its draft.

    Args:
        draft: the storey.
        model: the building.
        ground: height of the ground, metres.
        taken: names of gates and exits that are in use; takes new ones.
    """
    astray, high = 0, []
    for way in _doorways(draft, model):
        before, behind = (_rooms_behind(way, draft, sign) for sign in (-1, 1))
        if before is not None and behind is not None:
            draft.passages.append(way.between(before - INTO, behind + INTO))
            if way.is_door:
                (ax, ay), (bx, by) = shapely.get_coordinates(way.line(0.0)).tolist()
                draft.gates.append(Gate(_unique(way.name, taken), (ax, ay), (bx, by)))
        elif before is None and behind is None:
            astray += way.is_door
        elif way.is_door:
            sign = 1 if behind is None else -1
            outer, inner = way.ends[sign > 0], before if behind is None else behind
            assert inner is not None
            spot = shapely.Point(way.centre + (outer + sign * 0.3) * way.across)
            if not way.external and draft.hull.contains(spot):
                astray += 1
            elif draft.elevation > ground + ABOVE:
                high.append(way.name)
            else:
                draft.passages.append(way.between(*sorted((outer, inner - sign * INTO))))
                (ax, ay), (bx, by) = shapely.get_coordinates(way.line(outer)).tolist()
                draft.exits.append(Exit(_unique(way.name, taken), (ax, ay), (bx, by)))
    if astray:
        draft.notes.append(f"left out {astray} doors that have no room on one side of them")
    if high:
        draft.notes.append(
            f"{', '.join(high)[:120]}: no exit, since it leads out "
            f"{draft.elevation - ground:.1f} m above the ground"
        )


def _doorways(draft: Draft, model: Model) -> list[Doorway]:
    """The openings through which people walk on a storey."""
    doors = {each.key: each for each in model.of("door")}
    hosts = {each.key: each for each in model.of("wall")}
    found = []
    for opening in model.of("opening"):
        if not opening.in_slab and opening.area.area > 0 and _at(opening, draft.elevation):
            door = doors.get(opening.door) if opening.door is not None else None
            host = hosts.get(opening.host) if opening.host is not None else None
            found.append(_doorway(opening, door, host, draft.walls))
    for door in doors.values():  # those in no opening have a body of their own
        if door.area.area > 0 and _at(door, draft.elevation):
            found.append(_doorway(door, door, None, draft.walls))
    return [each for each in found if each is not None and each.width >= NARROWEST]


def _at(opening: Element, height: float) -> bool:
    """Whether people on a floor walk through an opening."""
    return -HEAD < opening.bottom - height < OFF and opening.top > height + LOWEST


def _doorway(
    opening: Element, door: Element | None, host: Element | None, walls: BaseGeometry
) -> Doorway | None:
    box = box_around(opening.area)
    if box is None:
        return None
    axis = _axis(host, box, None if door is None else door.width)
    along, centre = box.along[axis], box.centre
    width, depth = float(box.lengths[axis]), float(box.lengths[1 - axis])
    ends = _wall_at(walls, centre, along, depth)
    name = _name_of(door) if door is not None else f"opening {opening.key}"
    external = None if door is None else door.external
    clear = min(_clear(door, width), width)
    return Doorway(name, centre, along, clear, ends, door is not None, external)


def _axis(host: Element | None, box: Box, width: float | None) -> int:
    """The side of an opening that lies along the wall: that along a long wall, or that as wide as
    the door, or the longer one."""
    wall = None if host is None else box_around(host.area)
    if wall is not None and wall.lengths.max() > 3 * wall.lengths.min():
        return int(np.argmax(np.abs(box.along @ wall.along[int(np.argmax(wall.lengths))])))
    if width is not None:
        return int(np.argmin(np.abs(box.lengths - width)))
    return int(np.argmax(box.lengths))


def _wall_at(
    walls: BaseGeometry, centre: NDArray[np.float64], along: NDArray[np.float64], depth: float
) -> tuple[float, float]:
    """Where the wall begins and ends at the middle of an opening, measured from there."""
    across = np.array([-along[1], along[0]])
    probe = LineString([centre - THICKEST * across, centre + THICKEST * across])
    for part in shapely.get_parts(walls.intersection(probe)):
        at = np.sort((shapely.get_coordinates(part) - centre) @ across)
        reaches = part.length > 0 and at[0] <= depth / 2 and at[-1] >= -depth / 2
        if reaches and at[-1] - at[0] < THICKEST:
            return float(at[0]), float(at[-1])
    return -depth / 2, depth / 2


def _rooms_behind(way: Doorway, draft: Draft, sign: int) -> float | None:
    """How far from the middle a room begins on one side; None if there is none."""
    face = way.ends[sign > 0]
    strip = way.between(*sorted((face - sign * INTO, face + sign * REACH)))
    part = draft.open.intersection(strip)
    if part.area < way.width * INTO:
        return None
    at = (shapely.get_coordinates(part) - way.centre) @ way.across
    return float(sign * (sign * at).min())


def _clear(door: Element | None, width: float) -> float:
    """The clear width of a door: what it says, or its width without its lining."""
    if door is None:
        return width
    if door.clear and door.clear >= NARROWEST:
        return door.clear
    whole = door.width or width
    without = whole - 2 * (door.lining or 0.0)
    return without if without >= whole / 2 else whole


def _name_of(door: Element) -> str:
    """A door's name; of names as FAMILY:TYPE:NUMBER the number."""
    parts = door.name.split(":")
    return f"door {parts[-1]}" if len(parts) > 1 else door.name or f"door {door.key}"


def _unique(name: str, taken: set[str]) -> str:
    number, found = 1, name
    while found in taken:
        number += 1
        found = f"{name} ({number})"
    taken.add(found)
    return found
