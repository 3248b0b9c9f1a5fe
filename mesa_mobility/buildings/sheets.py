"""Sheets: the levels and landings of a building, each with its stairs and lifts."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.buildings.connections.flights import Flight, Landing
from mesa_mobility.buildings.connections.lift import DOORWAY, Lift
from mesa_mobility.buildings.connections.lines import moved, pair, right_angle
from mesa_mobility.buildings.level import Level, sheet_of
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import WALKS, Belt, Exit, Gate, Seam, Shaft, SpeedZone, Stop

BEYOND = 0.3
"""Metres by which a strip goes on beyond its flight, on the sheet to which that half is copied."""

APART = 20.0
"""Least metres between sheets in the plane: nobody acts on others so far away."""

_WALL = 0.05
"""Metres that are taken from the floor beside and behind a strip."""

_INTO = 0.01
"""Metres by which a strip overlaps the floor from which it leads, so that the two are one."""

_GRID = 1e-9
"""Vertices are put on this grid, metres: of edges that nearly coincide, GEOS may otherwise give a
wrong intersection."""

_FREE = 0.5
"""Metres of floor that must be free before either end of a flight."""

_FREE_BEFORE_LIFT = 1.5
"""The same before the door of a lift: room for a wheelchair to turn (ISO 21542)."""

_LEAST_SHARED = 1e-6
"""Square metres that two areas share if they overlap."""

Opening = TypeVar("Opening", Exit, Gate)


@dataclass(frozen=True)
class Sheet:
    """A level or a landing, with the strips of the flights that end there.

    Attributes:
        name: unique in the building.
        level: number of the level; None for a landing.
        elevation: of its floor, metres.
        floor: the floor without strips, in the building's coordinates.
        area: the floor and the strips, in the building's coordinates.
        shift: (dx, dy) in metres from the building's coordinates to the plane.
    """

    name: str
    level: int | None
    elevation: float
    floor: BaseGeometry
    area: BaseGeometry
    shift: tuple[float, float] = (0.0, 0.0)

    def in_plane(self, geometry: BaseGeometry) -> BaseGeometry:
        """A geometry in the building's coordinates as drawn in the plane."""
        if self.shift == (0.0, 0.0):
            return geometry
        moved: BaseGeometry = shapely.transform(geometry, lambda xy: xy + self.shift)
        return moved

    def opening(self, opening: Opening) -> Opening:
        """An exit or gate as drawn in the plane."""
        (ax, ay), (bx, by), (dx, dy) = opening.a, opening.b, self.shift
        return replace(opening, a=(ax + dx, ay + dy), b=(bx + dx, by + dy))


def sheets_of(
    levels: Sequence[Level],
    flights: Sequence[Flight],
    landings: Sequence[Landing],
    lifts: Sequence[Lift] = (),
) -> dict[str, Sheet]:
    """The sheets of a building by name, side by side in the plane in the order given.

    The first level keeps its coordinates.

    Raises:
        FloorPlanError: a flight or a lift without floor before it, or over an obstacle, an opening
            or a refuge, or two that overlap, as well as refuges that do.
    """
    sheets = []
    for level in levels:
        own = _strips(sheet_of(level.number), flights, lifts)
        _check_level(level, own)
        own += _shafts_past(level, levels, lifts)
        sheets.append(
            _sheet(sheet_of(level.number), level.number, level.elevation, level.area, own)
        )
    for landing in landings:
        own = _strips(landing.name, flights)
        sheets.append(_sheet(landing.name, None, landing.elevation, landing.area, own))
    placed: dict[str, Sheet] = {}
    end = -np.inf
    for sheet in sheets:
        least, _, most, _ = sheet.area.bounds
        # Whole metres keep most coordinates exact.
        shift = 0.0 if not placed else float(np.ceil(end + APART - least))
        placed[sheet.name] = replace(sheet, shift=(shift, 0.0))
        end = most + shift
    return placed


def seam_of(flight: Flight, sheets: Mapping[str, Sheet]) -> Seam:
    """The seam of a flight: at its middle, from the lower sheet to the upper one."""
    lower, upper = (np.array(sheets[name].shift) for name in (flight.lower, flight.upper))
    left, right = (np.array(end) + flight.going / 2.0 * flight.down for end in flight.head)
    # A route counts the same both ways: the mean of up and down.
    belt, factor = None, 2.0 / (1.0 / flight.factor + 1.0 / flight.uphill)
    if flight.moves:
        belt = Belt(-flight.moves, flight.going, flight.gap_s)
        factor = abs(flight.moves) / WALKS
    return Seam(
        flight.name,
        tuple((right + lower).tolist()),
        tuple((left + lower).tolist()),
        tuple((upper - lower).tolist()),
        flight.going / 2.0 + BEYOND,
        extra=flight.going * (1.0 / factor - 1.0),
        stepless=flight.risers == 0,
        belt=belt,
        before=BEYOND,
    )


def zones_of(flight: Flight, sheets: Mapping[str, Sheet]) -> list[SpeedZone]:
    """The zones in which people walk as on a flight, on both its sheets; none for its factor 1."""
    if flight.factor == 1.0:
        return []
    area = flight.part(0.0, flight.going)
    names = dict.fromkeys((flight.lower, flight.upper))
    return [
        SpeedZone(
            sheets[name].in_plane(area),
            flight.factor,
            f"{flight.name} on {name}",
            uphill=flight.uphill,
            downhill=pair(flight.down),
            tread=flight.tread,
        )
        for name in names
    ]


def shaft_of(lift: Lift, sheets: Mapping[str, Sheet]) -> Shaft:
    """A lift as drawn in the plane."""
    own = [sheets[sheet_of(number)] for number in lift.numbers]
    shifts = [0.5 * DOORWAY * right_angle(lift.door) + each.shift for each in own]
    return Shaft(
        name=lift.name,
        stops=tuple(
            Stop(each.name, moved(lift.door, shift), each.elevation)
            for each, shift in zip(own, shifts, strict=True)
        ),
        before=0.5 * DOORWAY,
        width=lift.width,
        depth=lift.depth,
        capacity=lift.capacity,
        speed=lift.speed,
        door_s=lift.door_s,
        everybody=lift.everybody,
    )


@dataclass(frozen=True)
class _Strip:
    """A flight or the car of a lift as drawn on a sheet.

    Attributes:
        what: what it is, for messages.
        drawn: its floor.
        taken: what is taken from the floor of the sheet for it.
        before: the floor that must be free before it.
    """

    what: str
    drawn: BaseGeometry
    taken: Polygon
    before: Polygon


def _strips(sheet: str, flights: Sequence[Flight], lifts: Sequence[Lift] = ()) -> list[_Strip]:
    found = []
    for flight in flights:
        going, what = flight.going, f"{flight.what} {flight.name!r}"
        if flight.upper == sheet:
            found.append(
                _Strip(
                    what,
                    flight.part(-_INTO, going + BEYOND),
                    flight.part(0.0, going + BEYOND + _WALL, _WALL),
                    flight.part(-_FREE, 0.0),
                )
            )
        if flight.lower == sheet:
            found.append(
                _Strip(
                    what,
                    flight.part(-BEYOND, going + _INTO),
                    flight.part(-BEYOND - _WALL, going, _WALL),
                    flight.part(going, going + _FREE),
                )
            )
    for lift in lifts:
        if sheet in map(sheet_of, lift.numbers):
            door = math.dist(*lift.door) / 2.0
            doorway = lift.part(-_INTO, DOORWAY + _INTO, door)
            found.append(
                _Strip(
                    f"lift {lift.name!r}",
                    shapely.union(doorway, lift.car, grid_size=_GRID),
                    _shaft(lift),
                    lift.part(-_FREE_BEFORE_LIFT, 0.0, door),
                )
            )
    return found


def _shafts_past(level: Level, levels: Sequence[Level], lifts: Sequence[Lift]) -> list[_Strip]:
    """The shafts of the lifts that pass a level and do not stop there: no floor is drawn there."""
    heights = {each.number: each.elevation for each in levels}
    found = []
    for lift in lifts:
        stops = [heights[number] for number in lift.numbers]
        if min(stops) < level.elevation < max(stops) and level.number not in lift.numbers:
            taken, nothing = _shaft(lift), Polygon()
            found.append(_Strip(f"lift {lift.name!r}", nothing, taken, nothing))
    return found


def _shaft(lift: Lift) -> Polygon:
    """What is taken from a floor for the car of a lift and its doorway."""
    return lift.part(0.0, DOORWAY + lift.depth + _WALL, lift.width / 2.0 + _WALL)


def _sheet(
    name: str, level: int | None, elevation: float, area: Polygon, strips: Sequence[_Strip]
) -> Sheet:
    if not strips:
        return Sheet(name, level, elevation, area, area)
    for k, one in enumerate(strips):
        for other in strips[:k]:
            at = _shared(one.taken, other.taken)
            if at:
                raise FloorPlanError(
                    f"{other.what} and {one.what} overlap on the plan of {name} at {at}"
                )
    taken = shapely.union_all([each.taken for each in strips], grid_size=_GRID)
    floor = _polygons(shapely.difference(area, taken, grid_size=_GRID))
    drawn = [each.drawn for each in strips]
    whole = _polygons(shapely.union_all([floor, *drawn], grid_size=_GRID))
    return Sheet(name, level, elevation, floor, whole)


def _shared(one: BaseGeometry, other: BaseGeometry) -> str | None:
    """A place at which two areas overlap, for messages; None if they do not."""
    shared = shapely.intersection(one, other, grid_size=_GRID)
    if shared.area <= _LEAST_SHARED:
        return None
    spot = shared.representative_point()
    return f"({spot.x:.2f}, {spot.y:.2f})"


def _polygons(area: BaseGeometry) -> BaseGeometry:
    """An area without lines: on the grid, a spike that is narrower becomes one."""
    parts = [part for part in shapely.get_parts(area) if isinstance(part, Polygon)]
    return parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts)


def _check_level(level: Level, strips: Sequence[_Strip]) -> None:
    """Raise FloorPlanError without floor before stairs and lifts, or with something on them, or for
    refuges that overlap."""
    for k, one in enumerate(level.refuges):
        for other in level.refuges[:k]:
            at = _shared(one.shape, other.shape)
            if at:
                raise FloorPlanError(
                    f"level {level.number}: refuges {other.name!r} and {one.name!r} overlap at {at}"
                )
    obstacles = {f"obstacle {k}": each for k, each in enumerate(level.blocked)}
    openings = {f"{each.kind} {each.name!r}": each.line for each in (*level.exits, *level.gates)}
    free = shapely.difference(
        level.area, shapely.union_all(list(obstacles.values())), grid_size=_GRID
    )
    free = free.buffer(1e-6)
    for strip in strips:
        where = f"{strip.what} on level {level.number}"
        for what, shape in (*obstacles.items(), *openings.items()):
            if strip.taken.buffer(-1e-6).intersects(shape):
                spot = strip.taken.intersection(shape).representative_point()
                raise FloorPlanError(
                    f"{where}: {what} is in their way at ({spot.x:.2f}, {spot.y:.2f})"
                )
        for refuge in level.refuges:
            # A refuge may reach as far as the wall of a shaft.
            inner = strip.taken.buffer(-_WALL, join_style="mitre")
            shared = shapely.intersection(inner, refuge.shape, grid_size=_GRID)
            if shared.area > _LEAST_SHARED:
                spot = shared.representative_point()
                raise FloorPlanError(
                    f"{where}: refuge {refuge.name!r} is in their way at "
                    f"({spot.x:.2f}, {spot.y:.2f})"
                )
        others = [each.taken for each in strips if each is not strip]
        left = shapely.difference(free, shapely.union_all(others), grid_size=_GRID)
        missing = shapely.difference(strip.before, left, grid_size=_GRID)
        if missing.area > 1e-6:
            spot = missing.representative_point()
            raise FloorPlanError(
                f"{where}: no floor at ({spot.x:.2f}, {spot.y:.2f}), expected {_FREE} m of free "
                f"floor before stairs and ramps, and {_FREE_BEFORE_LIFT:g} m before lifts"
            )
