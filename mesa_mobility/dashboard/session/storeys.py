"""Storeys of a building as the canvas draws them: its sheets, and a section through all."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import shapely

from mesa_mobility.buildings import Building
from mesa_mobility.buildings.level import sheet_of

FAR = 1e9
"""Metres: beyond all sheets."""

_OF_FLIGHTS = ("width", "going", "top", "bottom", "riser", "tread", "risers")


def storeys(building: Building) -> dict[str, Any]:
    """Sheets and flights, as JSON takes them.

    ``sheets`` are in the order of the plane. Each has a ``name``, whether it is a level
    (``level``), its ``bounds`` in the plane, the true bounds of its ``floor`` without flights, the
    x of the plane from which (``left``) to which (``right``) it is nearest, the ``shift`` from true
    places to the plane, and the ``elevation``.
    ``bounds`` are those of the building. ``flights`` have true places, and the numbers of their
    ``upper`` and ``lower`` sheets. All lengths are in metres.
    """
    sheets = building.sheets
    drawn = [sheet.in_plane(sheet.area).bounds for sheet in sheets]
    between = [(one[2] + other[0]) / 2.0 for one, other in pairwise(drawn)]
    number = {sheet.name: k for k, sheet in enumerate(sheets)}
    names = {sheet_of(level.number): level.name for level in building.levels if level.name}
    lefts, rights = [-FAR, *between], [*between, FAR]
    return {
        "bounds": shapely.total_bounds([sheet.area for sheet in sheets]).tolist(),
        "sheets": [
            {
                "name": names.get(sheet.name, sheet.name),
                "level": sheet.level is not None,
                "bounds": list(bounds),
                "floor": list(sheet.floor.bounds),
                "left": left,
                "right": right,
                "shift": list(sheet.shift),
                "elevation": sheet.elevation,
            }
            for sheet, bounds, left, right in zip(sheets, drawn, lefts, rights, strict=True)
        ],
        "flights": [
            {
                "head": np.mean(flight.head, axis=0).tolist(),
                "down": flight.down.tolist(),
                "upper": number[flight.upper],
                "lower": number[flight.lower],
                **{name: getattr(flight, name) for name in _OF_FLIGHTS},
            }
            for flight in building.flights
        ],
    }
