"""People who have stood for a minute although they want to move, and whom that is due to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.journeys.waiting import waiting
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.running.blocking import Blockers, want_to_move
from mesa_mobility.crowd.running.last_minute import MINUTE, LastMinute, Snapshot, ways_left
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import LAST_FRAME
from mesa_mobility.errors import ContentError
from mesa_mobility.schema import Array, Flag, Kind, Members, Several, Whole

GOT_ON = 0.5
"""Metres that somebody has to be away from where they were a minute ago, and that somebody ahead
has to come nearer for it to be a jam that moves."""

AHEAD = 2.0
"""Metres within which somebody ahead who gets on is a reason to stand."""

FAR = 3.0
"""Metres that somebody has to have been away within the minute to have walked, not stood: on rounds
people come by the same places again.  To and fro in a conflict is less."""

LOOK_EVERY = 5
"""Seconds from one look at who was ahead, or how far away somebody was, to the next."""

_NEVER = -1


@dataclass(frozen=True)
class Blocked:
    """Somebody who has stood for a minute although they want to move, without a reason.

    Attributes:
        person: their row.
        since: seconds at which they have come to stand.
        ring: rows of whoever was in their way when they were reported, of whoever was in the way of
            that one, and so on, as ``PedestrianModel.blocked_by`` gives them.
    """

    person: int
    since: float
    ring: tuple[int, ...]


class StandingWatch(Saved):
    """Finds people who stand, once a simulated second.

    Somebody stands who is less than 0.5 m from where they were 60 s ago, and has not been 3 m away
    in between. Reasons to stand are a
    wait, no way to go, and a jam that moves: within that minute somebody within 2 m of them, with
    a shorter way to go, has come nearer by 0.5 m or left.

    Attributes:
        reported: by row, everybody who has been found so far, in the order of time.
        nobody_can_move: whether some want to move, all of them stand, and nobody waits.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_looked": Whole(_NEVER, LAST_FRAME),
        "nobody_can_move": Flag(),
        "_reason": Array("i4", ("known",), _NEVER, LAST_FRAME),
        "_moved": Array("i4", ("known",), _NEVER, LAST_FRAME),
        "_rows": Several(Whole(below="people")),
        "_since": Several(Whole(high=LAST_FRAME)),
        "_standing": Several(Whole(below="people")),
        "_chains": Several(Several(Whole(below="people"))),
    }

    def __init__(self) -> None:
        self.nobody_can_move = False
        self.minute = LastMinute()
        self._looked = _NEVER
        # Second at which each last waited or had no way, and was last far away or beside somebody
        # ahead who got on.
        self._reason = np.empty(0, dtype=np.int32)
        self._moved = np.empty(0, dtype=np.int32)
        self.reported: dict[int, Blocked] = {}
        self._standing: list[int] = []

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {**self.saved, "minute": Members(self.minute.members())}

    def state(self) -> dict[str, Any]:
        """All that changes while a model runs."""
        every = self.reported.values()
        return {
            "_looked": self._looked,
            "nobody_can_move": self.nobody_can_move,
            "_reason": self._reason,
            "_moved": self._moved,
            "_rows": [each.person for each in every],
            "_since": [round(each.since) for each in every],
            "_chains": [list(each.ring) for each in every],
            "_standing": self._standing,
            "minute": self.minute.state(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given.

        Raises:
            ContentError: somebody stands who has not been reported, or the last minute is damaged.
        """
        if unknown := set(state["_standing"]) - set(state["_rows"]):
            raise ContentError(f"standing, _standing: got {min(unknown)}, expected one of _rows")
        self.minute.restore(state["minute"])
        self._looked, self.nobody_can_move = state["_looked"], state["nobody_can_move"]
        self._reason, self._moved = state["_reason"].copy(), state["_moved"].copy()
        self._standing = list(state["_standing"])
        columns = (state[name] for name in ("_rows", "_since", "_chains"))
        self.reported = {
            row: Blocked(row, float(since), tuple(chain))
            for row, since, chain in zip(*columns, strict=True)
        }

    @property
    def now(self) -> list[Blocked]:
        """People found standing when the model was last looked at, in the order of their rows."""
        return [self.reported[row] for row in self._standing]

    def look(self, model: World) -> None:
        """Look at everybody inside, if a second has begun at which they have not been looked at."""
        second, part = divmod(model.frame, FRAMES_A_SECOND)
        if part or second == self._looked:
            return
        self._looked = second
        rows, crowd = model.population.present, model.crowd
        self._make_room(model.population.count)
        wants = want_to_move(rows, model)
        self._reason[rows[~wants]] = second
        self.minute.add(second, rows, crowd)
        before = self.minute.at(second - MINUTE)
        standing = rows[:0]
        if before is not None:
            x, y, _ = before.of(rows)
            apart = np.hypot(crowd.x[rows] - x, crowd.y[rows] - y)
            stood = (apart < GOT_ON) & (self._reason[rows] < second - MINUTE)
            if stood.any():
                standing = self._who_stand(second, rows[stood], model)
        self._report(second, standing, model)
        some = bool(wants.any()) and len(standing) == int(wants.sum())
        self.nobody_can_move = some and not waiting(rows, model.frame, crowd).any()

    def _make_room(self, people: int) -> None:
        more = people - len(self._reason)
        if more > 0:
            never = np.full(more, _NEVER, dtype=np.int32)
            self._reason = np.append(self._reason, never)
            self._moved = np.append(self._moved, never)

    def _who_stand(self, second: int, rows: NDArray[np.int64], model: World) -> NDArray[np.int64]:
        """The people in ``rows`` who have not walked for a minute, and ahead of whom nobody got on.

        All people in ``rows`` are where they were a minute ago.
        """
        first = second - MINUTE
        left = rows[(self._moved[rows] == _NEVER) | (self._moved[rows] < first)]
        # The latest first: it is a reason for longest.
        for when in range((second - 1) // LOOK_EVERY * LOOK_EVERY, first - 1, -LOOK_EVERY):
            snapshot = self.minute.at(when)
            if not len(left) or snapshot is None:
                break
            found = _away_or_beside_who_got_on(left, snapshot, model)
            self._moved[left[found]] = when
            left = left[~found]
        return left

    def _report(self, second: int, standing: NDArray[np.int64], model: World) -> None:
        """Note who stands now; nobody is reported twice."""
        self._standing = standing.tolist()
        new = [row for row in self._standing if row not in self.reported]
        if new:
            blockers = Blockers(model, self.minute)
            blockers.of(new)
            for row in new:
                chain = tuple(blockers.chain(row))
                self.reported[row] = Blocked(row, float(second - MINUTE), chain)


def _away_or_beside_who_got_on(
    rows: NDArray[np.int64], then: Snapshot, model: World
) -> NDArray[np.bool_]:
    """(n,) whether each was far from here at a second, or had somebody with a shorter way within
    2 m who has come nearer to where they want to go since, or has left."""
    crowd = model.crowd
    x, y, ways = then.of(rows)
    their_x, their_y, their_ways = then.of(then.rows)
    low, high = (np.array([f(x), f(y)]) for f in (np.min, np.max))
    near = (their_x >= low[0] - AHEAD) & (their_x <= high[0] + AHEAD)
    near &= (their_y >= low[1] - AHEAD) & (their_y <= high[1] + AHEAD)
    with np.errstate(invalid="ignore"):  # nobody comes nearer without a way
        nearer = their_ways - ways_left(then.rows, crowd) >= GOT_ON
    others = np.flatnonzero(near & (nearer | ~crowd.active[then.rows]))
    found: NDArray[np.bool_] = np.hypot(crowd.x[rows] - x, crowd.y[rows] - y) > FAR
    if len(others):
        tree = cKDTree(np.column_stack([their_x[others], their_y[others]]))
        beside = tree.query_ball_point(np.column_stack([x, y]), AHEAD)
        who = np.repeat(np.arange(len(rows)), [len(each) for each in beside])
        whom = others[np.concatenate([np.empty(0, np.int64), *beside]).astype(np.int64)]
        ahead = their_ways[whom] < ways[who]
        found[who[ahead]] = True
    return found
