"""A room: a named area of a floor, with its use and its doors."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import read_polygon

ROOM = "room"
"""The kind of a feature that is a room."""

OF_ROOMS = "use", "stated_area"
"""Properties of such a feature, besides its name, and fields of ``Room``."""

LONGEST = 200
"""Characters of a name or a use."""

MOST_AREA = 1e8
"""Square metres of a room."""

NEAR = 0.01
"""Share by which the area of a room and its stated area differ where both are named."""


@dataclass(frozen=True)
class Room:
    """A named area of a floor.

    Args:
        name: unique among the rooms of a plan.
        polygon: shapely or WKT, metres; in a building in the building's coordinates.
        level: number of its level; 0 on a floor plan.
        use: what it is used for, such as "office", for `model.fill`.
        doors: names of the gates and exits that lead into it. Plans set it themselves.
        stated_area: square metres that the file of a plan gives for it, which may include parts of
            its walls. Occupant loads of gross areas use it.

    Raises:
        FloorPlanError: no polygon, no name, a use that is no text, or no stated area above 0.
    """

    name: str
    polygon: Polygon | str
    level: int = 0
    use: str = ""
    doors: tuple[str, ...] = ()
    stated_area: float | None = None

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
        stated = self.stated_area
        if stated is not None and not (is_number(stated) and 0.0 < stated <= MOST_AREA):
            raise FloorPlanError(
                f"room {self.name!r}: stated_area must be a number of square metres above 0, found "
                f"{stated!r:.60}"
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
        """Square metres of its polygon, furniture included."""
        return self.shape.area

    @property
    def gross_area(self) -> float:
        """Square metres as the file of a plan gives them; the area where it gives none."""
        return self.stated_area or self.area

    def __str__(self) -> str:
        size = f"{self.area:.2f} m\u00b2"
        if abs(self.gross_area - self.area) > NEAR * self.area:
            size += f", stated {self.gross_area:.2f} m\u00b2"
        return f"{self.name} ({size}{', ' * bool(self.use)}{self.use})"


def rooms_named_apart(named: Iterable[tuple[str, Polygon, float | None]]) -> list[Room]:
    """Rooms of names, areas and stated areas. Names that are there again are numbered from 2 on."""
    rooms: dict[str, Room] = {}
    for name, area, stated in named:
        number, found = 1, name[:LONGEST]
        while found in rooms:
            number += 1
            found = f"{name[: LONGEST - 10]} {number}"
        rooms[found] = Room(found, area, stated_area=stated)
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
