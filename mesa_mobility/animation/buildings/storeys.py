"""Levels, stairs and lifts of a building, as three-dimensional views show them.

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

from mesa_mobility.animation.buildings.flights import flight_mesh, handrails, landing_mesh
from mesa_mobility.animation.buildings.shafts import holes, stretches
from mesa_mobility.animation.floor import drawn_opening, drawn_refuge, rings
from mesa_mobility.animation.meshes import FLOOR, Mesh, Surface, flat, groups, joined
from mesa_mobility.animation.solids import Solid, drawn_solid, solid_surfaces, solids
from mesa_mobility.buildings.level import sheet_of
from mesa_mobility.floorplan import Gate
from mesa_mobility.floorplan.floor.boundaries import boundary_segments, cut_out

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building, Level
    from mesa_mobility.floorplan.floor.openings import Opening

STEP, EXIT, DOOR, CLOSED, REFUGE = "#c9b79c", "#00795a", "#0072b2", "#b23c00", "#7fc9a0"

METAL, GLASS = "#5d6066", "#8fa9b8"
"""Colours of handrails and frames of shafts, and of the walls of shafts."""

SEE_THROUGH = 0.4
"""Opacity of floors with others below them."""

OF_SHAFTS = 0.25
"""Opacity of the walls of shafts."""

_STRIPE, _LIFT = 0.12, 0.01
"""Half the width of the stripe that shows an opening, and its height above the floor, metres."""

_MARKING = 0.005
"""Height of the area that shows a refuge above the floor, metres."""


@dataclass(frozen=True)
class Storey:
    """A level as it is shown, without the walls beside stairs.

    Attributes:
        level: the level.
        floor: the floor without obstacles, with holes over the flights that lead down
            and at the cars of lifts that come from below.
        walls: (m, 4) x0, y0, x1, y1, metres: the edge of the level and of obstacles without open
            exits, ends of flights and doors of lifts.
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
        cuts = [each.part(0.0, each.going) for each in building.flights if each.upper == name]
        cuts += holes(building, level.elevation)
        floor = shapely.difference(free, shapely.union_all(cuts))
        is_open = building.floor_plan.is_open
        exits = [each for each in level.exits if is_open(each.name)]
        ways = [*exits, *_ways_on(building, level)]
        walls = cut_out(boundary_segments(free), ways)
        openings = [(each, is_open(each.name)) for each in (*level.exits, *level.gates)]
        stand = solids(level.area, free, [each.line for each in ways])
        found.append(Storey(level, floor, walls, stand, openings))
    return found


def storey_surfaces(building: Building, most_vertices: int | None = None) -> Iterator[Surface]:
    """Floor, walls, openings and refuges of each level, from the lowest up, then stairs and lifts.

    Args:
        building: what to show.
        most_vertices: of a mesh of walls and rails; see ``scenery.surfaces``.
    """
    for above, storey in enumerate(storeys_of(building)):
        level, label = storey.level, _label(storey.level)
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
    for _, surface in fittings(building, most_vertices):
        yield surface


def fittings(
    building: Building, most_vertices: int | None = None
) -> Iterator[tuple[float, Surface]]:
    """Stairs, handrails and shafts of lifts, each with the elevation from which up it stands.

    Flights and landings have a mesh each. Handrails, walls of shafts and their frames have one for
    each storey.

    Args:
        building: what to show.
        most_vertices: of a mesh; all of a storey are in one mesh if None.
    """
    for number, flight in enumerate(building.flights):
        yield flight.bottom, Surface(f"flight_{number}", *flight_mesh(flight), STEP, True)
    for number, landing in enumerate(building.landings):
        mesh = landing_mesh(landing)
        yield landing.elevation, Surface(f"landing_{number}", *mesh, STEP, True)
    labels = {each.elevation: _label(each) for each in reversed(building.levels)}
    parts: dict[tuple[str, float], list[Mesh]] = {}
    for flight in building.flights:
        base = max(each for each in labels if each <= flight.bottom)
        parts.setdefault(("handrails", base), []).extend(handrails(flight))
    for stretch in stretches(building):
        parts.setdefault(("shaft_frames", stretch.low), []).append(stretch.frame)
        parts.setdefault(("shafts", stretch.low), []).append(stretch.walls)
    for (name, base), meshes in parts.items():
        colour, opacity = (GLASS, OF_SHAFTS) if name == "shafts" else (METAL, 1.0)
        for group in groups(meshes, most_vertices):
            mesh = joined(group)
            yield base, Surface(f"{name}_{labels[base]}", *mesh, colour, True, opacity)


def drawn_building(building: Building) -> dict[str, Any]:
    """Levels, stairs and lifts, metres, as the browser draws them in three dimensions.

    ``storeys`` has a floor plan for each level, from the lowest up, and its ``elevation``.
    ``fittings`` has meshes of stairs, handrails and shafts. ``flights`` has what puts feet on
    treads.
    """
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
        "fittings": [
            {
                "bottom": bottom,
                "colour": each.colour,
                "opacity": each.opacity,
                "vertices": np.round(each.vertices.astype(np.float64), 4).reshape(-1).tolist(),
                "normals": np.round(each.normals.astype(np.float64), 4).reshape(-1).tolist(),
                "triangles": each.triangles.reshape(-1).tolist(),
            }
            for bottom, each in fittings(building)
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


def _ways_on(building: Building, level: Level) -> list[Gate]:
    """The ends of flights and the doors of lifts on a level."""
    name = sheet_of(level.number)
    lines = [each.head for each in building.flights if each.upper == name]
    lines += [each.foot for each in building.flights if each.lower == name]
    lines += [each.door for each in building.lifts if level.number in each.numbers]
    return [Gate(str(number), *line) for number, line in enumerate(lines)]


def _label(level: Level) -> str:
    return f"level_{level.number}".replace("-", "minus_")
