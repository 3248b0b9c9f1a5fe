"""A floor plan as the browser draws it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan


def drawn_floor(plan: FloorPlan) -> dict[str, Any]:
    """Rings and lines of a plan, metres, as JSON takes them."""
    return {
        "bounds": list(plan.bounds),
        "outline": [ring(part.exterior) for part in shapely.get_parts(plan.walkable)],
        "free": [
            [ring(each) for each in (part.exterior, *part.interiors)]
            for part in shapely.get_parts(plan.free)
        ],
        "walls": plan.walls.tolist(),
        "zones": [ring(zone.area.exterior) for zone in plan.zones],
        "openings": [
            {
                "name": opening.name,
                "kind": opening.kind,
                "a": list(opening.a),
                "b": list(opening.b),
                "open": plan.is_open(opening.name),
            }
            for opening in plan.openings()
        ],
    }


def ring(line: shapely.LinearRing) -> list[list[float]]:
    """(n, 2) points of a ring."""
    points: list[list[float]] = np.asarray(line.coords)[:, :2].tolist()
    return points
