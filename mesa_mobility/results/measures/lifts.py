"""Lifts of a building: who rides in them, how long people wait and ride, and how full cars are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.buildings.connections.lift import CALLS
from mesa_mobility.buildings.connections.lines import middle_of
from mesa_mobility.results.measures.storeys import curve, people_at_a_time, true_places
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building

FloatArray = NDArray[np.float64]

COLUMNS = (
    "people",
    "down",
    "up",
    "rides",
    "mean_wait_s",
    "longest_wait_s",
    "mean_ride_s",
    "most",
)

STANDS_M = 1e-3
"""Most metres by which a car that stands may rise in a frame, since tracks are rounded."""

OFF_M = 0.01
"""Most metres by which people on a level may be above or below its elevation."""


@dataclass(frozen=True, eq=False)
class Rides:
    """People's rides in one lift, in order of time.

    A person is in the lift when they are past the line of its door.

    Attributes:
        person: (k,) int32.
        start: (k,) float64, seconds: the first frame in the lift.
        end: (k,) float64, seconds: the first frame out of it; infinite for people who are in it
            when the run ends.
        from_level: (k,) int16: number of the level at which they got in.
        to_level: (k,) int16: that at which they got out. For people who are in the lift when the
            run ends, the level that the car is nearest to then.
        wait: (k,) float64, seconds from their call to ``start``. They call when they come within
            4 m of the door on the level where they get in, and stay within it until they get in.
            nan for people who are in the lift when the run begins.
    """

    person: NDArray[np.int32]
    start: FloatArray
    end: FloatArray
    from_level: NDArray[np.int16]
    to_level: NDArray[np.int16]
    wait: FloatArray


def rides(trajectories: Tracks, building: Building) -> dict[str, Rides]:
    """The rides of people in each lift of a building, by its name.

    A ride lasts from getting in to getting out, also if the car stops for others meanwhile. People
    who get out where they got in have no ride.

    Args:
        trajectories: a run in the building.
        building: the building.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    riders = _Riders(trajectories, building)
    return {each.name: riders.rides(number) for number, each in enumerate(building.lifts)}


def occupancy_by_lift(
    trajectories: Tracks, building: Building, every: float = 1.0
) -> dict[str, list[list[float]]]:
    """How many people are in each lift, as [[t, people], ...] by its name.

    Args:
        trajectories: a run in the building.
        building: the building.
        every: seconds between the entries; the first is at 0, the last not after the end.

    Raises:
        ResultsError: `every` is shorter than a frame, or the tracks have no elevations.
    """
    lifts = building.lifts_at(true_places(trajectories))
    return {
        each.name: curve(trajectories, lifts == number, every)
        for number, each in enumerate(building.lifts)
    }


def by_lift(trajectories: Tracks, building: Building) -> pd.DataFrame:
    """How many people each lift carried, and how long they waited and rode.

    Args:
        trajectories: a run in the building.
        building: the building.

    Returns:
        A row for each lift, by name: ``people`` who rode in it; ``down`` and ``up``, how many rides
        of theirs led there, those of people who are in the lift at the end left out; ``rides`` of
        the car from level to level with people in it; ``mean_wait_s`` and ``longest_wait_s``, from
        when people call it until they get in, as `Rides` has them; ``mean_ride_s``, mean time from
        getting in to getting out; and ``most``, the greatest number of people in it at a time.
        Times are nan if nobody has one. People who never ride have no wait.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    import pandas as pd

    if not building.lifts:
        true_places(trajectories)  # which must have elevations
        return pd.DataFrame([], columns=["lift", *COLUMNS]).set_index("lift")
    riders = _Riders(trajectories, building)
    elevation = {level.number: level.elevation for level in building.levels}
    table = []
    for number, each in enumerate(building.lifts):
        own = riders.rides(number)
        ended = np.isfinite(own.end)
        rise = np.array(
            [
                elevation[to] - elevation[start]
                for start, to in zip(own.from_level.tolist(), own.to_level.tolist(), strict=True)
            ]
        )
        waits, times = own.wait[~np.isnan(own.wait)], (own.end - own.start)[ended]
        table.append(
            {
                "lift": each.name,
                "people": len(np.unique(own.person)),
                "down": int((rise[ended] < 0.0).sum()),
                "up": int((rise[ended] > 0.0).sum()),
                "rides": riders.rides_of_car(number),
                "mean_wait_s": waits.mean() if len(waits) else np.nan,
                "longest_wait_s": waits.max() if len(waits) else np.nan,
                "mean_ride_s": times.mean() if len(times) else np.nan,
                "most": int(people_at_a_time(trajectories, riders.lift == number).max()),
            }
        )
    return pd.DataFrame(table, columns=["lift", *COLUMNS]).set_index("lift")


class _Riders:
    """Rows of tracks ordered by person, and the lift in which each is.

    Args:
        trajectories: a run in the building.
        building: the building.

    Attributes:
        lift: (n,) the lift in which each row of the tracks is, -1 for none.

    Raises:
        ResultsError: the tracks have no elevations.
    """

    def __init__(self, trajectories: Tracks, building: Building) -> None:
        order = trajectories.by_person
        places = true_places(trajectories)
        self.lift = building.lifts_at(places)
        places = places[order]
        self._person, self._frame = trajectories.person[order], trajectories.frame[order]
        self._xy, self._z = places[:, :2], places[:, 2]
        self._rate = trajectories.frame_rate
        self._lift = self.lift[order]
        self._lifts = building.lifts
        self._elevation = {level.number: level.elevation for level in building.levels}
        self._same = np.diff(self._person) == 0

    def rides(self, number: int) -> Rides:
        """The rides in one lift."""
        first, beyond = self._stays(self._lift == number)
        moved = np.append(0, np.cumsum(self._moves(number)))
        rode = moved[beyond] > moved[first]
        first, beyond = first[rode], beyond[rode]
        levels = np.array(self._lifts[number].numbers, dtype=np.int16)
        heights = np.array([self._elevation[level] for level in levels.tolist()])
        start, end = (
            np.abs(self._z[rows][:, None] - heights).argmin(axis=1) for rows in (first, beyond - 1)
        )
        left = np.append(self._same, False)[beyond - 1]
        found = Rides(
            self._person[first],
            self._frame[first] / self._rate,
            np.where(left, self._frame[beyond - 1] + 1, np.inf) / self._rate,
            levels[start],
            levels[end],
            self._waits(number, first, beyond, heights[start]),
        )
        in_time = np.lexsort((found.person, found.start))
        return Rides(*(getattr(found, name)[in_time] for name in found.__annotations__))

    def rides_of_car(self, number: int) -> int:
        """How often the car of a lift went from one level to another with people in it."""
        moving = np.flatnonzero(self._moves(number))
        begun, one = np.unique(self._frame[moving], return_index=True)
        ended = self._frame[moving[one] + 1]
        # The car moves on without a stop where one step begins as another ends.
        return len(begun) - int((begun[1:] <= ended[:-1]).sum())

    def _waits(
        self,
        number: int,
        first: NDArray[np.int64],
        beyond: NDArray[np.int64],
        heights: FloatArray,
    ) -> FloatArray:
        """(k,) seconds from the call to rows ``first``, of rides that begin at (k,) heights."""
        edges = np.zeros(len(self._lift) + 1, dtype=np.int64)
        edges[first] += 1
        edges[beyond] -= 1
        riding = np.cumsum(edges)[:-1] > 0
        away = np.hypot(*(self._xy - middle_of(self._lifts[number].door)).T)
        near = (away < CALLS) & ~riding
        came = np.append(False, self._same)[first]
        waits = np.where(came, 0.0, np.nan)
        for height in np.unique(heights):
            begin, end = self._stays(near & (np.abs(self._z - height) <= OFF_M))
            # The stay before the door that ends as the ride begins, if there is one.
            stay = np.searchsorted(end, first)
            own = np.flatnonzero(came & (heights == height) & (stay < len(end)))
            own = own[end[stay[own]] == first[own]]
            called = self._frame[begin[stay[own]]]
            waits[own] = (self._frame[first[own]] - called) / self._rate
        return waits

    def _stays(self, rows: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(k,) first rows of people's uninterrupted stays in a mask (n,), and (k,) rows after the
        last."""
        begins, ends = rows.copy(), rows.copy()
        begins[1:] &= ~(rows[:-1] & self._same)
        ends[:-1] &= ~(rows[1:] & self._same)
        return np.flatnonzero(begins), np.flatnonzero(ends) + 1

    def _moves(self, number: int) -> NDArray[np.bool_]:
        """(n,) whether the car of a lift moves from a row to the next, with the person in it."""
        moves = np.zeros(len(self._z), dtype=np.bool_)
        inside = self._lift == number
        rises = np.abs(np.diff(self._z)) > STANDS_M
        moves[:-1] = rises & inside[:-1] & inside[1:] & self._same
        return moves
