"""Where and when a measured crowd is best measured, as its tracks say."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, Polygon

from mesa_mobility.results import crossings
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]
Point = tuple[float, float]

STEP_M = 0.05
"""Distance between the cuts of the floor of which the narrowest is taken, metres."""
AS_NARROW_M = 0.02
"""Cuts that are wider by less count as equally narrow, metres."""
BEYOND_M = 0.1
"""By how much a line is longer than the cut at either end, metres: heads lean over walls."""
MOST_CROSS = 0.9
"""Share of those who cross the busiest cut that a line must see, too."""
LONGEST_TRACKS = 0.1, 0.9
"""Between these quantiles of all places, along the direction, the area lies."""


def main_direction(tracks: Tracks) -> Point:
    """(x, y) of length 1: the axis of people's ways, towards the end to which most of them go."""
    rows = tracks.by_person
    starts = np.flatnonzero(np.diff(tracks.person[rows], prepend=-1))
    ends = np.append(starts[1:], len(rows)) - 1
    first, last = rows[starts], rows[ends]
    ways = np.column_stack([tracks.x[last] - tracks.x[first], tracks.y[last] - tracks.y[first]])
    _, axes = np.linalg.eigh(ways.T @ ways)
    axis = axes[:, -1]
    along = ways @ axis
    # In a two-way crowd of equal halves, rounding must not decide.
    sign = -1.0 if along.sum() < -1e-6 * np.abs(along).sum() else 1.0
    return float(sign * axis[0]), float(sign * axis[1])


def middle_area(tracks: Tracks, floor: shapely.Geometry, direction: Point) -> Polygon:
    """The floor without the parts where tracks begin and end: its largest piece between two lines
    across the direction, with a tenth of all places before and behind them."""
    along = tracks.x * direction[0] + tracks.y * direction[1]
    low, high = np.quantile(along, LONGEST_TRACKS)
    reach = _reach(floor)
    corners = ((low, -reach), (high, -reach), (high, reach), (low, reach))
    strip = Polygon([_at(direction, *corner) for corner in corners])
    pieces = shapely.get_parts(shapely.intersection(floor, strip))
    pieces = [each for each in pieces if isinstance(each, Polygon)]
    return max(pieces, key=lambda each: each.area, default=Polygon())


def narrowest_line(
    tracks: Tracks, floor: shapely.Geometry, direction: Point
) -> tuple[Point, Point] | None:
    """Both ends of the narrowest cut of the floor, across the direction, that people cross.

    Of equally narrow cuts, the one in the middle of all places is taken. None if nobody crosses
    any.
    """
    along = tracks.x * direction[0] + tracks.y * direction[1]
    low, middle, high = np.quantile(along, (0.02, 0.5, 0.98))
    reach = _reach(floor)
    cuts: list[tuple[float, float, LineString]] = []
    for place in np.arange(low, high, STEP_M):
        whole = LineString([_at(direction, place, -reach), _at(direction, place, reach)])
        for piece in shapely.get_parts(shapely.intersection(floor, whole)):
            if isinstance(piece, LineString) and piece.length > STEP_M:
                cuts.append((piece.length, abs(place - middle), piece))
    counts = np.array([len(np.unique(_crossed(tracks, cut))) for _, _, cut in cuts])
    if not counts.any():
        return None
    busy = [cut for cut, n in zip(cuts, counts, strict=True) if n >= MOST_CROSS * counts.max()]
    least = min(length for length, _, _ in busy)
    near = [cut for cut in busy if cut[0] <= least + AS_NARROW_M]
    line = min(near, key=lambda cut: cut[1])[2]
    a, b = _longer(line)
    return a, b


def steady_frames(tracks: Tracks, line: tuple[Point, Point]) -> tuple[int, int] | None:
    """First and last frame of steady flow: from when a sixth of the people have crossed a line to
    when five sixths have. None if fewer than six cross it."""
    found = crossings(tracks, *line)
    _, first = np.unique(found.person, return_index=True)
    frames = np.sort(found.time[first]) * tracks.frame_rate
    if len(frames) < 6:
        return None
    start, end = frames[round(len(frames) / 6) - 1], frames[round(len(frames) * 5 / 6) - 1]
    return int(np.ceil(start)), int(np.ceil(end))


def _crossed(tracks: Tracks, cut: LineString) -> NDArray[np.int64]:
    return np.asarray(crossings(tracks, *_longer(cut)).person)


def _longer(cut: LineString) -> tuple[Point, Point]:
    a, b = np.asarray(cut.coords)[0], np.asarray(cut.coords)[-1]
    more = BEYOND_M * (b - a) / np.hypot(*(b - a))
    (ax, ay), (bx, by) = a - more, b + more
    return (float(ax), float(ay)), (float(bx), float(by))


def _reach(floor: shapely.Geometry) -> float:
    """Distance from the origin beyond the floor, metres."""
    return float(np.abs(floor.bounds).max()) * 2.0 + 1.0


def _at(direction: Point, along: float, across: float) -> Point:
    """The point at these distances along the direction and to its left."""
    x, y = direction
    return along * x - across * y, along * y + across * x
