"""Arrivals of measured people: when and where they come in, moving."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import FARTHEST, LAST_FRAME
from mesa_mobility.schema import Array, Kind, Records, Several, Text, Whole, check

FIELDS: dict[str, Array] = {
    "person": Array("i4", (), 0),
    "frame": Array("i4", (), 0, LAST_FRAME),
    "x": Array("f8", (), -FARTHEST, FARTHEST),
    "y": Array("f8", (), -FARTHEST, FARTHEST),
    "heading": Array("f8", (), -1e6, 1e6),
    "vx": Array("f8", (), -100.0, 100.0),
    "vy": Array("f8", (), -100.0, 100.0),
    "speed": Array("f8", (), 0.0, 100.0),
    "type_index": Array("i4", (), 0, below="types"),
    "way": Array("i4", (), 0),
    "row": Array("i4", (), -1, below="people"),
    "entered": Array("i4", (), -1, LAST_FRAME),
    "moved": Array("f8", (), 0.0, FARTHEST),
}
ARRIVAL = np.dtype([(name, kind.dtype) for name, kind in FIELDS.items()])
"""A person who comes: number in the tracks, frame of the model, place, heading, velocity, preferred
speed, type, and index of the exits by which they may leave. Once they have come: row in the model,
frame, and metres between the recorded place and theirs."""

TRIED_WITHIN = 0.5
"""Farthest from the recorded place at which an arrival is put, metres; otherwise they wait."""
RINGS, ON_A_RING = 10, 12


def _beside() -> NDArray[np.float64]:
    """(121, 2) ways from the recorded place to those that are tried, nearest first."""
    radius = np.repeat(np.arange(1, RINGS + 1) * TRIED_WITHIN / RINGS, ON_A_RING)
    angle = np.tile(np.arange(ON_A_RING) * 2.0 * np.pi / ON_A_RING, RINGS)
    ways = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.concatenate([np.zeros((1, 2)), ways])


BESIDE = _beside()


class Arrivals(Saved):
    """People who come in at recorded times and places.

    Attributes:
        records: (n,) ``ARRIVAL`` of each.
        ways: lists of names of exits.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "ways": Several(Several(Text(among="exits"))),
        "records": Records(ARRIVAL, FIELDS, (None,)),
    }

    def __init__(self) -> None:
        self.records = np.empty(0, dtype=ARRIVAL)
        self.ways: list[list[str]] = []

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        if len(self.records):
            check(int(self.records["way"].max()), Whole(high=len(self.ways) - 1), "arrivals, way")

    @property
    def expecting(self) -> bool:
        """Whether somebody has yet to come in."""
        return bool((self.records["row"] < 0).any())

    def add(self, records: NDArray[np.void], ways: Sequence[Sequence[str]]) -> NDArray[np.int64]:
        """Expect more people, whose ``way`` is an index into ``ways``.

        Returns:
            (n,) their indices in ``records``.
        """
        added = records.copy()
        added["way"] += len(self.ways)
        self.ways = [*self.ways, *(list(way) for way in ways)]
        first = len(self.records)
        self.records = np.concatenate([self.records, added])
        return np.arange(first, len(self.records))

    def due(self, frame: int) -> list[int]:
        """Indices of those who should be inside by now and are not."""
        records = self.records
        found: list[int] = np.flatnonzero(
            (records["row"] < 0) & (records["frame"] <= frame)
        ).tolist()
        return found

    def places(self, index: int) -> NDArray[np.float64]:
        """(121, 2) places to try, the recorded one first."""
        own = self.records[index]
        return np.array([own["x"], own["y"]]) + BESIDE

    def newcomer(self, index: int) -> Newcomers:
        """The person."""
        own = self.records[index]
        return Newcomers(
            headings=[own["heading"]],
            velocities=[[own["vx"], own["vy"]]],
            preferred_speeds=[own["speed"]],
            type_index=[int(own["type_index"])],
            exits=self.ways[own["way"]],
        )

    def let_in(self, index: int, row: int, place: NDArray[np.float64], frame: int) -> None:
        """The person has come in."""
        own = self.records[index]
        moved = np.hypot(place[0] - own["x"], place[1] - own["y"])
        for name, value in (("row", row), ("entered", frame), ("moved", moved)):
            self.records[name][index] = value
