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
LEAST_WAY = 0.5
"""Way along the direction that shows which way a person walks, metres."""


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

    Fields: ``along`` and ``across`` (n,) metres along the direction and to its left; ``way`` (n,)
    which way each walks in the end: +1, -1, or 0 for those who hardly move; ``inside`` (n,) whether
    they are in the area.
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


def moments(tracks: Tracks, view: View) -> list[Moment]:
    """Where people are once a second."""
    assert view.direction is not None
    ex, ey = np.asarray(view.direction) / np.hypot(*view.direction)
    along = tracks.x * ex + tracks.y * ey
    across = tracks.y * ex - tracks.x * ey
    inside = shapely.contains_xy(view.area, tracks.x, tracks.y)
    rows = tracks.by_person
    first = _ends(tracks.person[rows])
    last = np.append(first[1:], len(rows)) - 1
    gone = along[rows[last]] - along[rows[first]]
    sign = np.zeros(int(tracks.person.max()) + 1)
    sign[tracks.person[rows[first]]] = np.where(np.abs(gone) >= LEAST_WAY, np.sign(gone), 0.0)
    way = sign[tracks.person]
    every = max(round(EVERY_S * tracks.frame_rate), 1)
    offsets = tracks.frame_offsets
    start = int(tracks.frame[0])
    frames = range(start, tracks.frames, every)
    rows_at = [slice(offsets[k], offsets[k + 1]) for k in frames]
    return [Moment(along[at], across[at], way[at], inside[at]) for at in rows_at]
