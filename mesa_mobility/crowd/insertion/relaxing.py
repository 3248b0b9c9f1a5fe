"""Places moved apart until bodies have room."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls

MARGIN = 1e-4
"""Metres by which bodies are moved further apart than they need: the last steps are short."""

SAME = 1e-9
"""Metres below which two places are one: their difference is too small to give a direction."""

ROUNDS = 2000
"""Rounds after which bodies are not moved any more."""

GOLDEN_ANGLE = np.pi * (3.0 - np.sqrt(5.0))


def relaxed(
    points: NDArray[np.float64], radii: NDArray[np.float64], plan: FloorPlan, *, apart: bool = True
) -> NDArray[np.float64]:
    """Places near the given ones at which bodies overlap neither each other nor walls.

    In each round everybody moves away from those who overlap them, by half of the overlap, and then
    away from walls.

    Args:
        points: (n, 2) metres.
        radii: (n,) of the bodies, metres.
        plan: the floor.
        apart: whether bodies must not overlap each other.

    Returns:
        (n, 2) metres. If there is no room after ``ROUNDS`` rounds, bodies may still overlap each
        other or walls. No error is raised. Bodies that fit nowhere on the floor are not moved away
        from walls at all.
    """
    places = np.array(points, dtype=np.float64)
    rooms = {radius: _room(plan, radius) for radius in np.unique(radii).tolist()}
    for _ in range(ROUNDS):
        crowded = apart and _part(places, radii)
        for radius, room in rooms.items():
            crowded |= _leave_walls(places, np.flatnonzero(radii == radius), radius, room, plan)
        if not crowded:
            break
    return places


def _part(places: NDArray[np.float64], radii: NDArray[np.float64]) -> bool:
    """Move overlapping bodies apart; whether there were any."""
    reach = 2.0 * radii.max(initial=0.0)
    one, other = cKDTree(places).query_pairs(reach, output_type="ndarray").T
    way = places[one] - places[other]
    distance = np.hypot(*way.T)
    overlap = radii[one] + radii[other] - distance
    near = overlap > 0.0
    if not near.any():
        return False
    one, other, way, distance = one[near], other[near], way[near], distance[near]
    # Those at the same place part in directions of their own.
    same = distance < SAME
    angle = GOLDEN_ANGLE * one[same]
    way[same] = np.column_stack([np.cos(angle), np.sin(angle)])
    distance[same] = 1.0
    shift = way * ((overlap[near] + MARGIN) / (2.0 * distance))[:, None]
    np.add.at(places, one, shift)
    np.subtract.at(places, other, shift)
    return True


def _leave_walls(
    places: NDArray[np.float64],
    people: NDArray[np.int64],
    radius: float,
    room: shapely.Geometry,
    plan: FloorPlan,
) -> bool:
    """Move people of one radius to the nearest place clear of walls; whether anybody moved."""
    if room.is_empty or not len(people):
        return False
    own = places[people]
    near = ~plan.contains(own) | (distances_to_walls(plan, own, radius) < radius)
    if near.any():
        lines = shapely.shortest_line(shapely.points(own[near]), room)
        places[people[near]] = shapely.get_coordinates(lines)[1::2]
    return bool(near.any())


def _room(plan: FloorPlan, radius: float) -> shapely.Geometry:
    """Where the centre of a body of this radius may be.

    The area is a little too small, since round corners are drawn with straight pieces.
    """
    return plan.free.buffer(-radius * (1.0 + MARGIN) - MARGIN, quad_segs=32)
