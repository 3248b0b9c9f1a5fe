"""Stays: who is at a place of their route, where they stand, and until when."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.place import Place
from mesa_mobility.crowd.journeys.visit import Visit
from mesa_mobility.crowd.journeys.waiting import end_wait, frames_of, wait_until
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME, Crowd
from mesa_mobility.distributions import Distribution
from mesa_mobility.schema import Array, Kind

THERE = 0.3
"""Metres from their spot at which a person stops."""

GIVES_UP = 10 * FRAMES_A_SECOND
"""Frames after which a person who has not reached their spot stays where they are."""

_WALKING = -1


class Stays(Saved):
    """The people who stay at a place of their route. Rows are those of the crowd.

    People who arrive get a spot to stand at, walk there, and stand from then on. Where as many are
    as a place holds, those who come are in line before it. Nothing is computed before the first has
    arrived.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_place": Array("i8", ("known",), -1),
        "_spot": Array("f8", ("known", 2), -FARTHEST, FARTHEST),
        "_came": Array("i8", ("known",), -1, LAST_FRAME),
        "_stay": Array("i8", ("known",), -1, LAST_FRAME),
        "_until": Array("i8", ("known",), -1, LAST_FRAME),
        "_line": Array("i8", ("known",), -1),
        "_since": Array("i8", ("known",), -1, LAST_FRAME),
    }

    def __init__(self) -> None:
        self._place = np.empty(0, dtype=np.int64)
        self._spot = np.empty((0, 2))
        self._came = np.empty(0, dtype=np.int64)
        self._stay = np.empty(0, dtype=np.int64)
        self._until = np.empty(0, dtype=np.int64)
        # Number of the place before which each is in line, and since which frame.
        self._line = np.empty(0, dtype=np.int64)
        self._since = np.empty(0, dtype=np.int64)

    @property
    def places(self) -> NDArray[np.int64]:
        """Numbers of the places of the rows, then of those before which they are in line, -1 for
        none; there may be more rows than people."""
        return np.concatenate([self._place, self._line])

    def in_line(self, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """(n,) whether each in ``rows`` waits before a place that is full."""
        if not len(self._line):
            return np.zeros(len(rows), dtype=np.bool_)
        known = rows < len(self._line)
        found: NDArray[np.bool_] = known & (self._line[np.where(known, rows, 0)] >= 0)
        return found

    def spots(self, rows: NDArray[np.int64]) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """Indices among ``rows`` of those on the way to a spot, and their (k, 2) spots, metres."""
        if not len(self._place):
            return np.empty(0, dtype=np.intp), np.empty((0, 2))
        known = rows < len(self._place)
        there = np.where(known, rows, 0)
        walking = known & (self._place[there] >= 0) & (self._until[there] == _WALKING)
        who = np.flatnonzero(walking)
        return who, self._spot[rows[who]]

    def stands(self, row: int) -> bool:
        """Whether somebody stands at a place."""
        return row < len(self._place) and self._place[row] >= 0 and self._until[row] != _WALKING

    def end(self, row: int, frame: int, crowd: Crowd) -> None:
        """End a person's stay at a place, if they have one."""
        if self.stands(row):
            end_wait(row, frame, crowd)
        if row < len(self._place):
            self._place[row] = self._line[row] = -1

    def over(
        self,
        row: int,
        alike: Sequence[int],
        place: Place,
        frame: int,
        crowd: Crowd,
        rng: np.random.Generator,
    ) -> bool:
        """Whether a person has stayed at a place for their whole stay.

        Args:
            row: the person, who decides now.
            alike: numbers of the place, that of the person's body first.
            place: the place to which they go, or at which they are.
            frame: now.
            crowd: the crowd.
            rng: the model's generator, from which stays and spots are drawn.
        """
        x, y = float(crowd.x[row]), float(crowd.y[row])
        if row >= len(self._place) or self._place[row] < 0:
            # There may be more rows here than in the crowd, none of them in use.
            known = self._place[: len(crowd.active)]
            others = np.flatnonzero((known >= 0) & crowd.active[: len(known)])
            if place.visit.capacity is not None:
                if not self._admitted(row, alike, place, frame, crowd):
                    return False
            elif not place.reached(x, y, int((self._place[others] == alike[0]).sum())):
                return False
            staying = int((self._place[others] == alike[0]).sum())
            stay = _frames(place.visit, rng)
            if stay == 0:
                return True
            spot = place.spot(x, y, staying, self._spot[others], rng)
            self._make_room(row + 1)
            self._place[row], self._spot[row], self._until[row] = alike[0], spot, _WALKING
            self._came[row], self._stay[row] = frame, stay
        if self._until[row] == _WALKING:
            sx, sy = self._spot[row]
            if math.hypot(sx - x, sy - y) <= THERE or frame - self._came[row] >= GIVES_UP:
                self._spot[row] = x, y
                self._until[row] = frame + self._stay[row]
                wait_until(np.array([row]), int(self._until[row]), crowd)
            return False
        if self._until[row] > frame:
            return False
        self._place[row] = -1
        return True

    def _admitted(
        self, row: int, alike: Sequence[int], place: Place, frame: int, crowd: Crowd
    ) -> bool:
        """Whether somebody who comes to a place of a capacity goes in; otherwise they are in line
        if they are near it."""
        self._make_room(row + 1)
        known = len(self._place[: len(crowd.active)])
        active = crowd.active[:known]
        staying = int((np.isin(self._place[:known], alike) & active).sum())
        waiting = np.isin(self._line[:known], alike) & active
        if not place.beside(float(crowd.x[row]), float(crowd.y[row]), staying + int(waiting.sum())):
            self._line[row] = -1
            return False
        if self._line[row] not in alike:
            self._line[row], self._since[row] = alike[0], frame
        since, own = self._since[:known], self._since[row]
        rows = np.arange(known)
        ahead = waiting & ((since < own) | ((since == own) & (rows < row)))
        assert place.visit.capacity is not None
        if int(ahead.sum()) >= place.visit.capacity - staying:
            return False
        self._line[row] = -1
        return True

    def _make_room(self, count: int) -> None:
        more = max(count, 2 * len(self._place)) - len(self._place)
        if count > len(self._place):
            none = np.full(more, -1, dtype=np.int64)
            self._place = np.append(self._place, none)
            self._spot = np.append(self._spot, np.zeros((more, 2)), axis=0)
            self._came, self._stay = np.append(self._came, none), np.append(self._stay, none)
            self._until = np.append(self._until, none)
            self._line, self._since = np.append(self._line, none), np.append(self._since, none)


def _frames(visit: Visit, rng: np.random.Generator) -> int:
    """Frames for which somebody stays."""
    seconds = visit.stay
    if isinstance(seconds, Distribution):
        seconds = float(np.asarray(seconds.draw(1, rng), dtype=np.float64).reshape(-1)[0])
    return int(frames_of(np.array([seconds], dtype=np.float64), "visit: stay")[0])
