"""Where everybody has been in the last minute."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME, Crowd
from mesa_mobility.errors import ContentError
from mesa_mobility.schema import Array, Kind

MINUTE = 60
"""Seconds that are kept."""


def ways_left(rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.float64]:
    """(n,) metres that people in ``rows`` still have to go; infinite without a way.

    The crowd has the lengths at their last decisions. Since then, they have come nearer to the next
    point of the way.
    """
    x, y = crowd.target_x[rows], crowd.target_y[rows]
    before = np.hypot(x - crowd.from_x[rows], y - crowd.from_y[rows])
    now = np.hypot(x - crowd.x[rows], y - crowd.y[rows])
    ways: NDArray[np.float64] = crowd.route[rows] - (before - now)
    return ways


class Snapshot(NamedTuple):
    """The people inside at one second.

    Attributes:
        second: since the start.
        rows: (n,) of the people inside, rising.
        places: (3, n) x and y from ``origin``, metres, and the metres that each still has to go,
            infinite without a way.
        origin: (2,) x and y, metres.
    """

    second: int
    rows: NDArray[np.int64]
    places: NDArray[np.float32]
    origin: NDArray[np.float64]

    def of(self, rows: NDArray[np.int64]) -> NDArray[np.float64]:
        """(3, n) x, y and route lengths of these people; infinite for those who were not inside."""
        found = np.full((3, len(rows)), np.inf)
        if rows is self.rows:
            found[:] = self.places
        elif len(self.rows):
            at = np.minimum(np.searchsorted(self.rows, rows), len(self.rows) - 1)
            there = self.rows[at] == rows
            found[:, there] = self.places[:, at[there]]
        found[:2] += self.origin[:, None]
        return found


class LastMinute(Saved):
    """Positions and route lengths of the people inside, each second of the last minute."""

    saved: ClassVar[Mapping[str, Kind]] = {
        "seconds": Array("i8", ("seconds",), 0, LAST_FRAME, rising=True),
        "counts": Array("i8", ("seconds",), 0),
        "rows": Array("i8", ("seen",), 0, below="people"),
        "places": Array("f4", (3, "seen"), -2.0 * FARTHEST, 2.0 * FARTHEST, infinite=True),
        "origins": Array("f8", ("seconds", 2), -FARTHEST, FARTHEST),
    }

    def __init__(self) -> None:
        self._kept: deque[Snapshot] = deque()

    def add(self, second: int, rows: NDArray[np.int64], crowd: Crowd) -> None:
        """Keep where the people in ``rows`` are now."""
        kept = self._kept
        while kept and not second - MINUTE <= kept[0].second < second:
            kept.popleft()
        x, y, origin = crowd.x[rows], crowd.y[rows], np.zeros(2)
        if len(rows):
            # Far from the origin of a plan, single precision would not tell a step.
            origin = np.array([x[0], y[0]])
        places = np.empty((3, len(rows)), dtype=np.float32)
        places[0], places[1], places[2] = x - origin[0], y - origin[1], ways_left(rows, crowd)
        kept.append(Snapshot(second, rows, places, origin))

    def at(self, second: int) -> Snapshot | None:
        """The people inside at this second, if it is kept."""
        for each in self._kept:
            if each.second >= second:
                return each if each.second == second else None
        return None

    def state(self) -> dict[str, Any]:
        """All seconds one behind the other."""
        kept = self._kept
        return {
            "seconds": np.array([each.second for each in kept], dtype=np.int64),
            "counts": np.array([len(each.rows) for each in kept], dtype=np.int64),
            "rows": np.concatenate([np.empty(0, np.int64), *(each.rows for each in kept)]),
            "places": np.hstack([np.empty((3, 0), np.float32), *(each.places for each in kept)]),
            "origins": np.array([each.origin for each in kept]).reshape(-1, 2),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given.

        Raises:
            ContentError: the people of a second are not all there, or not in order.
        """
        counts, seen = state["counts"], len(state["rows"])
        if len(counts) > MINUTE + 1 or (counts > seen).any() or counts.sum() != seen:
            raise ContentError(
                f"last minute, counts: got {int(counts.sum())} people at {len(counts)} seconds, "
                f"expected {seen} at {MINUTE + 1} at most"
            )
        ends = np.cumsum(counts)
        self._kept = deque()
        for k, (end, count) in enumerate(zip(ends.tolist(), counts.tolist(), strict=True)):
            second = int(state["seconds"][k])
            rows = state["rows"][end - count : end].copy()
            if not (rows[1:] > rows[:-1]).all():
                raise ContentError(f"last minute, rows: not rising at {second} s")
            if self._kept and np.array_equal(rows, self._kept[-1].rows):
                rows = self._kept[-1].rows
            places = state["places"][:, end - count : end].copy()
            self._kept.append(Snapshot(second, rows, places, state["origins"][k].copy()))
