"""Who stands for a minute without a reason, who is lost, and who hits what.

It counts from recorded positions and from what the scene itself has told its people to do. It takes
nothing from the model's own report of stalls, nor from its collision tests.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from benchmarks.conflicts.ways import Ways

FloatArray = NDArray[np.float64]

MINUTE = 60
"""Seconds after which somebody who has not got anywhere stands."""

GOT_ON = 0.5
"""Metres that somebody has to be away from where they were a minute ago."""

AHEAD = 2.0
"""Metres within which somebody ahead who got on is a reason to stand: both are in a jam."""

LOOK_EVERY = 5
"""Seconds between two looks: at who is ahead, and from one minute in which somebody stood to the
next that is asked for a reason."""

TOUCH = 0.001
"""Metres by which two bodies must overlap to count."""

EVERY = 10
"""Frames from one count of overlaps to the next."""

OFF_FLOOR = 0.02
"""Metres off the floor that count: an exit may lie 1 cm off its edge."""

SLOW = 1.5
"""Somebody who would need the whole run for this many times their way is under way, not lost."""


@dataclass(frozen=True)
class Known:
    """What a scene knows of its people besides their places, second by second.

    Attributes:
        goals: where people want to go: exits, areas, points.
        goal: (seconds, people) index of the goal of each; -1 before they come and after they leave.
        excused: (seconds, people) whether somebody has been told to stand, or has no way: before
            they set off, during a visit, in a line that moves on, while a door is closed.
        speeds: (people,) preferred speeds, m/s.
    """

    goals: Sequence[BaseGeometry]
    goal: NDArray[np.int64]
    excused: NDArray[np.bool_]
    speeds: FloatArray


@dataclass(frozen=True)
class Standing:
    """Who stood and who is lost.

    Attributes:
        stood: the second from which each person stood for a minute without a reason.
        lost: those who are inside at the end without a reason.
    """

    stood: dict[int, int]
    lost: list[int]


def find_standing(places: FloatArray, known: Known, ways: Ways) -> Standing:
    """Who stood for a minute without a reason, and who is still inside without one.

    Args:
        places: (seconds, people, 2) metres, from 0 s on; NaN before people come and after they
            leave.
        known: what they were told.
        ways: the ways on the floor.
    """
    lengths = _Lengths(places, known, ways)
    seconds, people = known.goal.shape
    still = np.zeros((seconds, people), dtype=np.bool_)
    if seconds > MINUTE:
        away = np.hypot(*(places[MINUTE:] - places[:-MINUTE]).transpose(2, 0, 1))
        still[: seconds - MINUTE] = away < GOT_ON  # false where they have left
        told = np.cumsum(np.vstack([np.zeros((1, people), dtype=np.int64), known.excused]), axis=0)
        still[: seconds - MINUTE] &= told[MINUTE + 1 :] == told[: seconds - MINUTE]
    stood = dict[int, int]()
    for person in range(people):
        begins = np.flatnonzero(still[:, person])[::LOOK_EVERY].tolist()
        found = next((each for each in begins if not lengths.in_a_jam(person, each)), None)
        if found is not None:
            stood[person] = found
    inside = np.flatnonzero(np.isfinite(places[-1, :, 0])).tolist() if seconds else []
    lost = [person for person in inside if not lengths.on_the_way(person)]
    return Standing(stood, lost)


class _Lengths:
    """Lengths of ways at the times at which they are asked for."""

    def __init__(self, places: FloatArray, known: Known, ways: Ways) -> None:
        self._places, self._known, self._ways = places, known, ways
        self._found: dict[tuple[int, int], FloatArray] = {}

    def to(self, goal: int, second: int) -> FloatArray:
        """(people,) metres to one goal of everybody inside; NaN for others."""
        if (goal, second) not in self._found:
            xy = self._places[second]
            inside = np.isfinite(xy[:, 0])
            lengths = np.full(len(xy), np.nan)
            lengths[inside] = self._ways.lengths(xy[inside], self._known.goals[goal])
            self._found[goal, second] = lengths
        return self._found[goal, second]

    def in_a_jam(self, person: int, second: int) -> bool:
        """Whether somebody was ahead of a person who stood from a second on, within 2 m at any time
        of that minute, and got on in the rest of it."""
        end = second + MINUTE
        for when in range(second, end, LOOK_EVERY):
            xy, goal = self._places[when], int(self._known.goal[when, person])
            near = np.hypot(*(xy - xy[person]).T) <= AHEAD
            mine = self.to(goal, when)
            if not np.isfinite(mine[person]):
                raise ValueError(f"person {person} at {when} s: no way to their goal was found")
            ahead = np.flatnonzero(near & (mine < mine[person])).tolist()
            if any(self._got_on(each, when, end) for each in ahead):
                return True
        return False

    def _got_on(self, person: int, second: int, later: int) -> bool:
        goal, then = self._known.goal[[second, later], person].tolist()
        if goal != then:  # has left, or has been where they wanted to go
            return True
        lengths = [self.to(goal, when)[person] for when in (second, later)]
        return bool(lengths[0] - lengths[1] >= GOT_ON)

    def on_the_way(self, person: int) -> bool:
        """Whether somebody inside at the end has been told to stand, or is that slow."""
        known, last = self._known, len(self._places) - 1
        if known.excused[last, person]:
            return True
        here = np.flatnonzero(np.isfinite(self._places[:, person, 0]))
        start = int(here[0])
        whole = self.to(int(known.goal[start, person]), start)[person]
        left = self.to(int(known.goal[last, person]), last)[person]
        free = len(here) - int(known.excused[here, person].sum())
        moved = last - start < MINUTE or bool(
            np.hypot(*(self._places[last, person] - self._places[last - MINUTE, person])) >= GOT_ON
        )
        return moved and SLOW * max(whole, left) / known.speeds[person] > free


def count_overlaps(points: FloatArray, radii: FloatArray) -> int:
    """Pairs of bodies, (n, 2) and (n,) metres, that overlap by more than a millimetre."""
    if len(points) < 2:
        return 0
    pairs = cKDTree(points).query_pairs(2.0 * float(radii.max()), output_type="ndarray")
    apart = np.hypot(*(points[pairs[:, 0]] - points[pairs[:, 1]]).T)
    return int((apart < radii[pairs[:, 0]] + radii[pairs[:, 1]] - TOUCH).sum())


def count_crossings(track: FloatArray, walls: shapely.STRtree) -> int:
    """Pieces of a track, (n, 2) metres frame by frame, of ten steps each, that meet a wall."""
    pieces = [
        shapely.linestrings(track[first : first + EVERY + 1])
        for first in range(0, len(track) - 1, EVERY)
    ]
    if not pieces:
        return 0
    hit, _ = walls.query(np.array(pieces), predicate="intersects")
    return len(np.unique(hit))
