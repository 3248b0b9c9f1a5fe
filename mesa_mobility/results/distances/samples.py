"""Figures of single people for a comparison of crowds: dwell times, headways, lanes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.results.distances.view import View
from mesa_mobility.results.measures.lanes import lane_order
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]

LANE_M = 0.35
"""How far to the side somebody may be to count as ahead, metres."""
EVERY_S = 1.0
WINDOW_S = 1.5
"""Seconds over which speeds are taken, about a gait cycle."""
LEAST_WAY = 0.5
"""Way along the direction that shows which way a person walks, metres."""


def speeds(tracks: Tracks, view: View) -> FloatArray:
    """(k,) m/s over 1.5 s, once a second, of everybody who is in the area in the middle of it."""
    half = max(round(WINDOW_S * tracks.frame_rate / 2), 1)
    start, end = tracks.steps(2 * half)
    # Rows of a person are in the order of frames, so none is missing in between.
    at = np.empty(len(tracks.by_person), dtype=np.int64)
    at[tracks.by_person] = np.arange(len(at))
    middle = tracks.by_person[at[start] + half]
    every = max(round(EVERY_S * tracks.frame_rate), 1)
    counted = (tracks.frame[middle] - tracks.frame[0]) % every == 0
    counted &= shapely.contains_xy(view.area, tracks.x[middle], tracks.y[middle])
    start, end = start[counted], end[counted]
    gone = np.hypot(tracks.x[end] - tracks.x[start], tracks.y[end] - tracks.y[start])
    return gone * tracks.frame_rate / (2 * half)


def densities(moments: Sequence[Moment], view: View) -> FloatArray:
    """(k,) persons/m2 in the area, once a second."""
    assert view.area is not None
    return np.array([np.count_nonzero(each.inside) for each in moments]) / view.area.area


def dwell_times(tracks: Tracks, view: View) -> FloatArray:
    """(k,) seconds from the first to the last frame in the area, of people who were outside before
    and after."""
    assert view.area is not None
    rows = tracks.by_person
    inside = shapely.contains_xy(view.area, tracks.x[rows], tracks.y[rows])
    person, frame = tracks.person[rows], tracks.frame[rows]
    first, last = _ends(person), _ends(person[::-1])
    last = len(rows) - 1 - last[::-1]
    people = person[first]
    at = np.flatnonzero(inside)
    enters, leaves = np.full(len(people), -1), np.full(len(people), -1)
    number = np.searchsorted(people, person[at])
    enters[number[::-1]] = at[::-1]
    leaves[number] = at
    whole = (enters > first) & (leaves < last)
    return (frame[leaves[whole]] - frame[enters[whole]]) / tracks.frame_rate


def _ends(person: NDArray[np.int32]) -> NDArray[np.int64]:
    """First position of each person in a column in which everybody's rows are together."""
    return np.flatnonzero(np.concatenate([[True], person[1:] != person[:-1]]))


class Moment(NamedTuple):
    """Where people are at one time.

    Attributes:
        along: (n,) metres along the view's direction.
        across: (n,) metres to the left of that direction.
        way: (n,) which way each person walks on the whole: +1 along the direction, -1 against it, 0
            for people who hardly move.
        inside: (n,) whether they are in the area.
    """

    along: FloatArray
    across: FloatArray
    way: FloatArray
    inside: NDArray[np.bool_]


def distance_headways(moments: Sequence[Moment]) -> FloatArray:
    """(k,) metres along the direction from everybody in the area to the next person who walks the
    same way and is at most 0.35 m to the side."""
    found = []
    for along, across, way, inside in moments:
        ahead = (along[None] - along[:, None]) * way[:, None]
        beside = np.abs(across[None] - across[:, None]) <= LANE_M
        seen = beside & (way[None] == way[:, None]) & (ahead > 0.0)
        gap = np.where(seen, ahead, np.inf).min(axis=1, initial=np.inf)
        found.append(gap[inside & np.isfinite(gap)])
    return np.concatenate(found) if found else np.empty(0)


def lane_orders(moments: Sequence[Moment]) -> FloatArray:
    """(k,) order of lanes in the area, at each time at which somebody walks there."""
    found = []
    for _, across, way, inside in moments:
        here = inside & (way != 0)
        if here.any():
            found.append(lane_order(across[here], way[here]))
    return np.array(found)


def ways(tracks: Tracks, direction: tuple[float, float]) -> FloatArray:
    """(m,) by number of the person: +1 for those who get ahead along the direction, -1 for those
    who go the other way, 0 for those who hardly move."""
    ex, ey = np.asarray(direction) / np.hypot(*direction)
    along = tracks.x * ex + tracks.y * ey
    rows = tracks.by_person
    first = _ends(tracks.person[rows])
    last = np.append(first[1:], len(rows)) - 1
    gone = along[rows[last]] - along[rows[first]]
    sign = np.zeros(int(tracks.person.max(initial=-1)) + 1)
    sign[tracks.person[rows[first]]] = np.where(np.abs(gone) >= LEAST_WAY, np.sign(gone), 0.0)
    return sign


def moments(tracks: Tracks, view: View) -> list[Moment]:
    """Where people are once a second."""
    assert view.direction is not None
    ex, ey = np.asarray(view.direction) / np.hypot(*view.direction)
    along = tracks.x * ex + tracks.y * ey
    across = tracks.y * ex - tracks.x * ey
    inside = shapely.contains_xy(view.area, tracks.x, tracks.y)
    way = ways(tracks, view.direction)[tracks.person]
    every = max(round(EVERY_S * tracks.frame_rate), 1)
    offsets = tracks.frame_offsets
    start = int(tracks.frame[0])
    frames = range(start, tracks.frames, every)
    rows_at = [slice(offsets[k], offsets[k + 1]) for k in frames]
    return [Moment(along[at], across[at], way[at], inside[at]) for at in rows_at]
