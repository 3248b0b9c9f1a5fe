"""A level of a building: its floor in true coordinates."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from shapely import Polygon

from mesa_mobility._numbers import is_number
from mesa_mobility.buildings.refuge import Refuge
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, Gate, Room, SpeedZone
from mesa_mobility.floorplan.floor.checks import read_polygon
from mesa_mobility.floorplan.floor.room import check_rooms

MOST_LEVEL = 1_000
"""Greatest number of a level, above ground or below."""

HIGHEST = 10_000.0
"""Greatest elevation of a level, metres, above or below the origin."""


@dataclass(frozen=True)
class Level:
    """A level of a building.

    Coordinates are those of the building. Names of exits and gates are unique in the building.

    Args:
        number: its number, as on the buttons of a lift: 0 is mostly the ground floor.
        walkable: one connected polygon, holes allowed; shapely or WKT, metres.
        elevation: height of the floor, metres.
        exits: lines on the edge of the walkable area by which people leave the building.
        gates: doors, and other lines to cross, inside the walkable area.
        obstacles: polygons (shapely or WKT) to subtract.
        zones: parts of the floor where people walk more slowly.
        refuges: parts of the floor in which people who cannot leave wait.
        rooms: named areas of the floor; by default they are found between the gates.
        name: for titles and files.

    Raises:
        FloorPlanError: a number that is not whole, an elevation that is not finite, a refuge that
            is not on the walkable area, or what `FloorPlan` refuses of the walkable area, the
            obstacles and the rooms.
    """

    number: int
    walkable: Polygon | str
    elevation: float = 0.0
    exits: Sequence[Exit] = ()
    gates: Sequence[Gate] = ()
    obstacles: Sequence[Polygon | str] = ()
    zones: Sequence[SpeedZone] = ()
    name: str = ""
    refuges: Sequence[Refuge] = ()
    rooms: Sequence[Room] = ()

    def __post_init__(self) -> None:
        number = self.number
        if not isinstance(number, int) or isinstance(number, bool) or abs(number) > MOST_LEVEL:
            raise FloorPlanError(
                f"level {number!r:.60}: expected a whole number, {MOST_LEVEL} at most"
            )
        if not is_number(self.elevation) or not abs(self.elevation) <= HIGHEST:
            raise FloorPlanError(
                f"level {number}: elevation must be metres, {HIGHEST:g} at most, "
                f"found {self.elevation!r:.60}"
            )
        where = f"level {number}: "
        values = {
            "elevation": float(self.elevation),
            "walkable": read_polygon(self.walkable, where + "walkable area"),
            "obstacles": tuple(
                read_polygon(each, f"{where}obstacle {k}") for k, each in enumerate(self.obstacles)
            ),
            **{name: self._listed(name) for name in ("exits", "gates", "zones", "refuges")},
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        try:
            rooms = check_rooms(self._listed("rooms"), self.area)
        except FloorPlanError as error:
            raise FloorPlanError(f"{where}{error}") from None
        object.__setattr__(self, "rooms", tuple(replace(each, level=number) for each in rooms))
        for refuge in self.refuges:
            if not isinstance(refuge, Refuge):
                raise FloorPlanError(
                    f"{where}refuges must be Refuge objects, found {type(refuge).__name__}"
                )
            if not self.area.buffer(1e-6).covers(refuge.shape):
                spot = refuge.shape.difference(self.area).representative_point()
                raise FloorPlanError(
                    f"{where}refuge {refuge.name!r} leaves the walkable area at "
                    f"({spot.x:.2f}, {spot.y:.2f})"
                )

    def _listed(self, name: str) -> tuple[Any, ...]:
        given = getattr(self, name)
        if not isinstance(given, Iterable):
            raise FloorPlanError(
                f"level {self.number}: {name} must be a list, found {type(given).__name__}"
            )
        return tuple(given)

    @property
    def area(self) -> Polygon:
        """The walkable polygon as a shapely geometry."""
        assert isinstance(self.walkable, Polygon)
        return self.walkable

    @property
    def blocked(self) -> tuple[Polygon, ...]:
        """The obstacles as shapely geometries."""
        return tuple(each for each in self.obstacles if isinstance(each, Polygon))


def number_of(level: Level | int) -> int:
    """The number of a level that is given as such, or by its number."""
    return level.number if isinstance(level, Level) else level


def sheet_of(level: int) -> str:
    """Name of the sheet of a level."""
    return f"level {level}"
