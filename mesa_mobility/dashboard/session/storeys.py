"""Storeys of a building as the canvas draws them: its sheets, and a section through all."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
import shapely

from mesa_mobility.animation.floor import drawn_opening
from mesa_mobility.buildings import Building
from mesa_mobility.buildings.level import sheet_of
from mesa_mobility.floorplan import Exit, FloorPlan, Gate

FAR = 1e9
"""Metres: beyond all sheets."""

Opening: TypeAlias = Exit | Gate

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


def own_openings(plan: FloorPlan, building: Building | None) -> tuple[Opening, ...]:
    """The gates and exits of a plan without those of stairs and lifts."""
    joints = {} if building is None else building.gates
    names = {gate.name for gates in joints.values() for gate in gates}
    return tuple(each for each in plan.openings() if each.name not in names)


def drawn_joints(building: Building) -> list[dict[str, Any]]:
    """Stairs, ramps, escalators and lifts as openings with their own names and kinds.

    Each has a line on every sheet from which it leads, and is open if all of its gates are.
    """
    plan = building.floor_plan
    lines = {gate.name for seam in plan.seams for gate in seam.ends}
    lines |= {gate.name for shaft in plan.shafts for gate in shaft.gates}
    kinds = {each.name: each.kind for each in building.stairs}
    found = []
    for name, gates in building.gates.items():
        named = {"name": name, "kind": kinds.get(name, "lift")}
        is_open = all(plan.is_open(gate.name) for gate in gates)
        found += [{**drawn_opening(gate, is_open), **named} for gate in gates if gate.name in lines]
    return found
