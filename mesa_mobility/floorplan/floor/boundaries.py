"""The walls of a free area: its boundary with the open exits cut out."""

from collections.abc import Iterable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.checks import EDGE_TOLERANCE
from mesa_mobility.floorplan.floor.openings import Opening

_SHORTEST_WALL = 1e-9


def boundary_segments(area: BaseGeometry) -> NDArray[np.float64]:
    """(m, 4) x1, y1, x2, y2 in metres of the sides of every ring of a polygon or multipolygon."""
    rings = shapely.get_rings(shapely.get_parts(area))
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    segments = np.concatenate([xy[:-1], xy[1:]], axis=1)[ring[:-1] == ring[1:]]
    return segments[(segments[:, :2] != segments[:, 2:]).any(axis=1)]


def rings(area: BaseGeometry) -> list[NDArray[np.float64]]:
    """The rings of a polygon or multipolygon, each as its (n, 2) vertices in metres.

    The first vertex is not repeated at the end. The area lies to the left of the ring.
    """
    oriented = [shapely.geometry.polygon.orient(part, 1.0) for part in shapely.get_parts(area)]
    return [shapely.get_coordinates(ring)[:-1] for ring in shapely.get_rings(oriented)]


def turns(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) angle in radians by which a ring turns left at each vertex, negative to the right."""
    arriving = ring - np.roll(ring, 1, axis=0)
    leaving = np.roll(arriving, -1, axis=0)
    return np.arctan2(
        arriving[:, 0] * leaving[:, 1] - arriving[:, 1] * leaving[:, 0],
        (arriving * leaving).sum(axis=1),
    )


def cut_out(
    segments: NDArray[np.float64], openings: Iterable[Opening], off: float = EDGE_TOLERANCE
) -> NDArray[np.float64]:
    """(k, 4) what is left of (m, 4) segments, without the parts that lie along an opening.

    A part lies along an opening if it is at most ``off`` metres from it.
    """
    for opening in openings:
        segments = _cut_one(segments, opening, off)
    return segments


def opening_segments(openings: Iterable[Opening]) -> NDArray[np.float64]:
    """(k, 4) x1, y1, x2, y2 in metres of the lines of the openings."""
    return np.array([[*o.a, *o.b] for o in openings], dtype=np.float64).reshape(-1, 4)


def _cut_one(segments: NDArray[np.float64], opening: Opening, off: float) -> NDArray[np.float64]:
    origin = np.array(opening.a)
    along = (np.array(opening.b) - origin) / opening.length
    across = np.array([-along[1], along[0]])
    start, end = segments[:, :2] - origin, segments[:, 2:] - origin
    t, s = np.stack([start @ along, end @ along]), np.stack([start @ across, end @ across])
    lengths = np.hypot(*(end - start).T)
    # Jambs meet the opening at an angle and must keep their full length.
    parallel = np.abs(t[1] - t[0]) > 0.9 * lengths
    t_in, t_out = _inside(t, 0.0, opening.length)
    s_in, s_out = _inside(s, -off, off)
    first, last = np.maximum(t_in, s_in), np.minimum(t_out, s_out)
    cut = parallel & (last > first)
    kept = [segments[~cut]]
    rows, first, last = segments[cut], first[cut, None], last[cut, None]
    step = rows[:, 2:] - rows[:, :2]
    kept.append(np.concatenate([rows[:, :2], rows[:, :2] + first * step], axis=1))
    kept.append(np.concatenate([rows[:, :2] + last * step, rows[:, 2:]], axis=1))
    walls = np.concatenate(kept)
    return walls[np.hypot(*(walls[:, 2:] - walls[:, :2]).T) > _SHORTEST_WALL]


def _inside(
    values: NDArray[np.float64], low: float, high: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where along each segment, 0 to 1, a quantity given at its two ends lies in [low, high]."""
    change = values[1] - values[0]
    flat = change == 0.0
    safe = np.where(flat, 1.0, change)
    bounds = np.sort(np.stack([(low - values[0]) / safe, (high - values[0]) / safe]), axis=0)
    within = (values[0] >= low) & (values[0] <= high)
    first = np.where(flat, np.where(within, 0.0, 1.0), np.clip(bounds[0], 0.0, 1.0))
    last = np.where(flat, np.where(within, 1.0, 0.0), np.clip(bounds[1], 0.0, 1.0))
    return first, last
