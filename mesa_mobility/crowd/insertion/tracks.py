"""Measured tracks on a floor plan: what is on the floor, and to which exit each track leads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.crowd.state.records import FARTHEST
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

NEAR_FLOOR = 0.5
"""Farthest from the free floor at which somebody counts as on it, metres: heads lean over walls."""

AT_EXIT = 1.0
"""A track ends at an exit if it ends within so many metres of it."""


class MeasuredTracks(Protocol):
    """The part of ``Trajectories`` that a model uses."""

    @property
    def reading(self) -> Any:
        """How the file was read, or None."""

    @property
    def heading(self) -> FloatArray:
        """(n,) radians."""

    @property
    def frame_rate(self) -> float:
        """Frames a second."""

    @property
    def frame(self) -> NDArray[np.int32]:
        """(n,) frame of each row."""

    @property
    def person(self) -> NDArray[np.int32]:
        """(n,) person of each row."""

    @property
    def x(self) -> FloatArray:
        """(n,) metres."""

    @property
    def y(self) -> FloatArray:
        """(n,) metres."""

    @property
    def by_person(self) -> IntArray:
        """(n,) the rows ordered by (person, frame)."""


@dataclass(frozen=True, eq=False)
class TrackRows:
    """Rows of tracks by (person, frame).

    Attributes:
        name: the file.
        rate: frames a second.
        person: (n,) numbers.
        frame: (n,) frames.
        places: (n, 2) metres.
        off: (n,) metres from the floor.
    """

    name: str
    rate: float
    person: IntArray
    frame: IntArray
    places: FloatArray
    off: FloatArray

    @classmethod
    def of(cls, tracks: MeasuredTracks, plan: FloorPlan, name: str) -> TrackRows:
        """The rows of tracks on a plan."""
        order = tracks.by_person
        places = np.column_stack([tracks.x[order], tracks.y[order]])
        off = np.zeros(len(places))
        outside = ~plan.contains(places)
        shapely.prepare(plan.free)
        off[outside] = shapely.distance(plan.free, shapely.points(places[outside]))
        person, frame = tracks.person[order], tracks.frame[order]
        rate = float(tracks.frame_rate)
        return cls(name, rate, person.astype(np.int64), frame.astype(np.int64), places, off)

    @property
    def on_floor(self) -> NDArray[np.bool_]:
        """(n,) whether each is on the floor, heads over walls included."""
        return self.off <= NEAR_FLOOR

    def where(self, row: int) -> str:
        """The file, person and frame of a row, for a message."""
        return f"{self.name}: person {self.person[row]}, frame {self.frame[row]}"

    def exits(self, persons: IntArray, plan: FloorPlan) -> IntArray:
        """(k,) index in ``plan.exits`` of the exit by which each person left.

        It is the exit at which their track on the floor ends, or the one to which it has come
        nearer by most.

        Args:
            persons: (k,) numbers of people who are on the floor at some time.
            plan: the floor plan.

        Raises:
            ModelError: the plan has no exit.
        """
        if not plan.exits:
            raise ModelError("the floor plan has no exit, expected one where tracks end")
        on = np.flatnonzero(self.on_floor)
        first = on[np.searchsorted(self.person[on], persons)]
        last = on[np.searchsorted(self.person[on], persons, side="right") - 1]
        starts, ends = shapely.points(self.places[first]), shapely.points(self.places[last])
        from_start = np.array([shapely.distance(each.line, starts) for each in plan.exits])
        from_end = np.array([shapely.distance(each.line, ends) for each in plan.exits])
        there = np.where(from_end <= AT_EXIT, from_end - FARTHEST, from_end - from_start)
        found: IntArray = np.argmin(there, axis=0)
        return found
