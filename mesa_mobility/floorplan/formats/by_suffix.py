"""Floor plans from files, by the ends of their names."""

import os
from pathlib import Path

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats import dxf, geojson, wkt
from mesa_mobility.floorplan.formats.content import Content

READERS = {".geojson": geojson.read, ".json": geojson.read, ".wkt": wkt.read, ".dxf": dxf.read}
"""What reads a file, by the end of its name."""


def read(path: "str | os.PathLike[str]") -> Content:
    """Read a floor plan from a file.

    Raises:
        FloorPlanError: an unknown kind of file, or one that is no floor plan.
        MobilityError: a DXF, and ezdxf is not installed.
    """
    reader = READERS.get(Path(path).suffix.lower())
    if reader is None:
        raise FloorPlanError(f"{path}: expected a name that ends in {', '.join(READERS)}")
    return reader(path)
