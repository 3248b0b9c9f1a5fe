"""The safety check of finished trajectories: overlaps, steps through walls, places off the floor.

It shares no code with the collision tests of the simulation: it takes positions as they were
written and uses shapely and, for overlaps, SciPy's k-d tree.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures.sites import Site, sites_of
from mesa_mobility.results.overlaps import NAMED, Overlap, count_overlaps
from mesa_mobility.results.trajectories import Trajectories

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building

# Least width of the squares by which steps near walls are found, metres.
SQUARE_M = 0.25
# An exit may lie 1 cm off the edge of the floor, and people beyond that edge before they cross it.
EXIT_OFF_M = 0.02
# Largest number of squares along either side of the floor, which bounds memory.
MOST_SQUARES = 4000
# Steps tested at once, which bounds the memory for shapely's objects.
CHUNK = 200_000


@dataclass(frozen=True)
class WallCrossing:
    """A step of one person, from `frame` to the next, on which they meet a wall segment: their
    position, or the centre of a disc of their body. ``at`` is where the step begins."""

    frame: int
    person: int
    wall: int
    at: Site | None = field(default=None, compare=False)


_Named = TypeVar("_Named", Overlap, WallCrossing)


@dataclass(frozen=True)
class SafetyReport:
    """Result of the independent check.

    Attributes:
        overlaps: pairs of bodies closer than their cores, counted over all frames.
        overlapping_pairs: the first few of them.
        min_distance_m: smallest distance between the centres of two people in any frame, metres;
            None when two people were never inside together.
        wall_crossings: steps between consecutive frames that meet a wall.
        crossings: the first few of them.
        off_floor: frames that people spent off the floor, in an obstacle or outside the walkable
            area, summed over all of them; None where no floor was given.
    """

    overlaps: int
    overlapping_pairs: tuple[Overlap, ...]
    min_distance_m: float | None
    wall_crossings: int
    crossings: tuple[WallCrossing, ...]
    off_floor: int | None = None

    @property
    def passed(self) -> bool:
        """Whether there is no overlap, no wall crossing and, if counted, nobody off the floor."""
        return self.overlaps == 0 and self.wall_crossings == 0 and not self.off_floor


def check_safety(
    trajectories: Trajectories,
    walls: ArrayLike,
    floor: BaseGeometry | None = None,
    *,
    building: Building | None = None,
) -> SafetyReport:
    """Count overlapping bodies, steps through walls and places off the floor.

    Args:
        trajectories: the run; its `core_radius` says how close two people may come.
        walls: (m, 4) segments x1, y1, x2, y2 in metres (`FloorPlan.walls`), open exits cut out.
        floor: where people may be (`FloorPlan.free`), metres; without it nobody is counted as off
            the floor.
        building: where the people walked; walls and floor are those of its floor plan.

    Returns:
        A report. Distances below the sum of two core radii by less than 1e-5 m are rounding.

    Raises:
        ResultsError: walls of another shape or not finite.
        FloorPlanError: a place that is on no level, landing or flight of the building.
    """
    segments = np.asarray(walls, dtype=np.float64)
    if segments.size == 0:
        segments = segments.reshape(0, 4)
    if segments.ndim != 2 or segments.shape[1] != 4 or not np.all(np.isfinite(segments)):
        raise ResultsError(f"walls have shape {segments.shape}, expected (m, 4) finite numbers")
    overlaps, pairs, nearest = count_overlaps(trajectories)
    places = np.column_stack((trajectories.x, trajectories.y))
    if building is not None:
        places = building.plane_places(np.column_stack((places, trajectories.z)))
    count, crossings = _wall_crossings(trajectories, places, segments)
    named = [(each.frame, each.first) for each in pairs]
    named += [(each.frame, each.person) for each in crossings]
    sites = sites_of(trajectories, named, building)
    return SafetyReport(
        overlaps=overlaps,
        overlapping_pairs=tuple(map(_placed, pairs, sites)),
        min_distance_m=nearest,
        wall_crossings=count,
        crossings=tuple(map(_placed, crossings, sites[len(pairs) :])),
        off_floor=None if floor is None else _off_floor(trajectories, places, floor),
    )


def _placed(each: _Named, site: Site) -> _Named:
    return replace(each, at=site)


def _off_floor(trajectories: Trajectories, places: NDArray[np.float64], floor: BaseGeometry) -> int:
    """Number of rows whose places (n, 2) lie off the floor.

    The last row of people who left does not count: it lies beyond their exit.
    """
    ours = np.ones(len(trajectories.person), dtype=np.bool_)
    people, last = np.unique(trajectories.person[::-1], return_index=True)
    left = ~np.isin(people, trajectories.remaining)
    ours[len(ours) - 1 - last[left]] = False
    x, y = places[ours].T
    shapely.prepare(floor)
    off = ~shapely.intersects_xy(floor, x, y)
    return int((shapely.distance(shapely.points(x[off], y[off]), floor) > EXIT_OFF_M).sum())


def _wall_crossings(
    trajectories: Trajectories, places: NDArray[np.float64], walls: NDArray[np.float64]
) -> tuple[int, list[WallCrossing]]:
    """Steps from places (n, 2), by row of the trajectories, that meet a wall."""
    start, end = trajectories.steps()
    if not len(walls) or not len(start):
        return 0, []
    # A flight is drawn on both sheets that it joins: a step may end on the other one.
    here, there = places[start], places[end]
    true = np.column_stack((trajectories.x, trajectories.y))
    changes = np.abs(there - here - (true[end] - true[start])).max(axis=1) > SQUARE_M
    there[changes] = here[changes] + true[end][changes] - true[start][changes]
    steps, wall_of = _meet_walls(here, there, walls)
    rows = start[steps]
    in_order = np.argsort(rows, kind="stable")[:NAMED]
    named = [
        WallCrossing(
            int(trajectories.frame[rows[k]]), int(trajectories.person[rows[k]]), int(wall_of[k])
        )
        for k in in_order
    ]
    return len(rows), named


def _meet_walls(
    start: NDArray[np.float64], end: NDArray[np.float64], walls: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(h,) which of the straight steps from ``start`` (k, 2) to ``end`` meet a wall, and (h,) a
    wall that each meets."""
    near = np.flatnonzero(_near_walls(start, end, walls))
    steps = np.stack((start[near], end[near]), axis=1)
    tree = shapely.STRtree(shapely.linestrings(walls.reshape(-1, 2, 2)))
    hits, hit_walls = list[NDArray[np.int64]](), list[NDArray[np.int64]]()
    for first in range(0, len(steps), CHUNK):
        lines = shapely.linestrings(steps[first : first + CHUNK])
        step, wall = tree.query(lines, predicate="intersects")
        # A step through a corner meets two walls and is one crossing.
        step, once = np.unique(step, return_index=True)
        hits.append(near[step + first])
        hit_walls.append(wall[once])
    found = np.concatenate(hits) if hits else np.empty(0, dtype=np.int64)
    return found, np.concatenate(hit_walls) if hits else found


def _near_walls(
    start: NDArray[np.float64], end: NDArray[np.float64], walls: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(k,) which steps begin in a square that holds part of a wall, or beside one.

    Squares are as wide as the longest step: no other step can meet a wall.
    """
    longest = float(np.hypot(*(end - start).T).max())
    ends = walls.reshape(-1, 2)
    low = np.minimum(ends.min(axis=0), start.min(axis=0))
    high = np.maximum(ends.max(axis=0), start.max(axis=0))
    side = max(SQUARE_M, 1.01 * longest, float((high - low).max()) / MOST_SQUARES)
    # Places on the walls, no farther than half a square from one to the next.
    lengths = np.hypot(walls[:, 2] - walls[:, 0], walls[:, 3] - walls[:, 1])
    pieces = np.ceil(2.0 * lengths / side).astype(np.int64) + 1
    wall = np.repeat(np.arange(len(walls)), pieces)
    first = np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = (np.arange(len(wall)) - first) / (pieces[wall] - 1).clip(1)
    on_walls = walls[wall, :2] + share[:, None] * (walls[wall, 2:] - walls[wall, :2])
    low, high = low - 2.0 * side, high + 2.0 * side
    columns, rows = (np.ceil((high - low) / side).astype(np.int64) + 1).tolist()
    held = np.zeros((columns, rows), dtype=np.bool_)
    i, j = np.floor((on_walls - low) / side).astype(np.int64).T
    # A place up to a quarter of a square off, and a step of one: two squares to either side.
    for across in range(-2, 3):
        for up in range(-2, 3):
            held[np.clip(i + across, 0, columns - 1), np.clip(j + up, 0, rows - 1)] = True
    column, row = ((start - low) / side).astype(np.int64).T
    return held[column, row]
