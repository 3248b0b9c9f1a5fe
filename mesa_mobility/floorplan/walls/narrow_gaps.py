"""Gaps that are too narrow for a body."""

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.boundaries import opening_segments, rings, turns
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.walls.smooth_floor import smooth_floor
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls

# Gaps of the smooth floor may look wider by this much (metres).
_OFF = 0.04

# How far behind a smooth wall the real one may lie (metres).
_POCKET = 0.2

# Distance of the places in a gap whose distances to the real walls are looked up (metres).
_APART = 0.005


def narrow_gaps(plan: Floor, width: float) -> NDArray[np.float64]:
    """(k, 4) segments across every gap of the smooth floor that is narrower than `width` metres.

    A gap is narrowest between a reflex vertex of the floor, or a loose end of a wall, and the
    nearest point of another wall.
    """
    smooth = smooth_floor(plan)
    ends = opening_segments([*plan.open_exits(), *plan.closed_gates()]).reshape(-1, 2)
    vertices = [ring[turns(ring) < 0] for ring in rings(smooth.floor)]
    bases = shapely.points(np.unique(np.concatenate([ends, *vertices]), axis=0))
    base, wall = smooth.tree.query(bases, predicate="dwithin", distance=width)
    across = shapely.shortest_line(bases[base], smooth.walls[wall])
    length = shapely.length(across)
    across = across[(length > 0) & (length < width)]
    # A line that only runs along or inside walls spans no gap.
    middles = shapely.line_interpolate_point(across, 0.5, normalized=True)
    across = across[shapely.contains_properly(smooth.floor, middles)]
    return shapely.get_coordinates(across).reshape(-1, 4)


def closed_gaps(plan: Floor, width: float) -> NDArray[np.float64]:
    """(k, 4) segments across every gap of the free area that is narrower than `width` metres.

    Where walls of the smooth floor are not the real ones, a gap is closed only if no place in it is
    half the width from the real walls, but for 5 mm.
    """
    if smooth_floor(plan).is_exact:
        return narrow_gaps(plan, width)
    gaps = narrow_gaps(plan, width + _OFF)
    step = gaps[:, 2:] - gaps[:, :2]
    length = np.hypot(*step.T)[:, None]
    count = 2 * int(np.ceil((0.5 * (width + _OFF) + _POCKET) / _APART)) + 1
    # From the middle of the gap to behind its ends.
    along = np.linspace(-0.5, 0.5, count)[:, None] * (step + 2 * _POCKET * step / length)[:, None]
    places = ((gaps[:, :2] + gaps[:, 2:]) / 2.0)[:, None] + along
    flat = places.reshape(-1, 2)
    enough = width / 2.0 - _APART
    free = plan.contains(flat).reshape(-1, count)
    wide = distances_to_walls(plan, flat, width).reshape(-1, count) >= enough
    # What lies behind a wall is another place.
    ahead = np.logical_and.accumulate(free[:, count // 2 :], axis=1)
    back = np.logical_and.accumulate(free[:, count // 2 :: -1], axis=1)
    passable = (ahead & wide[:, count // 2 :]) | (back & wide[:, count // 2 :: -1])
    return gaps[~passable.any(axis=1)]


def walls_near(plan: Floor, place: BaseGeometry, reach: float) -> NDArray[np.object_]:
    """The walls less than `reach` metres from a place, as shapely lines."""
    xmin, ymin, xmax, ymax = place.bounds
    index = plan.wall_index
    rows = index.segments[index.near(xmin - reach, ymin - reach, xmax + reach, ymax + reach)]
    lines = shapely.linestrings(rows.reshape(-1, 2, 2))
    return lines[shapely.distance(lines, place) < reach]
