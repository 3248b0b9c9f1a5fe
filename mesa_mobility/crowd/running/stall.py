"""Detection of a stalled evacuation, and its reason."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAME_SECONDS, FRAMES_A_SECOND
from mesa_mobility.crowd.running.blocking import in_words
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.aggregates import Aggregates
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME, Crowd
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.schema import Array, Each, Kind, Maybe, Real, Several, Whole

STALL_SECONDS = 60.0
"""Time without progress after which an evacuation has stalled."""

NEARER_TOGETHER = 0.25
"""Metres by which people must come nearer on average for it to count as progress.  People in a
deadlock press closer by less."""

NEARER_ALONE = 10.0
"""Metres by which a single person must come nearer for it to count; jostling moves nobody that
far."""

ANOTHER_WAY = 3.0
"""Metres by which a route changes from one check to the next only if it is another route: a
movement takes 1.5 s at most, and nobody walks at 2 m/s."""


class StallWatch(Saved):
    """Checks the progress of the people inside once a simulated second.

    Progress is how much nearer to their exits they are on average than at the last progress. People
    in a jam who change places, or step back and forth, make none: their route lengths add up to the
    same. A single person who comes much nearer also counts, so that nobody on a long route is
    overlooked. After a change of route, progress is measured along the new one.

    A crowd of which nobody can move has stalled as well, once this watch has gone on for as long.

    Attributes:
        ring: rows of people who are in each other's way, once the run has stalled; empty if none
            are.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "ring": Several(Whole(below="people")),
        "_first": Whole(-1, LAST_FRAME),
        "_since": Real(0.0),
        "_look": Whole(high=2 * LAST_FRAME),
        "_mark": Each(Whole(-1), Whole(), Whole()),
        "_route": Array("f8", ("known",), -FARTHEST, FARTHEST, infinite=True),
        "_start": Array("f8", ("known",), -FARTHEST, FARTHEST, infinite=True),
        "_begun": Maybe(
            Each(
                Array("i8", ("those",), 0, below="people"),
                Array("f8", ("those",), -FARTHEST, FARTHEST, infinite=True),
            )
        ),
    }

    def __init__(self) -> None:
        self.ring: list[int] = []
        self._first = -1
        self._since = 0.0
        self._look = 0
        self._mark: tuple[int, int, int] = (-1, 0, 0)
        self._route = np.empty(0)
        self._start = np.empty(0)
        self._begun: tuple[NDArray[np.int64], NDArray[np.float64]] | None = None

    def stalled(
        self,
        frame: int,
        rows: NDArray[np.int64],
        crowd: Crowd,
        seen: Aggregates,
        gone: int,
        crossed: int,
        nobody_can_move: bool = False,
    ) -> bool:
        """Whether there has been no progress for ``STALL_SECONDS``, or nobody can move.

        Args:
            frame: now.
            rows: the people inside.
            crowd: the crowd.
            seen: aggregates of the people inside.
            gone: people who have left so far.
            crossed: gates that people have crossed on their journeys so far.
            nobody_can_move: whether everybody who wants to move has stood for a minute.
        """
        if self._first < 0:
            self._first = frame
        elapsed = frame * FRAME_SECONDS
        now = (gone, seen.going, crossed)
        # Others may be standing because one person has not set off yet.
        if seen.awaited or now != self._mark:
            self._begin(elapsed, rows, crowd)
            self._mark = now
        elif frame >= self._look:
            self._look = frame + FRAMES_A_SECOND
            gained = self._gained(rows, crowd)
            if gained.sum() > NEARER_TOGETHER * len(rows) or (gained > NEARER_ALONE).any():
                self._begin(elapsed, rows, crowd)
        since = self._first * FRAME_SECONDS if nobody_can_move else self._since
        return seen.people > 0 and elapsed - since >= STALL_SECONDS - 1e-9

    def _begin(self, elapsed: float, rows: NDArray[np.int64], crowd: Crowd) -> None:
        self._since = elapsed
        # Laid out by row only when it is compared with: where people leave, it begins each step.
        self._begun = rows, crowd.route[rows]

    def _gained(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.float64]:
        """(n,) metres by which those in ``rows`` are nearer than at the last progress; 0 without a
        route."""
        if self._begun is not None:
            those, routes = self._begun
            self._route = np.full(len(crowd.route), np.inf)
            self._route[those] = routes
            self._start, self._begun = self._route.copy(), None
        # A crowd from a checkpoint may have fewer records, none of them of people less.
        more = max(len(crowd.route) - len(self._route), 0)
        self._route = np.append(self._route, np.full(more, np.inf))
        self._start = np.append(self._start, np.full(more, np.inf))
        route, before, start = crowd.route[rows], self._route[rows], self._start[rows]
        with_way = np.isfinite(route)
        known = with_way & np.isfinite(before)
        jump = np.where(known, route, 0.0) - np.where(known, before, 0.0)
        start = np.where(known, start + np.where(np.abs(jump) > ANOTHER_WAY, jump, 0.0), route)
        self._route[rows], self._start[rows] = route, start
        return np.where(with_way, start, 0.0) - np.where(with_way, route, 0.0)


def stall_reason(
    plan: FloorPlan,
    seen: Aggregates,
    ring: Sequence[int] = (),
    upstairs: Sequence[int] = (),
    shut_in: Sequence[int] = (),
) -> str:
    """Why an evacuation has stalled, in a few words.

    Args:
        plan: the floor plan.
        seen: aggregates of the people inside.
        ring: rows of people who are in each other's way.
        upstairs: rows of people who would have to climb stairs, which they cannot.
        shut_in: rows of people in lifts whose doors are closed.
    """
    if plan.exits and not plan.open_exits():
        return "every exit is closed"
    if seen.going == 0:
        reasons = [
            f"people {in_words(those)} {why}"
            for those, why in (
                (upstairs, "cannot use stairs"),
                (shut_in, "are in lifts whose doors are closed"),
            )
            if those
        ]
        return "nobody inside has a way to go" + ": " * bool(reasons) + "; ".join(reasons)
    said = f"nobody has come nearer to an exit for {STALL_SECONDS:.0f} s"
    return f"{said}: people {in_words(ring)} are in each other's way" if ring else said
