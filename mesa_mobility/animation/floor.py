"""A floor plan as the browser draws it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from mesa_mobility.animation.solids import drawn_solid, solids_of

if TYPE_CHECKING:
    from mesa_mobility.buildings import Refuge
    from mesa_mobility.floorplan import FloorPlan
    from mesa_mobility.floorplan.floor.openings import Opening


def drawn_floor(plan: FloorPlan) -> dict[str, Any]:
    """Rings and lines of a plan, metres, as JSON takes them."""
    return {
        "bounds": list(plan.bounds),
        "outline": [ring(part.exterior) for part in shapely.get_parts(plan.walkable)],
        "free": [rings(part) for part in shapely.get_parts(plan.free)],
        "walls": plan.walls.tolist(),
        "solids": [drawn_solid(solid) for solid in solids_of(plan)],
        "zones": [ring(zone.area.exterior) for zone in plan.zones],
        "openings": [
            drawn_opening(opening, plan.is_open(opening.name)) for opening in plan.openings()
        ],
    }


def drawn_opening(opening: Opening, is_open: bool) -> dict[str, Any]:
    """An exit or a gate, metres, and whether it is open."""
    line = {"a": list(opening.a), "b": list(opening.b)}
    return {"name": opening.name, "kind": opening.kind, **line, "open": is_open}


def drawn_refuge(refuge: Refuge) -> dict[str, Any]:
    """A refuge: its name, its rings, and a place within it for the name, metres."""
    spot = refuge.shape.representative_point()
    return {"name": refuge.name, "rings": rings(refuge.shape), "middle": [spot.x, spot.y]}


def rings(area: shapely.Polygon) -> list[list[list[float]]]:
    """Points of the outline of an area, then of its holes."""
    return [ring(each) for each in (area.exterior, *area.interiors)]


def ring(line: shapely.LinearRing) -> list[list[float]]:
    """(n, 2) points of a ring."""
    points: list[list[float]] = np.asarray(line.coords)[:, :2].tolist()
    return points
