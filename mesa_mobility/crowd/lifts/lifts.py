"""The cars of a model's lifts: where they are, whom they let in, and when they go."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.lifts.rides import Rides
from mesa_mobility.crowd.lifts.spots import THERE, free_spot, swapped_spots
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME, Crowd
from mesa_mobility.crowd.state.twins import shift_people
from mesa_mobility.errors import ContentError
from mesa_mobility.floorplan import Shaft
from mesa_mobility.schema import Array, Kind

NOBODY = -1

EVERY = 3
"""Frames from one look at the cars to the next."""

DWELL = 3 * FRAMES_A_SECOND
"""Frames for which the doors stay open at least after the last person was let in."""

GIVES_UP = 20 * FRAMES_A_SECOND
"""Frames after which those who have not got in step back, and wait for the next ride."""


class Lifts(Saved):
    """The cars of all lifts, and the people who call and ride them. Rows are those of the crowd.

    A person calls a lift when they come near its door. The car goes to the stop where somebody has
    waited longest. There people get out. Then as many of those who wait get in as there is room
    for, those nearest to the door first, each to a spot in the car at which their body fits. When
    all are in, or have not come for a while, the car goes to the nearest level at which somebody
    wants to get out.

    The door at a stop is shut unless the car is there with open doors.

    Args:
        shafts: the lifts of the floor plan.
        environment: walls and routes, in which doors are shut.

    Attributes:
        at: (lifts,) number of the stop at which each car is, or to which it goes.
        trips: (lifts,) how often each has gone from one stop to another.
        carried: (lifts,) people whom each has carried.
        log: the rides with people, which tells how high they were.
        sent: takes the environment, people, where they would be, and their gates and lengths as
            ``ways`` returns them. It writes these of people who are sent elsewhere than to their
            destination. None if nobody is.
    """

    def __init__(self, shafts: tuple[Shaft, ...], environment: Environment) -> None:
        self.shafts, self.log = shafts, Rides(shafts, EVERY)
        self._environment = environment
        self.sent: Callable[..., None] | None = None
        self._doors = [[gate.name for gate in each.gates] for each in shafts]
        count = len(shafts)
        self.at, self.trips, self.carried, self._open, self._since = np.zeros((5, count), np.int64)
        self._from = np.full(count, NOBODY)
        self._rides, self._to, self._calls, self._stop, self._called = np.empty((5, 0), np.int64)
        self._spot = np.empty((0, 2))
        self._shut_doors()

    def _shut_doors(self) -> bool:
        """Shut the doors where no car is; whether one is that was open before."""
        shut = [
            name
            for lift, names in enumerate(self._doors)
            for stop, name in enumerate(names)
            if self._from[lift] != NOBODY or self.at[lift] != stop
        ]
        return self._environment.shut_openings("lifts", frozenset(shut))

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        lifts, frame = (len(self.shafts),), 2 * LAST_FRAME
        last = max((len(each.stops) for each in self.shafts), default=0) - 1
        rows = ("known",)
        return {
            "at": Array("i8", lifts, 0, last),
            "trips": Array("i8", lifts, 0),
            "carried": Array("i8", lifts, 0),
            "_from": Array("i8", lifts, NOBODY, last),
            "_open": Array("i8", lifts, 0, frame),
            "_since": Array("i8", lifts, 0, frame),
            "_rides": Array("i8", rows, NOBODY, len(self.shafts) - 1),
            "_to": Array("i8", rows, NOBODY, last),
            "_spot": Array("f8", ("known", 2), -FARTHEST, FARTHEST),
            "_calls": Array("i8", rows, NOBODY, len(self.shafts) - 1),
            "_stop": Array("i8", rows, NOBODY, last),
            "_called": Array("i8", rows, 0, LAST_FRAME),
        }

    def state(self) -> dict[str, Any]:
        """Where the cars are, and who waits and rides."""
        return {name: getattr(self, name) for name in self.members()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given.

        Raises:
            ContentError: a stop that a lift does not have.
        """
        stops = np.array([len(each.stops) for each in self.shafts], dtype=np.int64)
        every = np.arange(len(stops))
        for name, lifts in (
            ("at", every),
            ("_from", every),
            ("_to", state["_rides"]),
            ("_stop", state["_calls"]),
        ):
            ours = lifts != NOBODY
            if (state[name][ours] >= stops[lifts[ours]]).any():
                raise ContentError(f"lifts, {name}: has a stop that the lift does not have")
        for name in self.members():
            setattr(self, name, state[name])
        self._shut_doors()

    def __len__(self) -> int:
        return len(self.shafts)

    def rides(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) number of the lift that each person in ``rows`` rides or is to get into, or -1."""
        self._make_room(rows)
        return self._rides[rows]

    def spots(self, rows: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n, 2) where those in ``rows`` stand in their car, metres."""
        return self._spot[rows]

    def car_of(self, points: NDArray[np.float64]) -> NDArray[np.int64]:
        """(n,) number of the lift in whose car, at any stop, each (n, 2) point is; -1 for none."""
        found = np.full(len(points), NOBODY)
        for number, shaft in enumerate(self.shafts):
            for stop in range(len(shaft.stops)):
                found[shaft.in_car(stop, points)] = number
        return found

    def ways(
        self,
        rows: NDArray[np.int64],
        points: NDArray[np.float64],
        destinations: NDArray[np.int64],
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """How people would go on from elsewhere.

        Args:
            rows: (n,) the people.
            points: (n, 2) where each would be, metres.
            destinations: (n,) of each.

        Returns:
            (n,) the gate or exit through which each would aim, as ``Targets`` have it, and the (n,)
            lengths of their routes, metres.
        """
        found = self._environment.targets(points, destinations)
        gates, lengths = np.array(found.gates), np.array(found.distances)
        if self.sent is not None:
            self.sent(self._environment, rows, points, gates, lengths)
        return gates, lengths

    def shut_in(
        self, rows: NDArray[np.int64], crowd: Crowd, is_open: Callable[[str], bool]
    ) -> list[int]:
        """Those in ``rows`` who are in a car at a stop whose door ``is_open`` calls closed."""
        points, found = np.column_stack([crowd.x[rows], crowd.y[rows]]), np.zeros(len(rows), bool)
        for shaft in self.shafts:
            for stop, gate in enumerate(shaft.gates):
                if not is_open(gate.name):
                    found[shaft.in_car(stop, points)] = True
        those: list[int] = rows[found].tolist()
        return those

    def call(
        self,
        rows: NDArray[np.int64],
        lifts: NDArray[np.int64],
        stops: NDArray[np.int64],
        frame: int,
    ) -> None:
        """Note who waits for a lift, and at which stop.

        Args:
            rows: (n,) people who decide now.
            lifts: (n,) the lift for which each waits, or -1.
            stops: (n,) at which of its stops.
            frame: now.
        """
        self._make_room(rows)
        new = (lifts != self._calls[rows]) | (stops != self._stop[rows])
        self._called[rows[new]] = frame
        self._calls[rows], self._stop[rows] = lifts, stops

    def waiting(
        self, lift: int, stop: int, crowd: Crowd
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Rows of the people who wait for a lift at a stop, those nearest to the door first, and
        since which frame each does."""
        known = min(len(self._calls), len(crowd.active))
        ours = (self._calls[:known] == lift) & (self._stop[:known] == stop)
        rows = np.flatnonzero(ours & crowd.active[:known] & (self._rides[:known] == NOBODY))
        x, y = self.shafts[lift].door(stop)
        away = np.hypot(crowd.x[rows] - x, crowd.y[rows] - y)
        rows = rows[np.argsort(away, kind="stable")]
        return rows, self._called[rows]

    def next_look(self, frame: int) -> int:
        """The next frame after this one in which something may happen."""
        return (frame // EVERY + 1) * EVERY

    def advance(
        self, frame: int, inside: NDArray[np.int64], crowd: Crowd, beyond: Callable[[int, str], int]
    ) -> bool:
        """Let people in and out, and move the cars; whether a door has shut.

        Args:
            frame: now.
            inside: (n,) rows of the people inside.
            crowd: the crowd; those who ride are moved.
            beyond: number of the destination of the person in a row once they have crossed the gate
                of this name.
        """
        if frame % EVERY or not len(self._calls):
            return False
        self._make_room(inside)
        for lift, shaft in enumerate(self.shafts):
            if frame < self._open[lift]:
                continue
            if self._from[lift] != NOBODY:
                self._arrive(lift, frame, inside, crowd)
            self._stand(lift, shaft, frame, inside, crowd, beyond)
        return self._shut_doors()

    def _arrive(self, lift: int, frame: int, inside: NDArray[np.int64], crowd: Crowd) -> None:
        """Open the doors: those who have ridden are at the new stop from now on."""
        start, end, shaft = int(self._from[lift]), int(self.at[lift]), self.shafts[lift]
        riding = inside[self._rides[inside] == lift]
        shift_people(crowd, riding, np.tile(shaft.shift(start, end), (len(riding), 1)))
        self._spot[riding] += shaft.shift(start, end)
        arrived = riding[self._to[riding] == end]
        self._rides[arrived], self._calls[arrived] = NOBODY, NOBODY
        self._from[lift], self._since[lift] = NOBODY, frame

    def _stand(
        self,
        lift: int,
        shaft: Shaft,
        frame: int,
        inside: NDArray[np.int64],
        crowd: Crowd,
        beyond: Callable[[int, str], int],
    ) -> None:
        """Let people out, then in, then go."""
        stop = int(self.at[lift])
        everybody = np.column_stack([crowd.x[inside], crowd.y[inside]])
        there = inside[shaft.reached(stop, everybody, crowd.core[inside])]
        comes = (self._calls[there] == lift) & (self._stop[there] == stop)
        if ((self._rides[there] != lift) & ~comes).any():
            self._since[lift] = frame
            return
        waited = frame - self._since[lift]
        ours = inside[self._rides[inside] == lift]
        if waited >= GIVES_UP and len(ours):
            self._rides[ours[~self._are_in(lift, stop, ours, crowd)]] = NOBODY
        elif self._admit(lift, stop, inside, crowd, beyond):
            self._since[lift], waited = frame, 0
        ours = inside[self._rides[inside] == lift]
        points = np.column_stack([crowd.x[ours], crowd.y[ours]])
        self._spot[ours] = swapped_spots(shaft, stop, points, crowd.core[ours], self._spot[ours])
        # The car waits for riders to get in, and for others to step back out.
        if not self._are_in(lift, stop, ours, crowd).all() or (self._rides[there] != lift).any():
            return
        if len(ours) and waited >= DWELL:
            rise = [
                abs(shaft.stops[to].elevation - shaft.stops[stop].elevation)
                for to in self._to[ours].tolist()
            ]
            self.carried[lift] += len(ours)
            to = int(self._to[ours[int(np.argmin(rise))]])
            self.log.add(lift, stop, to, frame)
            self._go(lift, to, frame)
        elif not len(ours):
            calls = [
                (int(called.min()), to)
                for to in range(len(shaft.stops))
                if to != stop and len(called := self.waiting(lift, to, crowd)[1])
            ]
            if calls:
                self._go(lift, min(calls)[1], frame)

    def _go(self, lift: int, to: int, frame: int) -> None:
        start = int(self.at[lift])
        seconds = self.shafts[lift].ride_s(start, to)
        self._from[lift], self.at[lift] = start, to
        self._open[lift] = frame + round(seconds * FRAMES_A_SECOND)
        self.trips[lift] += 1

    def _admit(
        self,
        lift: int,
        stop: int,
        inside: NDArray[np.int64],
        crowd: Crowd,
        beyond: Callable[[int, str], int],
    ) -> bool:
        """Let those in who fit, those nearest to the door first; whether anybody was."""
        shaft, admitted = self.shafts[lift], False
        ours = inside[self._rides[inside] == lift]
        for row in self.waiting(lift, stop, crowd)[0].tolist():
            if len(ours) >= shaft.capacity:
                break
            spot = free_spot(shaft, stop, crowd.core[row], self._spot[ours], crowd.core[ours])
            to = self._destination(shaft, stop, row, beyond(row, self._doors[lift][stop]))
            if spot is None or to == stop:
                continue
            self._rides[row], self._to[row], self._spot[row] = lift, to, spot
            ours, admitted = np.append(ours, row), True
        return admitted

    def _destination(self, shaft: Shaft, stop: int, row: int, destination: int) -> int:
        """The stop from which a person's way to a destination is shortest, the ride included."""
        count = len(shaft.stops)
        doors = np.array([shaft.before_door(k) for k in range(count)])
        destinations = np.full(count, destination, dtype=np.int64)
        _, lengths = self.ways(np.full(count, row), doors, destinations)
        ways = [lengths[k] + shaft.ride_length(stop, k) for k in range(count)]
        # The way from this stop leads through the lift as well, and is as long as that by the best.
        ways[stop] = np.inf
        best = int(np.argmin(ways))
        return best if np.isfinite(ways[best]) else stop

    def _are_in(
        self, lift: int, stop: int, rows: NDArray[np.int64], crowd: Crowd
    ) -> NDArray[np.bool_]:
        """(n,) whether people are at their spot or wholly behind the line of the door."""
        shaft, points = self.shafts[lift], np.column_stack([crowd.x[rows], crowd.y[rows]])
        at_spot = np.hypot(*(points - self._spot[rows]).T) < THERE
        found: NDArray[np.bool_] = at_spot | shaft.in_car(
            stop, points, crowd.core[rows] - shaft.before
        )
        return found

    def _make_room(self, rows: NDArray[np.int64]) -> None:
        count = int(rows.max(initial=-1)) + 1
        more = max(count, 2 * len(self._rides)) - len(self._rides)
        if count <= len(self._rides):
            return
        for name in ("_rides", "_to", "_calls", "_stop"):
            setattr(self, name, np.append(getattr(self, name), np.full(more, NOBODY)))
        self._called = np.append(self._called, np.zeros(more, np.int64))
        self._spot = np.append(self._spot, np.zeros((more, 2)), axis=0)
