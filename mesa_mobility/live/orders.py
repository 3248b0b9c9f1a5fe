"""Orders to people: to walk to a place, or with a velocity that somebody steers by hand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.journeys.waiting import end_wait, frames_of, wait_until
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.clearances import passing_of
from mesa_mobility.errors import ContentError, LiveError
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls
from mesa_mobility.schema import Array, Kind

FREE, WALKS, STANDS, STEERED = range(4)
"""What somebody does: as the model has it; on the way to a place; there; as somebody steers."""

FOREVER = np.iinfo(np.int32).max - 1
"""Frame until which people wait who are not told how long; the last one stands for a function."""

FASTEST = 10.0
"""Highest speed by hand, m/s; people walk as fast as their options let them."""


class Orders(Saved):
    """What the people of a model have been told.

    Arrays have an entry for each row of the crowd that has ever had an order.

    Args:
        model: the model.

    Attributes:
        does: (n,) one of the four values above.
        velocity: (n, 2) of those who are steered, m/s.
        place: (n, 2) to which people walk, metres, in the plane of the model.
        stay: (n,) frames for which they stay there, or ``FOREVER``.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "does": Array("i1", ("orders",), FREE, STEERED),
        "velocity": Array("f8", ("orders", 2), -FASTEST, FASTEST),
        "place": Array("f8", ("orders", 2), -1e9, 1e9),
        "stay": Array("i8", ("orders",), 0, FOREVER),
    }

    def __init__(self, model: World) -> None:
        self._model = model
        self.does = np.empty(0, dtype=np.int8)
        self.velocity = np.empty((0, 2))
        self.place = np.empty((0, 2))
        self.stay = np.empty(0, dtype=np.int64)

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        people = self._model.population.count
        if state["does"][people:].any():  # room for more people is kept ahead
            raise ContentError(f"does: an order to nobody, expected {people} people at most")
        super().restore(state)

    def of(self, rows: NDArray[np.int64]) -> NDArray[np.int8]:
        """(n,) what people do."""
        does = np.full(len(rows), FREE, dtype=np.int8)
        known = rows < len(self.does)
        does[known] = self.does[rows[known]]
        return does

    def steered(self) -> NDArray[np.int64]:
        """(n,) rows of those who are steered and inside."""
        rows = np.flatnonzero(self.does == STEERED)
        return rows[self._model.crowd.active[rows]]

    def standing_at(self, place: tuple[float, float]) -> int:
        """How many stand at a place to which they were sent."""
        rows = np.flatnonzero((self.does == STANDS) & (self.place == place).all(axis=1))
        return int(self._model.crowd.active[rows].sum())

    def walk(self, rows: NDArray[np.int64], place: tuple[float, float], stay: float | None) -> None:
        """Let people walk to a place and stay there; then they go on as before.

        Args:
            rows: (n,) the people.
            place: metres, in the plane of the model; see ``Building.places``.
            stay: seconds, or None for as long as nobody tells them otherwise.

        Raises:
            LiveError: the place is off the floor, or too near to a wall.
        """
        model, point = self._model, np.array([place])
        plan, room = model.floor_plan, passing_of(float(model.crowd.core[rows].max()))
        if not plan.contains(point)[0] or distances_to_walls(plan, point, room)[0] < room:
            raise LiveError(
                f"to: the place is off the floor or nearer than {room:.2f} m to a wall, expected "
                "a place with room for the body"
            )
        frames = FOREVER if stay is None else int(frames_of(np.array([stay]), "stay")[0])
        self._begin(rows, WALKS)
        self.place[rows], self.stay[rows] = place, frames

    def steer(self, rows: NDArray[np.int64], velocity: tuple[float, float]) -> None:
        """Let people walk with a velocity, m/s, until told otherwise; at 0 they stand.

        Raises:
            LiveError: faster than anybody walks.
        """
        speed = float(np.hypot(*velocity))
        if not speed <= FASTEST:
            raise LiveError(f"velocity: {speed:g} m/s, expected at most {FASTEST:g}")
        self._begin(rows, STEERED)
        self.velocity[rows] = velocity

    def release(self, rows: NDArray[np.int64]) -> None:
        """Let people go on as before."""
        self._begin(rows, FREE)

    def arrive(self, rows: NDArray[np.int64]) -> None:
        """Let people who have come to their place stand there: a wait like any other."""
        self.does[rows] = STANDS
        until = self._model.frame + np.minimum(self.stay[rows], FOREVER - self._model.frame)
        wait_until(rows, until, self._model.crowd)

    def _begin(self, rows: NDArray[np.int64], what: int) -> None:
        model = self._model
        more = int(rows.max(initial=-1)) + 1 - len(self.does)
        if more > 0:
            more += len(self.does)
            self.does = np.append(self.does, np.full(more, FREE, dtype=np.int8))
            self.velocity = np.append(self.velocity, np.zeros((more, 2)), axis=0)
            self.place = np.append(self.place, np.zeros((more, 2)), axis=0)
            self.stay = np.append(self.stay, np.zeros(more, dtype=np.int64))
        agenda = model.crowd.agenda
        end_wait(rows[self.does[rows] == STANDS], model.frame, model.crowd)
        for row in rows.tolist():
            model.journeys.stays.end(row, model.frame, model.crowd)
        model.refuges.free(rows, model.crowd)
        # Progress on the way to another place is no progress on this one, nor is its lack.
        agenda["nearest"][rows], agenda["since"][rows] = np.inf, model.elapsed
        self.does[rows] = what
