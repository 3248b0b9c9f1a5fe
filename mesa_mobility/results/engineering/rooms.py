"""Rooms: named areas of a floor, of which one wants to know when they are empty."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.floor.checks import read_polygon
from mesa_mobility.results.engineering.doors import figures_of_times
from mesa_mobility.results.measures.storeys import last_there, where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building

ROOM = "room"
"""The kind of a feature that is a room."""


@dataclass(frozen=True)
class Room:
    """A named area of a floor.

    Args:
        name: unique among the rooms of a run.
        area: shapely or WKT, metres; in a building in the building's coordinates.
        level: number of its level; 0 on a floor plan.

    Raises:
        FloorPlanError: no polygon.
        ResultsError: no name.
    """

    name: str
    area: shapely.Polygon | str
    level: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise ResultsError(f"room: expected a name of at least one letter, found {self.name!r}")
        object.__setattr__(self, "area", read_polygon(self.area, f"room {self.name!r}"))

    @property
    def shape(self) -> shapely.Polygon:
        """The area as a shapely geometry."""
        assert isinstance(self.area, shapely.Polygon)
        return self.area


def rooms_of(plan: FloorPlan | Building) -> list[Room]:
    """The named areas that a floor plan or a building has itself: its speed zones and refuges.

    Zones without a name are left out. Zones of one name are a room each, numbered from 2 on.
    """
    named: list[tuple[str, shapely.Polygon, int]] = []
    if isinstance(plan, FloorPlan):
        named += [(each.name, each.area, 0) for each in plan.zones]
    else:
        for level in plan.levels:
            named += [(each.name, each.area, level.number) for each in level.zones]
            named += [(each.name, each.shape, level.number) for each in level.refuges]
    rooms: dict[str, Room] = {}
    for name, area, number in named:
        if name:
            names = chain([name], (f"{name} {n}" for n in count(2)))
            free = next(each for each in names if each not in rooms)
            rooms[free] = Room(free, area, number)
    return list(rooms.values())


def read_rooms(source: str | os.PathLike[str] | Mapping[str, Any]) -> list[Room]:
    """Read rooms from a GeoJSON file, or from the FeatureCollection itself.

    Each feature is a Polygon with the properties ``kind``, "room", its ``name`` and, in buildings,
    the number of its ``level``.

    Raises:
        FloorPlanError: no such file, or a feature that is no room; the message names both.
    """
    from mesa_mobility.buildings.features import geometry_of, whole
    from mesa_mobility.errors import FloorPlanError
    from mesa_mobility.floorplan.formats import geojson

    at = geojson.label(source)
    rooms = []
    for number, feature in enumerate(geojson.features_of(geojson.load(source), at)):
        here = f"{at}: feature {number}"
        properties = feature.get("properties") if isinstance(feature, Mapping) else None
        if not isinstance(properties, Mapping) or properties.get("kind") != ROOM:
            raise FloorPlanError(f"{here}: expected a Feature with the property kind {ROOM!r}")
        area: Any = geometry_of(feature, "Polygon", ROOM, here)
        level = whole(properties, "level", here, 0)
        try:
            rooms.append(Room(properties.get("name", ""), area, level))
        except (FloorPlanError, ResultsError) as error:
            raise FloorPlanError(f"{here}: {error}") from None
    return rooms


def check_rooms(rooms: Iterable[Room], plan: FloorPlan | Building) -> list[Room]:
    """The rooms, if they are on the plan.

    Raises:
        ResultsError: a name that is used twice, a level that the plan does not have, or a room
            without any floor in it.
    """
    levels = (
        {0: plan.walkable}
        if isinstance(plan, FloorPlan)
        else {each.number: each.area for each in plan.levels}
    )
    checked: dict[str, Room] = {}
    for each in rooms:
        if each.name in checked:
            raise ResultsError(f"room {each.name!r} is there twice, expected names that differ")
        if each.level not in levels:
            known = ", ".join(map(str, levels))
            raise ResultsError(
                f"room {each.name!r}: no level {each.level}, expected one of {known}"
            )
        if not each.shape.intersection(levels[each.level]).area > 0.0:
            raise ResultsError(f"room {each.name!r} has no floor in it")
        checked[each.name] = each
    return list(checked.values())


def room_times(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room]
) -> dict[str, NDArray[np.float64]]:
    """When each person last left each room, (m,) seconds by its name.

    As `leaving_times` has it for levels: infinite for people who are there when the run ends, nan
    for those who never were. People on the edge of a room are in it.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        rooms: the rooms.

    Raises:
        ResultsError: rooms that are not on the plan; in a building, tracks without elevations.
    """
    checked = check_rooms(rooms, plan)
    if not checked:
        return {}
    inside = trajectories.exit_frames[trajectories.person] != trajectories.frame
    level = np.zeros(len(trajectories), dtype=np.int16)
    if not isinstance(plan, FloorPlan):
        level = where(trajectories, plan).level
    times = {}
    for each in checked:
        shapely.prepare(each.shape)
        rows = inside & (level == each.level)
        rows[rows] = shapely.intersects_xy(each.shape, trajectories.x[rows], trajectories.y[rows])
        times[each.name] = last_there(trajectories, rows)
    return times


def room_figures(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room]
) -> dict[str, dict[str, Any]]:
    """Figures of each room, ready for JSON, by its name.

    Returns:
        ``people`` who were ever there; ``first_s`` and ``last_s``, when the first and the last of
        them left it for good, the last None if anybody is there when the run ends; ``flow_per_s``,
        the flow of these departures, as `doors` has it.

    Arguments and errors as for `room_times`.
    """
    return {
        name: figures_of_times(times[~np.isnan(times)])
        for name, times in room_times(trajectories, plan, rooms).items()
    }
