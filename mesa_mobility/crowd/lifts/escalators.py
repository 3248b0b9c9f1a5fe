"""The escalators of a model: whom they let on, and how they carry people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.waiting import wait_until
from mesa_mobility.crowd.lifts.belt_places import BeltPlaces, Near
from mesa_mobility.crowd.lifts.clear_way import way_is_clear
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES, OptionTable
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import CARRIED, LAST_FRAME, Crowd
from mesa_mobility.floorplan import Seam
from mesa_mobility.schema import Array, Kind

NOBODY = -1

EVERY = 3
"""Frames from one look at the belts to the next."""

AHEAD = 18
"""Frames for which a belt moves on for certain."""

FIRST = 0.4
"""Metres behind the line at which people step on within which they wait to be taken up."""

CREDIT = 1.0
"""Seconds by which people may catch up with the capacity after nobody has stepped on."""

OFF = 0.3
"""Metres before the end of a belt at which people walk on: they step off."""

_ROUNDING = 1e-6
"""A share of the way between two looks."""


class Escalators(Saved):
    """The escalators that move, and the people on them. Rows are those of the crowd.

    Whoever ends a movement on a belt stands there from then on and is carried to its end, where
    they walk on. All on a belt keep their distances, so they never meet. A belt goes on only if
    nobody is in the way of those whom it carries; otherwise it stands with all of them until the
    way is free. It takes people up from its first step one after the other, and nobody while it
    stands.

    Args:
        seams: those of the floor plan; the ones with belts count.
        reach: metres that people may cover with one movement, their bodies and those of riders
            included.

    Attributes:
        seams: (escalators,) those with belts.
        carried: (escalators,) people whom each has carried.
        stood_s: (escalators,) seconds for which each has stood with people on it.
    """

    def __init__(self, seams: Sequence[Seam], reach: float) -> None:
        self.seams = tuple(each for each in seams if each.belt is not None)
        # Between two looks a rider moves on by up to EVERY frames more.
        self._belts = [
            BeltPlaces(each, each.belt, reach, AHEAD + EVERY)
            for each in self.seams
            if each.belt is not None
        ]
        count = len(self.seams)
        self.carried, self._until, self._stood = np.zeros((3, count), np.int64)
        self._next_on = np.zeros(count)
        self._rides = np.empty(0, np.int64)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        belts, last = (len(self.seams),), len(self.seams) - 1
        return {
            "carried": Array("i8", belts, 0),
            "_until": Array("i8", belts, 0, 2 * LAST_FRAME),
            "_stood": Array("i8", belts, 0, LAST_FRAME),
            "_next_on": Array("f8", belts, 0.0),
            "_rides": Array("i8", ("known",), NOBODY, last),
        }

    def state(self) -> dict[str, Any]:
        """Who rides, when the next person may step on, and how far each belt moves for certain."""
        return {name: getattr(self, name) for name in self.members()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        for name in self.members():
            setattr(self, name, state[name])

    def __len__(self) -> int:
        return len(self.seams)

    @property
    def stood_s(self) -> NDArray[np.float64]:
        """(escalators,) seconds for which each has stood with people on it."""
        return np.multiply(self._stood, FRAME_SECONDS, dtype=np.float64)

    def riders(self, inside: NDArray[np.int64]) -> NDArray[np.int64]:
        """Rows of those inside whom an escalator carries."""
        self._make_room(inside)
        return inside[self._rides[inside] != NOBODY]

    def on_belts(self, inside: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """Rows of those inside whom an escalator carries or may take up."""
        points, found = np.column_stack([crowd.x[inside], crowd.y[inside]]), [self.riders(inside)]
        for belt in self._belts:
            near = belt.near(points)
            on = (near.along >= 0.0) & (near.along < belt.length) & (near.aside <= belt.half)
            found.append(inside[near.who[on]])
        return np.unique(np.concatenate(found))

    def looks(self, frame: int) -> bool:
        """Whether people may be taken up or carried on in this frame."""
        return frame % EVERY == 0

    def next_look(self, frame: int) -> int:
        """The next frame after this one in which something may happen."""
        return (frame // EVERY + 1) * EVERY

    def advance(
        self, frame: int, inside: NDArray[np.int64], crowd: Crowd, table: OptionTable
    ) -> None:
        """Take up those who have come onto a belt, and carry people on.

        Args:
            frame: now.
            inside: (n,) rows of the people inside.
            crowd: the crowd; those on belts get new movements.
            table: the movement options.
        """
        self._make_room(inside)
        # People who had to stop for a change of the plan have decided by themselves.
        riding = inside[self._rides[inside] != NOBODY]
        self._rides[riding[crowd.option[riding] != CARRIED]] = NOBODY
        # In frames between two looks, which some runs pass over, nothing happens.
        if not self.looks(frame) or not len(inside):
            return
        points = np.column_stack([crowd.x[inside], crowd.y[inside]])
        for number, belt in enumerate(self._belts):
            near = belt.near(points)
            near = near._replace(who=inside[near.who])
            self._move_on(number, near, frame, crowd, table)
            self._take_up(number, near, frame, crowd, table)

    def waits(self, rows: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(n,) whether people in ``rows`` who decide now at (n, 2) points, metres, stand on the
        first step of an escalator, which has not taken them up yet."""
        waits = np.zeros(len(rows), np.bool_)
        for belt in self._belts:
            near = belt.near(points)
            on = (near.along >= 0.0) & (near.along < FIRST) & (near.aside <= belt.half)
            waits[near.who[on]] = True
        return waits

    def _move_on(
        self, number: int, near: Near, frame: int, crowd: Crowd, table: OptionTable
    ) -> None:
        """Let a belt go on for a while if the way is free, with all on it."""
        belt, until = self._belts[number], max(int(self._until[number]), frame)
        ours = np.flatnonzero(self._rides[near.who] == number)
        ours = ours[np.argsort(-near.along[ours], kind="stable")]
        looks = np.ceil((belt.length - OFF - near.along[ours]) / belt.metres(EVERY) - _ROUNDING)
        leave = frame + EVERY * looks.astype(np.int64)
        blocked = False
        # Those in front get off by themselves, and are in the way of those behind until they have.
        for k, end in zip(ours.tolist(), leave.tolist(), strict=True):
            who = near.who[k : k + 1]
            if end > frame + AHEAD:
                break
            if end > frame:
                blocked = not self._is_clear(number, near, who, end, (frame, until), crowd, table)
                if blocked:
                    break
                carry(who, belt.velocity, belt.direction, frame, end, crowd)
            self._rides[who] = NOBODY
            self.carried[number] += 1
        rows = near.who[self._rides[near.who] == number]
        for end in () if blocked else (frame + AHEAD, until + EVERY):
            if self._is_clear(number, near, rows, end, (frame, until), crowd, table):
                until = end
                break
        self._until[number] = until
        if until > frame:
            carry(rows, belt.velocity, belt.direction, frame, until, crowd)
        elif len(rows):
            carry(rows, np.zeros(2), belt.direction, frame, frame + EVERY, crowd)
            self._stood[number] += EVERY

    def _take_up(
        self, number: int, near: Near, frame: int, crowd: Crowd, table: OptionTable
    ) -> None:
        """Carry those who have come onto a belt and stand there, the foremost first."""
        belt, until = self._belts[number], int(self._until[number])
        last = belt.length - OFF - belt.metres(AHEAD)
        on = (near.along >= 0.0) & (near.along < last) & (near.aside <= belt.half)
        on &= self._rides[near.who] == NOBODY
        on &= (crowd.end[near.who] <= frame) | (crowd.stride[near.who] == 0.0)
        now = frame * FRAME_SECONDS
        # People do not wait on the first step if somebody comes from behind them on the belt.
        behind = near.along[self._rides[near.who] == number].min(initial=FIRST)
        for k in np.flatnonzero(on)[np.argsort(-near.along[on], kind="stable")].tolist():
            who = near.who[k : k + 1]
            if near.along[k] < behind and (until <= frame or now < self._next_on[number]):
                continue
            if until <= frame:
                carry(who, np.zeros(2), belt.direction, frame, self.next_look(frame), crowd)
            elif self._is_clear(number, near, who, until, (frame, frame), crowd, table):
                carry(who, belt.velocity, belt.direction, frame, until, crowd)
            else:
                continue
            self._rides[who] = number
            since = max(self._next_on[number], now - max(belt.gap_s, CREDIT))
            self._next_on[number] = since + belt.gap_s

    def _is_clear(
        self,
        number: int,
        near: Near,
        riders: NDArray[np.int64],
        end: int,
        times: tuple[int, int],
        crowd: Crowd,
        table: OptionTable,
    ) -> bool:
        """Whether riders can be carried until a frame; ``times`` are now, and from when on."""
        if not len(riders):
            return True
        others = ~np.isin(near.who, riders) & (self._rides[near.who] != number)
        order = np.concatenate([np.flatnonzero(np.isin(near.who, riders)), np.flatnonzero(others)])
        whom = near.who[order]
        clear: bool = way_is_clear(
            whom[: len(riders)],
            whom[len(riders) :],
            near.shifts[order],
            self._belts[number].velocity,
            end,
            times,
            table,
            crowd.records,
        )
        return clear

    def _make_room(self, rows: NDArray[np.int64]) -> None:
        count = int(rows.max(initial=-1)) + 1
        more = max(count, 2 * len(self._rides)) - len(self._rides)
        if count <= len(self._rides):
            return
        self._rides = np.append(self._rides, np.full(more, NOBODY))


def carry(
    rows: NDArray[np.int64],
    velocity: NDArray[np.float64],
    direction: NDArray[np.float64],
    frame: int,
    end: int,
    crowd: Crowd,
) -> None:
    """Have people ride straight on until a frame, turned to where they ride, or stand.

    Args:
        rows: (n,) the people.
        velocity: (2,) m/s; 0 to stand.
        direction: (2,) unit vector to which they turn.
        frame: now.
        end: until when.
        crowd: the crowd.
    """
    way = velocity * ((end - frame) * FRAME_SECONDS)
    crowd.option[rows], crowd.gone[rows] = CARRIED, -1
    crowd.start[rows], crowd.end[rows], crowd.spacing[rows] = frame, end, end - frame
    crowd.knots[rows] = 2
    for axis, name in enumerate("xy"):
        here = getattr(crowd, name)[rows]
        there = here + way[axis]
        getattr(crowd, f"from_{name}")[rows], getattr(crowd, f"to_{name}")[rows] = here, there
        getattr(crowd, f"v{name}")[rows] = velocity[axis]
        crowd.box[rows, axis] = np.minimum(here, there)
        crowd.box[rows, axis + 2] = np.maximum(here, there)
    heading = crowd.heading[rows]
    turn = np.arctan2(direction[1], direction[0]) - heading
    crowd.from_heading[rows] = heading
    crowd.to_heading[rows] = heading + (turn + np.pi) % (2.0 * np.pi) - np.pi
    crowd.from_c[rows], crowd.from_s[rows] = np.cos(heading), np.sin(heading)
    crowd.stride[rows] = np.hypot(*way) * SAMPLE_FRAMES / (end - frame)
    if way.any():
        wait_until(rows, end, crowd)
