"""Archives of the Indoor Mapping Data Format: a zip or a folder with a GeoJSON of each type."""

from pathlib import Path
from typing import Annotated, Any

from mesa_mobility.floorplan.formats.assembling.archives import members, names_in
from mesa_mobility.floorplan.formats.assembling.texts import parsed
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.geojson import features_of
from mesa_mobility.floorplan.formats.indoor.rooms import HEIGHT, read_rooms
from mesa_mobility.floorplan.formats.indoor.shapes import name_of
from mesa_mobility.floorplan.formats.plan_format import PlanFormat
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.plugins.annotations import Range

NEEDED, OTHERS = ("level.geojson", "unit.geojson"), ("opening", "fixture", "kiosk", "venue")
"""Files that an archive must have, and types of features of others that are read."""


class Imdf(PlanFormat):
    """IMDF archive, zip or folder: levels, units, openings, stairs and lifts of a venue."""

    name = "imdf"
    suffixes = (".zip",)

    def takes(self, path: Path) -> bool:
        """Whether an archive or a folder has one of the files that are needed."""
        return bool(set(NEEDED) & set(names_in(path)))

    def read(
        self, path: Path, *, height: Annotated[float, Range(1.5, 20)] = HEIGHT
    ) -> Content | Storeys:
        """Read all levels, ``height`` metres apart; see ``read_rooms``.

        Raises:
            FloorPlanError: the archive cannot be read, or has no levels or units.
        """
        texts = members(path, NEEDED, [f"{each}.geojson" for each in OTHERS])
        features: list[Any] = []
        name = ""
        for file, text in texts.items():
            kind, at = file.partition(".")[0], f"{path}: {file}"
            own = features_of(parsed(text, at), at)
            # The type of a feature may be left out where the file has it.
            features += [
                {**each, "feature_type": kind} if isinstance(each, dict) else each for each in own
            ]
            if kind == "venue" and own and isinstance(own[0], dict):
                properties = own[0].get("properties")
                name = name_of(properties.get("name")) if isinstance(properties, dict) else ""
        return read_rooms(features, str(path), height, name)
