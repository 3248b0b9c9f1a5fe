"""Levels and stairs of a building, as three-dimensional views show them.

All but the lowest floors let one see through, so that lower storeys are visible.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.animation.floor import drawn_opening, drawn_refuge, rings
from mesa_mobility.animation.meshes import (
    FLOOR,
    Mesh,
    Surface,
    flat,
    joined,
    prism,
)
from mesa_mobility.animation.solids import Solid, drawn_solid, solid_surfaces, solids
from mesa_mobility.buildings.level import sheet_of
from mesa_mobility.buildings.places import height_on, place_on
from mesa_mobility.floorplan.floor.boundaries import boundary_segments, cut_out

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building, Flight, Landing, Level
    from mesa_mobility.floorplan.floor.openings import Opening

STEP, EXIT, DOOR, CLOSED, REFUGE = "#c9b79c", "#00795a", "#0072b2", "#b23c00", "#7fc9a0"

SEE_THROUGH = 0.4
"""Opacity of floors with others below them."""

_SLAB = 0.04
"""Metres by which a step reaches below the one beneath it, and thickness of a landing."""

_STRIPE, _LIFT = 0.12, 0.01
"""Half the width of the stripe that shows an opening, and its height above the floor, metres."""

_MARKING = 0.005
"""Height of the area that shows a refuge above the floor, metres."""


@dataclass(frozen=True)
class Storey:
    """A level as it is shown, without the walls beside stairs.

    Attributes:
        level: the level.
        floor: the floor without obstacles, with holes over the flights that lead down.
        walls: (m, 4) x0, y0, x1, y1, metres: the edge of the level and of obstacles without open
            exits.
        solids: walls and obstacles as they stand on the floor.
        openings: exits and gates, and whether each is open.
    """

    level: Level
    floor: shapely.Geometry
    walls: NDArray[np.float64]
    solids: list[Solid]
    openings: list[tuple[Opening, bool]]


def storeys_of(building: Building) -> list[Storey]:
    """The levels of a building, from the lowest up."""
    found, sheets = [], {sheet.name: sheet for sheet in building.sheets}
    obstacles = shapely.union_all(list(building.floor_plan.obstacles.values()))
    for level in sorted(building.levels, key=lambda each: each.elevation):
        name = sheet_of(level.number)
        shift = sheets[name].shift
        blocked = shapely.transform(obstacles, lambda xy, shift=shift: xy - shift)
        free = shapely.difference(level.area, blocked)
        holes = [each.part(0.0, each.going) for each in building.flights if each.upper == name]
        floor = shapely.difference(free, shapely.union_all(holes))
        is_open = building.floor_plan.is_open
        exits = [each for each in level.exits if is_open(each.name)]
        walls = cut_out(boundary_segments(free), exits)
        openings = [(each, is_open(each.name)) for each in (*level.exits, *level.gates)]
        stand = solids(level.area, free, [each.line for each in exits])
        found.append(Storey(level, floor, walls, stand, openings))
    return found


def storey_surfaces(building: Building, most_vertices: int | None = None) -> Iterator[Surface]:
    """Floor, walls, openings and refuges of each level, from the lowest up, then stairs.

    Args:
        building: what to show.
        most_vertices: of a mesh of walls; see ``scenery.surfaces``.
    """
    for above, storey in enumerate(storeys_of(building)):
        level, label = storey.level, f"level_{storey.level.number}".replace("-", "minus_")
        floor = flat(storey.floor, level.elevation)
        yield Surface(f"floor_{label}", *floor, FLOOR, True, SEE_THROUGH if above else 1.0)
        yield from solid_surfaces(f"_{label}", storey.solids, level.elevation, most_vertices)
        for number, (opening, is_open) in enumerate(storey.openings):
            colour = (EXIT if opening.kind == "exit" else DOOR) if is_open else CLOSED
            stripe = opening.line.buffer(_STRIPE, cap_style="flat")
            mesh = flat(stripe, level.elevation + _LIFT)
            yield Surface(f"opening_{label}_{number}", *mesh, colour, True)
        for number, refuge in enumerate(level.refuges):
            named = re.sub(r"\W", "_", refuge.name, flags=re.ASCII)
            mesh = flat(refuge.shape, level.elevation + _MARKING)
            yield Surface(f"refuge_{label}_{number}_{named}", *mesh, REFUGE, True)
    for number, flight in enumerate(building.flights):
        yield Surface(f"flight_{number}", *flight_mesh(flight), STEP, True)
    for number, landing in enumerate(building.landings):
        yield Surface(f"landing_{number}", *_landing_mesh(landing), STEP, True)


def drawn_building(building: Building) -> dict[str, Any]:
    """Levels and stairs, metres, as the browser draws them in three dimensions.

    ``storeys`` has a floor plan for each level, from the lowest up, and its ``elevation``.
    ``stairs`` has meshes of steps and landings. ``flights`` has what puts feet on treads.
    """
    parts = [(each.bottom, flight_mesh(each)) for each in building.flights]
    parts += [(each.elevation, _landing_mesh(each)) for each in building.landings]
    return {
        "bounds": shapely.total_bounds([level.area for level in building.levels]).tolist(),
        "storeys": [
            {
                "name": each.level.name or sheet_of(each.level.number),
                "elevation": each.level.elevation,
                "free": [rings(part) for part in shapely.get_parts(each.floor)],
                "walls": each.walls.tolist(),
                "solids": [drawn_solid(solid) for solid in each.solids],
                "openings": [drawn_opening(*opening) for opening in each.openings],
                "refuges": [drawn_refuge(refuge) for refuge in each.level.refuges],
            }
            for each in storeys_of(building)
        ],
        "stairs": [
            {
                "bottom": bottom,
                "vertices": np.round(vertices.astype(np.float64), 4).reshape(-1).tolist(),
                "normals": np.round(normals.astype(np.float64), 4).reshape(-1).tolist(),
                "triangles": triangles.reshape(-1).tolist(),
            }
            for bottom, (vertices, normals, triangles) in parts
        ],
        "flights": [
            {
                "head": np.mean(flight.head, axis=0).tolist(),
                "down": flight.down.tolist(),
                **{name: getattr(flight, name) for name in _OF_FLIGHTS},
            }
            for flight in building.flights
        ],
    }


_OF_FLIGHTS = ("width", "going", "top", "bottom", "risers", "riser", "tread")


def flight_mesh(flight: Flight) -> Mesh:
    """The steps of a flight as boxes, one for each tread, each a riser below the one above; the
    slab of a ramp."""
    if not flight.risers:
        ring = np.array(flight.part(0.0, flight.going).exterior.coords)
        vertices, normals, triangles = prism(ring, -_SLAB, _SLAB)
        down, _ = place_on(flight, vertices[:, :2].astype(np.float64))
        vertices[:, 2] += height_on(flight, down)
        return vertices, normals, triangles
    boxes = []
    for number in range(1, flight.risers):
        area = flight.part((number - 1) * flight.tread, number * flight.tread)
        height = flight.top - number * flight.riser
        high = min(flight.riser + _SLAB, height - flight.bottom)
        boxes.append(prism(np.array(area.exterior.coords), height - high, high))
    return joined(boxes)


def _landing_mesh(landing: Landing) -> Mesh:
    return prism(np.array(landing.area.exterior.coords), landing.elevation - _SLAB, _SLAB)
