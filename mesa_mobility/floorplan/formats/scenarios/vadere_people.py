"""People of Vadere's scenarios: sources, and people who are there from the start."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from shapely import Point
from shapely.geometry.base import BaseGeometry

from mesa_mobility.distributions import Constant, Distribution, Normal
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.assembling.values import list_of, mapping_of, number_of
from mesa_mobility.floorplan.formats.people import (
    MOST,
    People,
    Stop,
    checked,
    count_of,
    total_of,
)

DEFAULTS = {
    "speedDistributionMean": 1.34,
    "speedDistributionStandardDeviation": 0.26,
    "minimumSpeed": 0.5,
    "maximumSpeed": 2.2,
}
"""Speeds of Vadere's people, m/s, where a scenario says nothing."""

SAID = 20
"""Targets that a message names."""

Shapes = Mapping[int, tuple[BaseGeometry, str, float]]
"""Shape of each target by its number, its name if people leave there, and seconds of waiting."""


def people_of(
    topography: Mapping[str, Any],
    areas: Sequence[BaseGeometry],
    targets: Shapes,
    at: str,
    notes: list[str],
) -> list[People]:
    """The people of a scenario.

    Args:
        topography: of the scenario.
        areas: of its sources, in their order.
        targets: its targets.
        at: what messages call it.
        notes: takes what is left out.

    Raises:
        FloorPlanError: something in it is none.
    """
    speeds = mapping_of(topography.get("attributesPedestrian"), f"{at}: attributesPedestrian")
    speed = _speed(speeds, at)
    found: list[People] = []
    missing: set[str] = set()
    total = 0
    sources = list_of(topography.get("sources"), f"{at}: sources")
    for number, (each, area) in enumerate(zip(sources, areas, strict=True), start=1):
        where = f"{at}: source {number}"
        source = mapping_of(each, where)
        times = _times(mapping_of(source.get("spawner", source), f"{where}: spawner"), where, notes)
        total = total_of(total, len(times), where)
        stops, exits = _ways(source, targets, where, missing)
        first = [time for time in times if time <= 0]
        later = tuple(time for time in times if time > 0)
        name = f"source {number}"
        if first:
            found.append(People(name, area, len(first), speed=speed, stops=stops, exits=exits))
        if later:
            found.append(
                People(f"{name} later", area, len(later), later, speed, stops=stops, exits=exits)
            )
    others = 0
    elements = list_of(topography.get("dynamicElements"), f"{at}: dynamicElements")
    total_of(total, len(elements), f"{at}: dynamicElements")
    for number, each in enumerate(elements, start=1):
        where = f"{at}: person {number}"
        element = mapping_of(each, where)
        if element.get("type", "PEDESTRIAN") != "PEDESTRIAN":
            others += 1
            continue
        place = mapping_of(element.get("position"), f"{where}: position")
        x, y = (number_of(place.get(key), f"{where}: position") for key in ("x", "y"))
        own = number_of(element.get("freeFlowSpeed"), f"{where}: freeFlowSpeed", 0.0)
        stops, exits = _ways(element, targets, where, missing)
        pace = checked(Constant, where, own) if 0.05 <= own <= 5 else speed
        spots = ((x, y),)
        found.append(
            People(
                f"person {number}",
                Point(x, y),
                1,
                speed=pace,
                stops=stops,
                exits=exits,
                spots=spots,
            )
        )
    if missing:
        said = ", ".join(sorted(missing)[:SAID]) + (", ..." if len(missing) > SAID else "")
        notes.append(f"there is no target {said}, to which people are to go")
    if others:
        notes.append(f"left out {others} dynamicElements that are no pedestrians")
    return found


def _speed(given: Mapping[str, Any], at: str) -> Distribution:
    mean, deviation, low, high = (
        number_of(given.get(name), f"{at}: {name}", default) for name, default in DEFAULTS.items()
    )
    low, high = max(low, 0.05), min(max(high, 0.05), 5.0)
    if deviation > 0 and low < high:
        return checked(Normal, f"{at}: speeds", mean, deviation, low, high)
    return checked(Constant, f"{at}: speeds", float(np.clip(mean, low, max(low, high))))


def _times(spawner: Mapping[str, Any], at: str, notes: list[str]) -> list[float]:
    """Seconds at which people come, one for each."""
    start, end = (
        number_of(_first(spawner, names), f"{at}: {names[0]}", 0.0)
        for names in (("constraintsTimeStart", "startTime"), ("constraintsTimeEnd", "endTime"))
    )
    count = count_of(_first(spawner, ("eventElementCount", "spawnNumber"), 1), at)
    most = number_of(_first(spawner, ("constraintsElementsMax", "maxSpawnNumberTotal")), at, -1.0)
    given = spawner.get("distribution")
    own = mapping_of(given, at) if isinstance(given, Mapping) else {}
    every = number_of(own.get("updateFrequency"), f"{at}: updateFrequency", 1.0)
    if end > start and "updateFrequency" not in own:
        kind = str(own.get("type", given)).rpartition(".")[2]
        notes.append(f"{at.rpartition(': ')[2]}: times are {kind:.60}, taken as every {every:g} s")
    if not (0 <= start <= 1e6 and end <= 1e6 and every > 0):
        raise FloorPlanError(f"{at}: people come from {start:g} to {end:g} s every {every:g} s")
    events = int(max(end - start, 0.0) / every + 1e-9) + 1
    total = events * count if most < 0 else min(events * count, int(most))
    if total > MOST:
        raise FloorPlanError(f"{at}: {total:,} people, expected at most {MOST:,}")
    return [start + every * (k // max(count, 1)) for k in range(total)]


def _first(given: Mapping[str, Any], names: Sequence[str], default: Any = None) -> Any:
    """The value of the first name that is there: names have changed from version to version."""
    return next((given[name] for name in names if given.get(name) is not None), default)


def _ways(
    element: Mapping[str, Any], targets: Shapes, at: str, missing: set[str]
) -> tuple[tuple[Stop, ...], tuple[str, ...] | None]:
    """Targets that people visit, and the one by which they leave; ``missing`` takes others."""
    stops: list[Stop] = []
    for key in list_of(element.get("targetIds"), f"{at}: targetIds")[:MOST]:
        found = targets.get(key) if isinstance(key, int) else None
        if found is None:
            missing.add(f"{key!r:.20}")
            continue
        area, name, wait = found
        if name:
            return tuple(stops), (name,)
        stops.append(Stop(area, wait))
    return tuple(stops), None
