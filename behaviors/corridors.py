"""Corridors in which two people cannot pass each other, and the places beside the way along them.

The floor is looked at in square cells.  Where no disc for two people has room it is narrow.  A
corridor is narrow floor together with what is wide on it but no room, such as niches and bays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from mesa_mobility import FloorPlan

LEAST_ROOM = 20.0
"""Area in m2 from which on wide floor is a room, where a corridor ends."""

SHORTEST = 2.0
"""Metres of a corridor; what is shorter is a door."""

BEYOND = 4.0
"""Metres of the rooms at its ends that count as before a corridor; no movement is longer."""

CELL = 0.6
"""Width of a cell in radii of the narrowest body."""

WALL = 0.43
"""Distance of a cell to walls in these radii: more than half the diagonal of a cell, so that no two
cells touch across a wall, and so little that a body in a corner has a cell."""

MIDDLE = 0.4
"""Metres from a wall up to which a way farther from it is preferred."""

CLEAR = 0.05
"""Metres that people who stand at a place keep from walls beside the radius of their bodies."""


class Corridor(NamedTuple):
    """A corridor with two ends, and the floor before them.

    Attributes:
        origin: (2,) corner of its cells, metres.
        cell: their width, metres.
        along: (ny, nx) metres along the way from one end to the other at which each cell is: less
            than 0 before the one end, more than ``length`` beyond the other, NaN elsewhere.
        aside: (ny, nx) metres on foot from the way.
        within: (ny, nx) whether a cell is in the corridor.
        length: metres of the way.
        way: (k, 2) points of the way, metres, and of its straight continuation.
        way_along: (k,) where they are along it, metres.
        places: (p, 2) where people may stand clear of the way, metres.
        places_along: (p,) where they are along the way, metres.
        places_aside: (p,) how far from it, metres.
    """

    origin: NDArray[np.float64]
    cell: float
    along: NDArray[np.float64]
    aside: NDArray[np.float64]
    within: NDArray[np.bool_]
    length: float
    way: NDArray[np.float64]
    way_along: NDArray[np.float64]
    places: NDArray[np.float64]
    places_along: NDArray[np.float64]
    places_aside: NDArray[np.float64]

    def locate(
        self, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """(n,) where (n, 2) points, metres, are along the way, how far aside of it, metres, and
        whether they are within the corridor. NaN where they are neither in it nor before it."""
        x, y, known = _cells_at(points, self.origin, self.cell, self.along.shape)
        along = np.where(known, self.along[y, x], np.nan)
        return along, np.where(known, self.aside[y, x], np.nan), known & self.within[y, x]


def find_corridors(plan: FloorPlan, narrowest: float, widest: float, room: float) -> list[Corridor]:
    """The corridors of a floor plan that lead from room to room.

    Those with more or fewer than two ends are left out.

    Args:
        plan: the floor plan; closed gates are walls.
        narrowest: radius of the narrowest body, metres.
        widest: that of the widest, metres.
        room: metres between the middles of two people who pass each other.
    """
    free = plan.free
    # A corridor for two, less what rounding adds to it, is wide.
    wide = shapely.buffer(shapely.buffer(free, 1e-6 - room), room)
    rooms = [each for each in shapely.get_parts(wide) if each.area >= LEAST_ROOM]
    narrow = shapely.difference(free, shapely.union_all(rooms))
    gates = shapely.union_all(
        [shapely.LineString([each.a, each.b]) for each in plan.closed_gates()]
    )
    walls = shapely.union(free.boundary, gates)
    found = []
    for part in shapely.get_parts(narrow):
        x0, y0, x1, y1 = part.bounds
        # Slivers in the corners of rooms, and doors.
        if isinstance(part, shapely.Polygon) and np.hypot(x1 - x0, y1 - y0) >= SHORTEST:
            corridor = _corridor(free, walls, part, narrowest, widest, room)
            if corridor is not None:
                found.append(corridor)
    return found


class _Cells(NamedTuple):
    """The n cells of a corridor and of the floor before its ends.

    Fields: ``number`` (ny, nx) number of each, -1 for none; ``points`` (n, 2) their middles, and
    ``clearance`` (n,) their distance to walls, metres; ``within`` (n,) whether they are in the
    corridor; ``one`` and ``other`` (e,) and ``steps`` (e,) pairs of neighbours, and the metres
    between them.
    """

    number: NDArray[np.int64]
    points: NDArray[np.float64]
    clearance: NDArray[np.float64]
    within: NDArray[np.bool_]
    one: NDArray[np.int64]
    other: NDArray[np.int64]
    steps: NDArray[np.float64]

    def graph(self, weights: NDArray[np.float64]) -> csr_array:
        """The neighbours, with a weight for each pair."""
        n = len(self.points)
        # SciPy before 1.13 takes no others.
        pairs = (self.one.astype(np.int32), self.other.astype(np.int32))
        return csr_array(coo_array((weights, pairs), shape=(n, n)))


def _corridor(
    free: shapely.Geometry,
    walls: shapely.Geometry,
    part: shapely.Polygon,
    narrowest: float,
    widest: float,
    room: float,
) -> Corridor | None:
    """The corridor on a part of the floor; None if it has not two ends or no body fits through."""
    cell = CELL * narrowest
    origin = np.array(part.bounds[:2]) - BEYOND
    cells = _cells(free, walls, part, origin, cell, WALL * narrowest)
    ends = _ends(cells)
    if len(ends) != 2:
        return None
    way = _way(cells, ends, narrowest)
    if len(way) < 2:
        return None
    steps = np.hypot(*np.diff(cells.points[way], axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    length = float(along[-1])
    if length < SHORTEST:
        return None
    before = _onwards(cells, way[::-1], origin, cell)
    beyond = _onwards(cells, way, origin, cell)
    way = np.concatenate([before[::-1], way, beyond])
    along = np.concatenate(
        [
            -cell * np.arange(len(before), 0, -1),
            along,
            length + cell * np.arange(1, len(beyond) + 1),
        ]
    )
    # Each cell is where the point of the way is that is nearest to it on foot.
    aside, _, nearest = dijkstra(
        cells.graph(cells.steps),
        directed=False,
        indices=way,
        min_only=True,
        return_predecessors=True,
        limit=2.0 * BEYOND,
    )
    there = np.full(len(cells.points), np.nan)
    there[way] = along
    reached = np.isfinite(aside)
    there[reached] = there[nearest[reached]]
    near = (there > -BEYOND) & (there < length + BEYOND)
    there[~(near & (cells.within | (aside < BEYOND)))] = np.nan
    stands = np.isfinite(there) & (cells.clearance >= widest + CLEAR) & (aside >= room)
    own = _apart(cells.points, np.flatnonzero(stands), room)
    held = cells.number >= 0
    grid, off = np.full(held.shape, np.nan), np.full(held.shape, np.nan)
    inside = np.zeros(held.shape, dtype=np.bool_)
    grid[held], off[held], inside[held] = there, aside, cells.within
    return Corridor(
        origin,
        cell,
        grid,
        off,
        inside,
        length,
        cells.points[way],
        along,
        cells.points[own],
        there[own],
        aside[own],
    )


def _cells(
    free: shapely.Geometry,
    walls: shapely.Geometry,
    part: shapely.Polygon,
    origin: NDArray[np.float64],
    cell: float,
    clearance: float,
) -> _Cells:
    """The cells on a part of the floor and within ``BEYOND`` of it."""
    far = np.array(part.bounds[2:]) + BEYOND
    nx, ny = np.ceil((far - origin) / cell).astype(int)
    x, y = np.meshgrid(
        origin[0] + cell * (np.arange(nx) + 0.5), origin[1] + cell * (np.arange(ny) + 0.5)
    )
    shapely.prepare(free)
    held = shapely.contains_xy(free, x, y)
    distances = np.zeros(held.shape)
    distances[held] = shapely.distance(shapely.points(x[held], y[held]), walls)
    held &= distances >= clearance
    index = np.full(held.shape, -1, dtype=np.int64)
    index[held] = np.arange(held.sum())
    shapely.prepare(part)
    pairs = []
    for down, across in ((0, 1), (1, 0), (1, 1), (1, -1)):
        first = index[: ny - down, max(-across, 0) : nx - max(across, 0)]
        second = index[down:, max(across, 0) : nx + min(across, 0)]
        both = (first >= 0) & (second >= 0)
        step = np.full(both.sum(), cell * np.hypot(down, across))
        pairs.append((first[both], second[both], step))
    one, other, steps = (np.concatenate(each) for each in zip(*pairs, strict=True))
    return _Cells(
        index,
        np.column_stack([x[held], y[held]]),
        distances[held],
        shapely.contains_xy(part, x[held], y[held]),
        one,
        other,
        steps,
    )


def _ends(cells: _Cells) -> list[NDArray[np.int64]]:
    """The cells of a corridor that touch those of rooms, end by end."""
    edge = np.zeros(len(cells.points), dtype=np.bool_)
    across = cells.within[cells.one] != cells.within[cells.other]
    edge[cells.one[across]] = edge[cells.other[across]] = True
    edge &= cells.within
    drawn = np.zeros(cells.number.shape, dtype=np.bool_)
    held = cells.number >= 0
    drawn[held] = edge[cells.number[held]]
    numbers, count = label(drawn, structure=np.ones((3, 3)))
    return [cells.number[numbers == number] for number in range(1, count + 1)]


def _way(cells: _Cells, ends: list[NDArray[np.int64]], radius: float) -> NDArray[np.int64]:
    """The cells of the way of a body from the one end to the other; empty if there is none.

    It keeps to the middle, and does not go into niches.
    """
    open_ = cells.within & (cells.clearance >= radius)
    both = open_[cells.one] & open_[cells.other]
    room = np.minimum(cells.clearance[cells.one], cells.clearance[cells.other])
    weights = np.where(both, cells.steps * (1.0 + np.maximum(MIDDLE - room, 0.0)), np.inf)
    starts = ends[0][open_[ends[0]]]
    if len(starts) == 0:
        return starts
    lengths, before, _ = dijkstra(
        cells.graph(weights),
        directed=False,
        indices=starts.astype(np.int32),
        min_only=True,
        return_predecessors=True,
    )
    last = int(ends[1][lengths[ends[1]].argmin()])
    if not np.isfinite(lengths[last]):
        return starts[:0]
    way = [last]
    while before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return np.array(way[::-1], dtype=np.int64)


def _onwards(
    cells: _Cells, way: NDArray[np.int64], origin: NDArray[np.float64], cell: float
) -> NDArray[np.int64]:
    """The cells of the straight continuation of a way into the room at its end."""
    end = cells.points[way[-1]]
    back = cells.points[way[-min(len(way), 8)]]
    course = (end - back) / max(float(np.hypot(*(end - back))), 1e-9)
    points = end + cell * np.arange(1, int(BEYOND / cell))[:, None] * course
    x, y, known = _cells_at(points, origin, cell, cells.number.shape)
    found = np.where(known, cells.number[y, x], -1)
    off = np.flatnonzero(found < 0)
    return found[: off[0]] if len(off) else found


def _cells_at(
    points: NDArray[np.float64], origin: NDArray[np.float64], cell: float, shape: tuple[int, ...]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
    """(n,) columns and rows of the cells that (n, 2) points are in, 0 for those outside the grid of
    a shape (ny, nx), and whether they are inside it."""
    at = np.floor((points - origin) / cell).astype(np.int64)
    ny, nx = shape
    known = (at >= 0).all(axis=1) & (at[:, 0] < nx) & (at[:, 1] < ny)
    x, y = np.where(known[:, None], at, 0).T
    return x, y, known


def _apart(
    points: NDArray[np.float64], candidates: NDArray[np.int64], room: float
) -> NDArray[np.int64]:
    """As many of the candidates as are ``room`` metres apart, row by row."""
    chosen = []
    while len(candidates):
        first = candidates[0]
        chosen.append(first)
        away = np.hypot(*(points[candidates] - points[first]).T)
        candidates = candidates[away >= room]
    return np.array(chosen, dtype=np.int64)
