"""Files that may hold a floor plan or a building."""

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesa_mobility.buildings.building import Building
from mesa_mobility.buildings.features import KINDS
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.formats import geojson

_SUFFIXES = ".geojson", ".json"


def read_floor(
    path: str | os.PathLike[str], exits: str | None = None, **options: Any
) -> FloorPlan | Building:
    """The floor plan of a file, or the building if the file has levels.

    Args:
        path: of any format of floor plans. Only GeoJSON has levels.
        exits: of a floor plan whose file has none, as ``FloorPlan.from_file`` takes them.
        options: those of the format; a building takes none.

    Raises:
        FloorPlanError: the file cannot be read, or holds neither.
    """
    if Path(path).suffix.lower() in _SUFFIXES and not options:
        features = geojson.features_of(geojson.load(path), geojson.label(path))
        if any(_of_a_building(each) for each in features):
            if exits is not None:
                warnings.warn(f"{path}: --exits is ignored: it is a building", stacklevel=2)
            return Building.from_geojson(path)
    return FloorPlan.from_file(path, exits=exits, **options)


def _of_a_building(feature: Any) -> bool:
    properties = feature.get("properties") if isinstance(feature, Mapping) else None
    given = properties if isinstance(properties, Mapping) else {}
    return given.get("kind") in KINDS or ("kind" in given and given.get("level", 0) != 0)
