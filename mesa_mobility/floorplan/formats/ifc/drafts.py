"""The floor of each storey of a building model: rooms without walls, and passages through these."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.formats.ifc.records import Element, Model, Storey
from mesa_mobility.floorplan.formats.storeys import numbered

STANDS = 0.3
"""Metres above a floor above which a wall must reach to be in the way."""

HEAD = 1.8
"""Metres above a floor below which a wall, or an opening, must begin."""

OFF = 0.5
"""Metres by which a slab, or the sill of an opening, may lie off the height of a floor."""

LEAST_ROOM = 0.5
"""Square metres; smaller rooms are shafts."""

LEAST_VOID = 0.3
"""Square metres; smaller openings in a slab are for pipes."""

GRID = 1e-4
"""Metres; corners lie on this grid."""

OUTSIDE = ("EXTERNAL", "PARKING")
"""Types of rooms that are outside of the building."""


@dataclass
class Draft:
    """A storey while its floor is put together; metres.

    Attributes:
        storey: of the file.
        number: its level.
        elevation: of its floor.
        rooms: its rooms.
        walls: what stands on it.
        voids: holes in it.
        passages: floor in walls, where there are doors.
        exits: outer doors.
        gates: inner doors.
        notes: what was left out.
    """

    storey: Storey
    number: int
    elevation: float
    rooms: list[Element]
    walls: BaseGeometry
    voids: BaseGeometry
    passages: list[BaseGeometry] = field(default_factory=list)
    exits: list[Exit] = field(default_factory=list)
    gates: list[Gate] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @cached_property
    def open(self) -> BaseGeometry:
        """The rooms without walls and holes."""
        rooms = shapely.union_all([each.area for each in self.rooms], grid_size=GRID)
        solid = shapely.union_all([self.walls, self.voids], grid_size=GRID)
        return shapely.difference(rooms, solid, grid_size=GRID)

    @cached_property
    def hull(self) -> BaseGeometry:
        """All that is inside of the building, courtyards included."""
        whole = shapely.union_all([*(each.area for each in self.rooms), self.walls])
        closed = whole.buffer(0.3, join_style="mitre").buffer(-0.3, join_style="mitre")
        shells = [
            shapely.Polygon(part.exterior)
            for part in shapely.get_parts(closed)
            if part.geom_type == "Polygon"
        ]
        return shapely.union_all(shells)

    def floor(self) -> BaseGeometry:
        """Where people walk."""
        return shapely.union_all([self.open, *self.passages], grid_size=GRID)


def drafts_of(model: Model, notes: list[str]) -> list[Draft]:
    """The storeys that have a floor, from the lowest, without doors yet.

    Where no storey has rooms, slabs are the floor.
    """
    rooms = [
        each
        for each in model.of("room")
        if each.area.area >= LEAST_ROOM and each.type.upper() not in OUTSIDE
    ]
    if not rooms:
        rooms = _slabs(model)
        if rooms:
            notes.append("the file has no rooms: floors are the slabs without walls")
    by_storey = _by_storey(rooms, model.storeys)
    found = [each for each in model.storeys if by_storey.get(each.key)]
    without = [each.name or str(each.key) for each in model.storeys if each not in found]
    if without:
        notes.append(f"left out the storeys {', '.join(without)[:200]}: they have no rooms")
    drafts = []
    heights = [_elevation(by_storey[each.key]) for each in found]
    order = np.argsort(heights, kind="stable").tolist()
    numbers = numbered([heights[k] for k in order]) if order else []
    for number, k in zip(numbers, order, strict=True):
        storey, own, height = found[k], by_storey[found[k].key], heights[k]
        draft = Draft(storey, number, height, own, _walls(model, height), _voids(model, height))
        uneven = [each for each in own if abs(each.bottom - height) > STANDS]
        if uneven:
            draft.notes.append(
                f"{len(uneven)} rooms lie up to "
                f"{max(abs(each.bottom - height) for each in uneven):.2f} m above or below the "
                f"floor at {height:.2f} m: taken to be level with it"
            )
        drafts.append(draft)
    return drafts


def _slabs(model: Model) -> list[Element]:
    """Slabs on which people walk."""
    return [
        each
        for each in model.of("slab")
        if each.area.area >= LEAST_ROOM and each.type.upper() not in ("ROOF", "LANDING")
    ]


def _by_storey(rooms: Sequence[Element], storeys: Sequence[Storey]) -> dict[int, list[Element]]:
    """Rooms by the number of their storey; those without one are at the nearest height."""
    known = {each.key for each in storeys}
    found: dict[int, list[Element]] = {}
    for room in rooms:
        key = room.storey
        if key not in known and storeys:
            key = min(storeys, key=lambda each: abs(each.elevation - room.bottom)).key
        if key is not None:
            found.setdefault(key, []).append(room)
    return found


def _elevation(rooms: Sequence[Element]) -> float:
    """The height on which most of the area of rooms lies; that of a slab is its upper side."""
    heights = np.array([each.top if each.kind == "slab" else each.bottom for each in rooms])
    order = np.argsort(heights)
    reached = np.cumsum([rooms[k].area.area for k in order.tolist()])
    return round(float(heights[order[np.searchsorted(reached, reached[-1] / 2)]]), 3)


def _walls(model: Model, height: float) -> BaseGeometry:
    return shapely.union_all(
        [
            each.area
            for each in model.of("wall", "furniture")
            if each.bottom < height + HEAD and each.top > height + STANDS
        ],
        grid_size=GRID,
    )


def _voids(model: Model, height: float) -> BaseGeometry:
    return shapely.union_all(
        [
            each.area
            for each in model.of("opening")
            if each.in_slab
            and each.area.area >= LEAST_VOID
            and each.bottom - OFF < height < each.top + OFF
        ],
        grid_size=GRID,
    )
