"""A room: a named area of a floor, with its use and its doors."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_polygon

ROOM = "room"
"""The kind of a feature that is a room."""

LONGEST = 200
"""Characters of a name or a use."""


@dataclass(frozen=True)
class Room:
    """A named area of a floor.

    Args:
        name: unique among the rooms of a plan.
        polygon: shapely or WKT, metres; in a building in the building's coordinates.
        level: number of its level; 0 on a floor plan.
        use: what it is used for, such as "office", for `model.fill`.
        doors: names of the gates and exits that lead into it. Plans set it themselves.

    Raises:
        FloorPlanError: no polygon, no name, or a use that is no text.
    """

    name: str
    polygon: Polygon | str
    level: int = 0
    use: str = ""
    doors: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not 0 < len(self.name) <= LONGEST:
            raise FloorPlanError(
                f"room: expected a name of 1 to {LONGEST} letters, found {self.name!r:.60}"
            )
        if not isinstance(self.use, str) or len(self.use) > LONGEST:
            raise FloorPlanError(
                f"room {self.name!r}: use must be a text of {LONGEST} letters at most, found "
                f"{self.use!r:.60}"
            )
        if not isinstance(self.level, int) or isinstance(self.level, bool):
            raise FloorPlanError(
                f"room {self.name!r}: level must be a whole number, found {self.level!r:.60}"
            )
        object.__setattr__(self, "polygon", read_polygon(self.polygon, f"room {self.name!r}"))
        object.__setattr__(self, "doors", tuple(self.doors))

    @property
    def shape(self) -> Polygon:
        """The polygon as a shapely geometry."""
        assert isinstance(self.polygon, Polygon)
        return self.polygon

    @property
    def area(self) -> float:
        """Square metres, furniture included."""
        return self.shape.area

    def __str__(self) -> str:
        return f"{self.name} ({self.area:.2f} m\u00b2{', ' * bool(self.use)}{self.use})"


def rooms_named_apart(named: Iterable[tuple[str, Polygon]]) -> list[Room]:
    """Rooms of names that may be there several times; these are numbered from 2 on."""
    rooms: dict[str, Room] = {}
    for name, area in named:
        number, found = 1, name[:LONGEST]
        while found in rooms:
            number += 1
            found = f"{name[: LONGEST - 10]} {number}"
        rooms[found] = Room(found, area)
    return list(rooms.values())


def check_rooms(rooms: Iterable[Room], walkable: Polygon) -> tuple[Room, ...]:
    """The rooms, if they are ``Room`` objects of different names that cover some of the floor.

    Raises:
        FloorPlanError: they are not.
    """
    checked: dict[str, Room] = {}
    for each in rooms:
        if not isinstance(each, Room):
            raise FloorPlanError(f"rooms must be Room objects, found {type(each).__name__}")
        if each.name in checked:
            raise FloorPlanError(f"room {each.name!r} is there twice, expected names that differ")
        if not each.shape.intersection(walkable).area > 0.0:
            raise FloorPlanError(f"room {each.name!r} has no floor in it")
        checked[each.name] = each
    return tuple(checked.values())
