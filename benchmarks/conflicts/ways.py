"""Lengths of the shortest ways round walls, found with shapely and SciPy alone."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.csgraph import shortest_path
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

FloatArray = NDArray[np.float64]

MARGIN = 0.08
"""Metres that a way keeps from walls: less than the smallest body's radius, 0.128 m."""

ROUND = 0.1
"""Metres from both walls of a corner at which ways bend."""

APART = 0.25
"""Metres between the points of an exit, or of the edge of an area, to which ways lead."""

AT_ONCE = 16
"""Corners to which lines of sight are tested at once, the most promising ones first."""


class Ways:
    """The shortest ways on a floor: straight lines and corners (a visibility graph).

    They end 0.1 m before an exit, from where it can be seen along a wall.

    Args:
        floor: where people may be, metres.
        walls: (m, 4) x1, y1, x2, y2 in metres, with openings cut out.
    """

    def __init__(self, floor: BaseGeometry, walls: ArrayLike) -> None:
        self._floor = floor
        segments = np.asarray(walls, dtype=np.float64).reshape(-1, 2, 2)
        self._walls = shapely.STRtree(shapely.linestrings(segments))
        self.corners = _corners(floor)
        count = len(self.corners)
        first, second = np.triu_indices(count, 1)
        lengths = np.full((count, count), np.inf)
        seen = self.clear(self.corners[first], self.corners[second])
        between = np.hypot(*(self.corners[first] - self.corners[second]).T)
        lengths[first[seen], second[seen]] = between[seen]
        self._between = shortest_path(lengths, directed=False) if count else np.empty((0, 0))
        self._goals: dict[bytes, tuple[FloatArray, FloatArray]] = {}

    def clear(self, here: FloatArray, there: FloatArray) -> NDArray[np.bool_]:
        """(n,) whether a straight line from (n, 2) to (n, 2) metres keeps the margin from walls."""
        seen = np.ones(len(here), dtype=np.bool_)
        if len(here):
            lines = shapely.linestrings(np.stack([here, there], axis=1))
            hit, _ = self._walls.query(lines, predicate="dwithin", distance=MARGIN)
            seen[hit] = False
        return seen

    def lengths(self, points: ArrayLike, goal: BaseGeometry) -> FloatArray:
        """(n,) metres from (n, 2) points to a goal: exits (lines), a point or an area."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        ends, from_corners = self._goal(goal)
        best = self._straight(xy, ends)
        best[shapely.intersects_xy(goal, *xy.T)] = 0.0
        least = np.hypot(*(xy[:, None] - self.corners[None]).transpose(2, 0, 1)) + from_corners
        order = np.argsort(least, axis=1)
        for start in range(0, len(self.corners), AT_ONCE):
            some = order[:, start : start + AT_ONCE]
            bound = np.take_along_axis(least, some, axis=1)
            row, column = np.nonzero(bound < best[:, None])
            if not len(row):
                break
            corner = some[row, column]
            seen = self.clear(xy[row], self.corners[corner])
            np.minimum.at(best, row[seen], least[row[seen], corner[seen]])
        return best

    def _goal(self, goal: BaseGeometry) -> tuple[FloatArray, FloatArray]:
        """Points of a goal, and the way to it from each corner."""
        if goal.wkb not in self._goals:
            ends = _points_of(goal, self._floor)
            straight = self._straight(self.corners, ends)
            lengths = (self._between + straight[None, :]).min(axis=1, initial=np.inf)
            self._goals[goal.wkb] = ends, np.minimum(lengths, straight)
        return self._goals[goal.wkb]

    def _straight(self, xy: FloatArray, ends: FloatArray) -> FloatArray:
        """(n,) straight lines to the nearest of the (k, 2) ends in view; infinite without one."""
        here, there = (each.ravel() for each in np.indices((len(xy), len(ends))))
        away = np.hypot(*(xy[here] - ends[there]).T)
        away[~self.clear(xy[here], ends[there])] = np.inf
        return away.reshape(len(xy), len(ends)).min(axis=1, initial=np.inf)


def _points_of(goal: BaseGeometry, floor: BaseGeometry) -> FloatArray:
    """(k, 2) points of a goal that can be seen along a wall: ``ROUND`` from an exit and its ends,
    and from the edge of an area."""
    if goal.geom_type == "Point":
        return shapely.get_coordinates(goal)
    points = []
    for part in getattr(goal, "geoms", [goal]):
        area = part.geom_type == "Polygon"
        line = part.exterior if area else part
        keep = 0.0 if area else min(ROUND, line.length / 2)
        steps = max(int(np.ceil((line.length - 2 * keep) / APART)), 1)
        along = np.linspace(keep, line.length - keep, steps + 1)
        places = shapely.get_coordinates(shapely.line_interpolate_point(line, along))
        ahead = shapely.get_coordinates(shapely.line_interpolate_point(line, along + 1e-3))
        behind = shapely.get_coordinates(shapely.line_interpolate_point(line, along - 1e-3))
        step = ahead - behind
        aside = ROUND * np.column_stack([-step[:, 1], step[:, 0]]) / np.hypot(*step.T)[:, None]
        sides = np.concatenate([places + aside, places - aside])
        points.append(sides[shapely.intersects_xy(part if area else floor, *sides.T)])
    return np.concatenate(points)


def _corners(floor: BaseGeometry) -> FloatArray:
    """(k, 2) places beside the corners round which ways bend, ``ROUND`` from both walls."""
    places = [np.empty((0, 2))]
    for part in getattr(floor, "geoms", [floor]):
        polygon = orient(part)  # the floor is on the left of each edge
        for ring in (polygon.exterior, *polygon.interiors):
            points = shapely.get_coordinates(ring)[:-1]
            steps = np.roll(points, -1, axis=0) - points
            steps /= np.hypot(*steps.T)[:, None]
            before = np.roll(steps, 1, axis=0)
            turn = before[:, 0] * steps[:, 1] - before[:, 1] * steps[:, 0]
            inward = np.column_stack([-(before + steps)[:, 1], (before + steps)[:, 0]])
            # Half the sum of two unit normals is as long as the cosine of half the turn.
            mitre = inward / np.maximum((inward**2).sum(axis=1) / 2.0, 0.1)[:, None]
            places.append((points + ROUND * mitre)[turn < -1e-6])
    return np.concatenate(places)
