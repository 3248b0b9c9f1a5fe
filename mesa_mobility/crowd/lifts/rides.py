"""Rides of lifts that have carried people, and how high each car was when."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import LAST_FRAME
from mesa_mobility.errors import ContentError
from mesa_mobility.floorplan import Shaft
from mesa_mobility.schema import Array, Kind


class Rides(Saved):
    """The rides of all lifts, empty ones left out.

    Who rides stays on the drawing of the car at the stop from which it goes, until the doors have
    opened at the other. This tells how far above that floor the car is meanwhile.

    Args:
        shafts: the lifts of the floor plan.
        every: frames from one look at the cars to the next; riders are moved in these.

    Attributes:
        begun: (rides, 4) number of the lift, of the stop from which and of that to which it goes,
            and the frame in which its doors begin to close, in order of time.
    """

    def __init__(self, shafts: tuple[Shaft, ...], every: int) -> None:
        self._shafts, self._every = shafts, every
        rides = [(each, a, b) for each in shafts for a in range(len(each.stops)) for b in range(a)]
        longest = max((shaft.ride_s(a, b) for shaft, a, b in rides), default=0.0)
        self._longest = round(longest * FRAMES_A_SECOND) + every
        self.begun: NDArray[np.int64] = np.empty((0, 4), np.int64)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {"begun": Array("i8", ("rides", 4), 0, LAST_FRAME)}

    def state(self) -> dict[str, Any]:
        """All rides so far."""
        return {"begun": self.begun}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given.

        Raises:
            ContentError: a lift or a stop that is not there.
        """
        for number, (lift, *stops, _) in enumerate(state["begun"].tolist()):
            if lift >= len(self._shafts) or max(stops) >= len(self._shafts[lift].stops):
                raise ContentError(f"rides, begun, row {number}: there is no such lift or stop")
        self.begun = state["begun"]

    def add(self, lift: int, start: int, end: int, frame: int) -> None:
        """Note that the doors of a lift begin to close at the stop ``start``."""
        self.begun = np.append(self.begun, [[lift, start, end, frame]], axis=0)

    def risen(
        self, frames: NDArray[np.integer], points: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """How far cars have carried people from the floor on which these are drawn.

        Args:
            frames: (n,) frames, in order of time.
            points: (n, 2) places of people in them, metres in the plane.

        Returns:
            (n,) metres; below 0 downwards, and 0 for those who do not ride.
        """
        found = np.zeros(len(points))
        # While a model runs, all but the last rides are over.
        first = int(frames[0]) - self._longest if len(frames) else 0
        since = int(np.searchsorted(self.begun[:, 3], first))
        for lift, start, end, begun in self.begun[since:].tolist():
            shaft = self._shafts[lift]
            rise = shaft.stops[end].elevation - shaft.stops[start].elevation
            arrived = begun + round(shaft.ride_s(start, end) * FRAMES_A_SECOND)
            moved = -(-arrived // self._every) * self._every
            first, last = np.searchsorted(frames, (begun, moved + 1))
            riding = first + np.flatnonzero(shaft.in_car(start, points[first:last], -shaft.before))
            seconds = (frames[riding] - begun) / FRAMES_A_SECOND - shaft.door_s
            share = np.clip(seconds * shaft.speed / abs(rise), 0.0, 1.0)
            found[riding] = rise * share
        return found
