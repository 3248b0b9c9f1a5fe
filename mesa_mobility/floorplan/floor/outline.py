"""Outlines with fewer vertices, between which walls recede by a centimetre at most.

A wall drawn by hand, scanned or rasterised has many vertices that mean nothing. They cost time and
make people look for ways round corners that nobody sees. So vertices are left out where the wall
recedes by no more than a tolerance.

The wall may only recede: the floor grows. Then no door and no gap gets narrower, and whoever stood
on the floor still does. Each vertex that is kept stays where it is, to the last bit, and an outline
without such vertices stays as it is. Along exits, gates and doors every vertex is kept, so that
they lie on the outline as before.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import EDGE_TOLERANCE
from mesa_mobility.floorplan.floor.openings import Opening

SIMPLIFY = 0.01
"""Metres by which walls may recede where vertices are left out, by default."""

MOST_SIMPLIFY = 0.1
"""Greatest such tolerance, metres: a wall that recedes by more is another wall."""

GRID = 1e-6
"""Vertices nearer to each other than this are one, metres.

Differences and unions of polygons leave some a rounding error apart, between which no line has a
direction. Only an outline that has such vertices is put on a grid; all others keep every bit."""

# A vertex this far behind the line between its neighbours is on it (metres).
_ROUNDING = 1e-9

# How often a tolerance is halved at which walls would cross.
_TRIES = 4


def check_tolerance(value: float) -> float:
    """A tolerance in metres, 0 to ``MOST_SIMPLIFY``; FloorPlanError otherwise."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise FloorPlanError(f"simplify must be metres, found {value!r:.60}")
    if not 0.0 <= value <= MOST_SIMPLIFY:
        raise FloorPlanError(f"simplify must be 0 to {MOST_SIMPLIFY} m, found {value}")
    return float(value)


def outline_of(
    pieces: Sequence[Polygon], tolerance: float, openings: Sequence[Opening]
) -> BaseGeometry:
    """The free area of some pieces as people walk on it: cleaned, then simplified.

    Args:
        pieces: polygons beside one another.
        tolerance: metres by which walls may recede.
        openings: lines along which the outline stays as it is.

    Returns:
        a Polygon, or a MultiPolygon of several.
    """
    free = _whole(_cleaned(pieces))
    thinned = _whole([simplified(piece, tolerance, openings) for piece in shapely.get_parts(free)])
    # Pieces that only a thin wall parts would grow into one another.
    return thinned if thinned.is_valid else free


def _whole(pieces: Sequence[Polygon]) -> BaseGeometry:
    return pieces[0] if len(pieces) == 1 else shapely.MultiPolygon(pieces)


def _cleaned(pieces: Sequence[Polygon]) -> Sequence[Polygon]:
    """The pieces, on a grid of ``GRID`` if vertices are nearer to each other than that."""
    rings = shapely.get_rings(list(pieces))
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    lengths = np.hypot(*(xy[1:] - xy[:-1]).T)[ring[1:] == ring[:-1]]
    if lengths.min() >= GRID:
        return pieces
    parts = shapely.get_parts(shapely.set_precision(list(pieces), GRID))
    return [part for part in parts if part.area > 0.0] or pieces


def simplified(piece: Polygon, tolerance: float, openings: Sequence[Opening]) -> Polygon:
    """The polygon, without vertices between which its edge recedes by at most ``tolerance`` metres.

    It contains the given one. Edges next to an opening stay as they are.
    """
    oriented = shapely.geometry.polygon.orient(piece, 1.0)
    rings = [np.array(ring.coords)[:-1] for ring in (oriented.exterior, *oriented.interiors)]
    lines = shapely.STRtree([each.line for each in openings])
    for _ in range(_TRIES):
        if tolerance <= 0.0:
            break
        fewer = [_thinned(ring, tolerance, lines) for ring in rings]
        if all(len(now) == len(then) for now, then in zip(fewer, rings, strict=True)):
            break
        made = Polygon(fewer[0], fewer[1:])
        # Where walls are thinner than they may recede, their sides would cross.
        if made.is_valid:
            return made
        tolerance /= 2.0
    return piece


def _thinned(
    ring: NDArray[np.float64], tolerance: float, openings: shapely.STRtree
) -> NDArray[np.float64]:
    """(k, 2) the vertices to keep of a ring (n, 2) with the floor on its left."""
    n = len(ring)
    first = int(np.lexsort(ring.T)[0])
    ring = np.roll(ring, -first, axis=0)
    closed = np.concatenate([ring, ring[:1]])
    keep = np.zeros(n + 1, dtype=np.bool_)
    keep[[0, int(np.hypot(*(ring - ring[0]).T).argmax()), n]] = True
    edges = shapely.linestrings(np.stack([closed[:-1], closed[1:]], axis=1))
    near = openings.query(edges, predicate="dwithin", distance=tolerance + 2 * EDGE_TOLERANCE)[0]
    keep[near] = keep[near + 1] = True
    fixed = np.flatnonzero(keep).tolist()
    spans = list(pairwise(fixed))
    while spans:
        i, j = spans.pop()
        if j - i < 2:
            continue
        worst = _worst(closed[i : j + 1], tolerance)
        if worst:
            keep[i + worst] = True
            spans += [(i, i + worst), (i + worst, j)]
    kept = np.flatnonzero(keep[:n])
    return ring[kept] if 3 <= len(kept) < n else np.roll(ring, first, axis=0)


def _worst(path: NDArray[np.float64], tolerance: float) -> int:
    """Number of the vertex of a path that a straight line must not leave out; 0 if it may be drawn.

    It is the one farthest behind the line, else the one farthest before it.
    """
    start, step = path[0], path[-1] - path[0]
    length2 = float(step @ step)
    off = path - start
    if length2 == 0.0:
        return int((off**2).sum(axis=1).argmax())
    left = (step[0] * off[:, 1] - step[1] * off[:, 0]) / np.sqrt(length2)
    if left.min() < -_ROUNDING:
        return int(left.argmin())
    along = np.clip(off @ step / length2, 0.0, 1.0)
    away = np.hypot(*(off - along[:, None] * step).T)
    farthest = int(away.argmax())
    return farthest if away[farthest] > tolerance else 0
