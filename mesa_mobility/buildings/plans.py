"""Floor plans of a building: all sheets in one plane, or one level by itself."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import shapely

from mesa_mobility.buildings.connections.flights import Flight
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.level import Level, sheet_of
from mesa_mobility.buildings.sheets import Sheet, seam_of, shaft_of, zones_of
from mesa_mobility.floorplan import Exit, FloorPlan


def plan_of_sheets(
    levels: Sequence[Level],
    flights: Sequence[Flight],
    lifts: Sequence[Lift],
    sheets: Mapping[str, Sheet],
    name: str,
) -> FloorPlan:
    """The plane in which people are simulated: levels and landings side by side.

    Args:
        levels: the levels.
        flights: the flights of all stairs, the ramps and the escalators.
        lifts: the lifts.
        sheets: levels and landings as drawn in the plane, by their names.
        name: of the building.

    Raises:
        FloorPlanError: see `FloorPlan`.
    """
    exits, gates, obstacles, zones = [], [], [], []
    for level in levels:
        sheet = sheets[sheet_of(level.number)]
        exits += [sheet.opening(each) for each in level.exits]
        gates += [sheet.opening(each) for each in level.gates]
        obstacles += [sheet.in_plane(each) for each in level.blocked]
        zones += [replace(zone, polygon=sheet.in_plane(zone.area)) for zone in level.zones]
    for flight in flights:
        zones += zones_of(flight, sheets)
    areas = [sheet.in_plane(sheet.area) for sheet in sheets.values()]
    parts = [part for area in areas for part in shapely.get_parts(area)]
    # Rooms of one name may be on several levels: the building has those, not the plane.
    rooms = levels[0].rooms if len(sheets) == 1 else ()
    return FloorPlan(
        parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts),
        exits=exits,
        gates=gates,
        obstacles=obstacles,
        zones=zones,
        name=name or (levels[0].name if len(levels) == 1 else ""),
        seams=[seam_of(flight, sheets) for flight in flights],
        shafts=[shaft_of(lift, sheets) for lift in lifts],
        rooms=[replace(each, level=0) for each in rooms],
    )


def plan_of_level(
    level: Level, sheet: Sheet, flights: Sequence[Flight], lifts: Sequence[Lift], name: str
) -> FloorPlan:
    """The floor of one level, in the building's coordinates; see `Building.floor_plan_of`.

    Args:
        level: the level.
        sheet: its sheet.
        flights: the flights of all stairs, the ramps and the escalators.
        lifts: the lifts.
        name: of the building, for a level without a name.
    """
    ends = [Exit(each.name, *each.head) for each in flights if each.upper == sheet.name]
    ends += [Exit(each.name, *each.foot) for each in flights if each.lower == sheet.name]
    ends += [Exit(each.name, *each.door) for each in lifts if level.number in each.numbers]
    floor = max(shapely.get_parts(sheet.floor), key=lambda part: part.area)
    return FloorPlan(
        floor,
        exits=[*level.exits, *ends],
        gates=level.gates,
        obstacles=level.obstacles,
        zones=level.zones,
        name=level.name or name,
        cut_off=True,
        rooms=[each for each in level.rooms if each.shape.intersection(floor).area > 0.0],
    )
