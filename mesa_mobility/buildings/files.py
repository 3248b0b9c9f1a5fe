"""Files that may hold a floor plan or a building."""

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.buildings.building import Building
from mesa_mobility.buildings.features import KINDS
from mesa_mobility.buildings.storeys import building_of
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.floor.checks import one_line
from mesa_mobility.floorplan.formats import geojson
from mesa_mobility.floorplan.formats.plan_format import PLANS
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.plugins.formats import READ

_SUFFIXES = ".geojson", ".json"


def read_floor(
    path: str | os.PathLike[str],
    exits: str | None = None,
    *,
    level: str | None = None,
    **options: Any,
) -> FloorPlan | Building:
    """The floor plan of a file, or the building if the file has several levels that are joined.

    Warns of what the reader has changed or left out.

    Args:
        path: of any format of floor plans.
        exits: of a file that has none, as ``FloorPlan.from_file`` takes them.
        level: number or name of the level to read alone, as a floor plan. People leave it by the
            ends of its stairs and the doors of its lifts, too.
        options: those of the format; a building in GeoJSON takes none.

    Raises:
        FloorPlanError: the file cannot be read, holds neither, or has no such level.
    """
    if Path(path).suffix.lower() in _SUFFIXES and not options:
        features = geojson.features_of(geojson.load(path), geojson.label(path))
        if any(_of_a_building(each) for each in features):
            if exits is not None:
                warnings.warn(f"{path}: --exits is ignored: it is a building", stacklevel=2)
            return _level_of(Building.from_geojson(path), level, path)
    chosen: Any = PLANS.of(path, READ)
    options = PLANS.chosen_options(chosen, READ, options)
    notes: list[str] = []
    # Outlines of other programs may be such that the geometry library gives up.
    with one_line(str(path)):
        found = chosen.read(Path(path), **options)
        if not isinstance(found, Storeys):
            return FloorPlan.of_content(found, str(path), exits, level)
        building = building_of(found, exits, str(path), notes)
    if building is None or (level is not None and not _has(building, level)):
        found.notes += notes if building is None else []
        return FloorPlan.of_content(found, str(path), exits, level)
    for note in notes:
        warnings.warn(f"{path}: {note}", stacklevel=2)
    return _level_of(building, level, path)


def _level_of(
    building: Building, level: str | None, path: str | os.PathLike[str]
) -> FloorPlan | Building:
    """One level of a building as a floor plan, if one is asked for."""
    if level is None:
        return building
    for each in building.levels:
        if level.strip() in (str(each.number), each.name):
            return building.floor_plan_of(each.number)
    known = ", ".join(str(each.number) for each in building.levels)
    raise FloorPlanError(f"{path}: has no level {level!r:.40}, expected one of {known}")


def _has(building: Building, level: str) -> bool:
    return any(level.strip() in (str(each.number), each.name) for each in building.levels)


def _of_a_building(feature: Any) -> bool:
    properties = feature.get("properties") if isinstance(feature, Mapping) else None
    given = properties if isinstance(properties, Mapping) else {}
    return given.get("kind") in KINDS or ("kind" in given and given.get("level", 0) != 0)
