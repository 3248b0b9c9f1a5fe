"""Rooms: named areas of a floor, of which one wants to know when they are empty."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain, count
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.errors import FloorPlanError, ResultsError
from mesa_mobility.floorplan import FloorPlan, Room
from mesa_mobility.floorplan.floor.room import OF_ROOMS, ROOM
from mesa_mobility.results.engineering.doors import figures_of_times
from mesa_mobility.results.measures.storeys import last_there, where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building


def rooms_of(plan: FloorPlan | Building) -> list[Room]:
    """The named areas that a floor plan or a building has itself: rooms, speed zones and refuges.

    Zones without a name are left out. Areas of one name are a room each, numbered from 2 on.
    """
    areas = list(plan.rooms)
    if isinstance(plan, FloorPlan):
        areas += [Room(each.name, each.area) for each in plan.zones if each.name]
    else:
        for level in plan.levels:
            named = [(each.name, each.area) for each in level.zones if each.name]
            named += [(each.name, each.shape) for each in level.refuges]
            areas += [Room(name, area, level.number) for name, area in named]
    rooms: dict[str, Room] = {}
    for each in areas:
        names = chain([each.name], (f"{each.name} {n}" for n in count(2)))
        free = next(name for name in names if name not in rooms)
        rooms[free] = replace(each, name=free)
    return list(rooms.values())


def read_rooms(source: str | os.PathLike[str] | Mapping[str, Any]) -> list[Room]:
    """Read rooms from a GeoJSON file, or from the FeatureCollection itself.

    Each feature is a Polygon with the properties ``kind``, "room", its ``name``, perhaps its
    ``use`` and ``stated_area`` and, in buildings, the number of its ``level``.

    Raises:
        FloorPlanError: no such file, or a feature that is no room; the message names both.
    """
    from mesa_mobility.buildings.features import geometry_of, whole
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
        given = {each: properties[each] for each in OF_ROOMS if each in properties}
        try:
            rooms.append(Room(properties.get("name", ""), area, level, **given))
        except FloorPlanError as error:
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
    times, x, y = {}, trajectories.x, trajectories.y
    for each in checked:
        shapely.prepare(each.shape)
        x0, y0, x1, y1 = each.shape.bounds
        rows = inside & (level == each.level)
        # Most rows are in other rooms, and these comparisons take a tenth of the time.
        rows &= (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
        rows[rows] = shapely.intersects_xy(each.shape, x[rows], y[rows])
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
