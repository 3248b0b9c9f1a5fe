"""Orders to people: to walk to a place, or with a velocity that somebody steers by hand."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.environment import clearance_of, passing_of
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.tactic import Desired, Tactic
from mesa_mobility.crowd.tactics.target_choice import Deciding
from mesa_mobility.crowd.tactics.waiting import frames_of
from mesa_mobility.errors import LiveError
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls
from mesa_mobility.live.making_way import BRISK, step_aside
from mesa_mobility.live.point_routes import PointRoutes

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel

FREE, WALKS, STANDS, STEERED = range(4)
"""What somebody does: as the model has it; on the way to a place; there; as somebody steers."""

FOREVER = np.iinfo(np.int64).max

AHEAD = 1.0
"""Seconds ahead of its velocity at which somebody who is steered aims: near, so that movements are
short and another velocity soon counts."""

FASTEST = 10.0
"""Highest speed by hand, m/s; people walk as fast as their options let them."""

_ARRIVED, _AROUND = 0.3, 0.35
"""Metres from a place at which the first has arrived, and more for those who stand there."""


class Orders(Tactic):
    """People do as they are told, and others make way for those who are steered.

    The last tactic of a model; everybody without orders goes on as before.
    """

    name = "orders"

    _model: PedestrianModel
    _crowd: Crowd

    def __init__(self) -> None:
        self._does = np.empty(0, dtype=np.int8)
        self._velocity = np.empty((0, 2))
        self._place = np.empty((0, 2))
        self._stay = np.empty(0, dtype=np.int64)
        self._until = np.empty(0, dtype=np.int64)
        self._routes: dict[float, PointRoutes] = {}

    def bind(self, model: PedestrianModel) -> None:
        """Keep the model's crowd and plan."""
        self._model, self._crowd = model, model.crowd

    def state(self) -> dict[str, Any]:
        """Everybody's orders."""
        names = ("_does", "_velocity", "_place", "_stay", "_until")
        return {name: getattr(self, name) for name in names}

    def steered(self) -> NDArray[np.int64]:
        """(n,) rows of those who are steered and inside."""
        rows = np.flatnonzero(self._does == STEERED)
        return rows[self._crowd.active[rows]]

    def walk(self, rows: NDArray[np.int64], place: tuple[float, float], stay: float | None) -> None:
        """Let people walk to a place and stay there; then they go on as before.

        Args:
            rows: (n,) the people.
            place: metres.
            stay: seconds, or None for as long as nobody tells them otherwise.

        Raises:
            LiveError: the place is off the floor, or too near to a wall.
        """
        plan, room = self._model.floor_plan, passing_of(float(self._crowd.core[rows].max()))
        if (
            not plan.contains([place])[0]
            or distances_to_walls(plan, np.array([place]), room)[0] < room
        ):
            raise LiveError(
                f"to: ({place[0]:g}, {place[1]:g}) is off the floor or nearer than {room:.2f} m to "
                "a wall, expected a place with room for the body"
            )
        frames = FOREVER if stay is None else int(frames_of(np.array([stay]), "stay")[0])
        self._begin(rows, WALKS)
        self._place[rows], self._stay[rows] = place, frames

    def steer(self, rows: NDArray[np.int64], velocity: tuple[float, float]) -> None:
        """Let people walk with a velocity, m/s, until told otherwise; they stand if it is 0.

        Raises:
            LiveError: faster than anybody walks.
        """
        speed = float(np.hypot(*velocity))
        if not speed <= FASTEST:
            raise LiveError(f"velocity: {speed:g} m/s, expected at most {FASTEST:g}")
        self._begin(rows, STEERED)
        self._velocity[rows] = velocity

    def release(self, rows: Iterable[int] | NDArray[np.int64]) -> None:
        """Let people go on as before."""
        self._begin(np.asarray(list(rows), dtype=np.int64), FREE)

    def _begin(self, rows: NDArray[np.int64], what: int) -> None:
        more = int(rows.max(initial=-1)) + 1 - len(self._does)
        if more > 0:
            more += len(self._does)
            self._does = np.append(self._does, np.zeros(more, dtype=np.int8))
            self._velocity = np.append(self._velocity, np.zeros((more, 2)), axis=0)
            self._place = np.append(self._place, np.zeros((more, 2)), axis=0)
            self._stay = np.append(self._stay, np.zeros(more, dtype=np.int64))
            self._until = np.append(self._until, np.zeros(more, dtype=np.int64))
        self._does[rows] = what

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Set where those with orders go, and how fast."""
        if desired.newcomers or not self._does.any():
            return
        rows = deciding.pedestrians
        known = np.flatnonzero(rows < len(self._does))
        does = np.zeros(len(rows), dtype=np.int8)
        does[known] = self._does[rows[known]]
        points, speeds = desired.points.copy(), desired.speeds.copy()
        self._go_to_places(deciding, does, points, speeds)
        by_hand = np.flatnonzero(does == STEERED)
        velocity = self._velocity[rows[by_hand]]
        points[by_hand] = deciding.positions[by_hand] + AHEAD * velocity
        speeds[by_hand] = np.hypot(velocity[:, 0], velocity[:, 1])
        steered = self.steered()
        others = np.flatnonzero(does != STEERED)
        if len(steered) and len(others):
            who, places = step_aside(rows[others], steered, self._velocity[steered], self._crowd)
            points[others[who]] = places
            speeds[others[who]] = np.maximum(speeds[others[who]], BRISK)
        desired.points, desired.speeds = points, speeds

    def _go_to_places(
        self,
        deciding: Deciding,
        does: NDArray[np.int8],
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> None:
        """Set points and speeds of those who walk to a place or stand there."""
        rows, now = deciding.pedestrians, round(deciding.elapsed / FRAME_SECONDS)
        over = np.flatnonzero(does == STANDS)
        over = over[self._until[rows[over]] <= now]
        does[over] = self._does[rows[over]] = FREE
        going = np.flatnonzero(does == WALKS)
        for at in _by_destination(self._place[rows[going]], self._crowd.core[rows[going]]):
            own = going[at]
            place = (float(self._place[rows[own[0]], 0]), float(self._place[rows[own[0]], 1]))
            routes = self._routes_of(float(self._crowd.core[rows[own[0]]]))
            targets, lengths = routes.targets(deciding.positions[own], place)
            there = lengths <= _ARRIVED + _AROUND * np.sqrt(self._standing_at(place))
            points[own] = targets
            speeds[own[~np.isfinite(lengths)]] = 0.0
            # Others have their own preferred speed, also where the model has them wait.
            walking = own[np.isfinite(lengths)]
            speeds[walking] = self._crowd.agenda["speed"][rows[walking]]
            self._arrive(rows[own[there]], now)
            does[own[there]] = STANDS
        stand = np.flatnonzero(does == STANDS)
        points[stand], speeds[stand] = deciding.positions[stand], 0.0

    def _arrive(self, rows: NDArray[np.int64], now: int) -> None:
        self._does[rows] = STANDS
        stay = self._stay[rows]
        self._until[rows] = now + np.minimum(stay, FOREVER - now)

    def _standing_at(self, place: tuple[float, float]) -> int:
        """How many stand at a place."""
        rows = np.flatnonzero((self._does == STANDS) & (self._place == place).all(axis=1))
        return int(self._crowd.active[rows].sum())

    def _routes_of(self, core: float) -> PointRoutes:
        if core not in self._routes:
            self._routes[core] = PointRoutes(self._model.floor_plan, clearance_of(core))
        return self._routes[core]


def _by_destination(
    places: NDArray[np.float64], cores: NDArray[np.float64]
) -> list[NDArray[np.intp]]:
    """Indices of those with the same place and core radius, for each such pair."""
    if not len(places):
        return []
    _, which = np.unique(np.column_stack([places, cores]), axis=0, return_inverse=True)
    which = which.reshape(-1)
    return [np.flatnonzero(which == k) for k in range(int(which.max()) + 1)]
