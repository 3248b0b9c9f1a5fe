"""What the crowd needs to know of its floor plan, kept in step with its changes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.collision import Surroundings
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import FloorPlan, Router, Targets, WallIndex

CELL_SIZE = 1.0

BERTH = 0.05
"""Metres by which routes keep clear of corners, beside the body's core."""


class Site:
    """Walls for the collision tests and routes for the targets of one floor plan.

    Args:
        plan: the floor plan; obstacles and doors may change while a model runs.
        reach: how far from a person walls matter, metres.
        body: largest core radius, metres.
    """

    def __init__(self, plan: FloorPlan, *, reach: float, body: float) -> None:
        self._plan = plan
        self._reach = reach
        self._clearance = body + BERTH
        self._router = Router(plan, clearance=self._clearance)
        self._destinations: list[tuple[str, ...] | None] = []
        self._version = -1
        self.destination(None)

    def destination(self, exits: tuple[str, ...] | None) -> int:
        """Number of the destination "the nearest of these exits"; None stands for all."""
        number = self._router.destination(exits)
        if number == len(self._destinations):
            self._destinations.append(exits)
            self._version = -1
        return number

    def exits(self, destination: int) -> tuple[str, ...]:
        """Names of the exits of a destination, open or closed; none if it is a gate to cross."""
        names = self._destinations[destination]
        return tuple(e.name for e in self._plan.exits if names is None or e.name in names)

    @property
    def plan(self) -> FloorPlan:
        """The floor plan."""
        return self._plan

    def crossing(self, gate: str) -> int:
        """Number of the destination "across this gate"; to whoever goes there no exit is a way."""
        number = self._router.crossing(gate)
        if number == len(self._destinations):
            self._destinations.append((gate,))
            self._version = -1
        return number

    def targets(self, points: NDArray[np.float64], destinations: NDArray[np.int64]) -> Targets:
        """Where people at ``points`` (n, 2) should aim now."""
        return self._router.targets(points, destinations)

    def abreast(
        self, points: NDArray[np.float64], targets: Targets, areas: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(n, 2) what people at ``points`` aim at who pass a corner abreast of others.

        That is within ``areas`` (n,), m2, divided by their distance of it; see ``Router.abreast``.
        """
        return self._router.abreast(points, targets, areas)

    def check_way_out(self, points: NDArray[np.float64], destination: int) -> None:
        """Raise FloorPlanError for places without a way out, were everything open."""
        lost = points[_without_way(self._router, points, destination)]
        if len(lost) and not self._all_open():
            router = self._router_when_open()
            lost = lost[_without_way(router, lost, destination)]
        if len(lost):
            raise FloorPlanError(
                f"{len(lost)} of {len(points)} people have no way to {self._text(destination)}; "
                f"the first stands at ({lost[0, 0]:.2f}, {lost[0, 1]:.2f})"
            )

    def check_way_on(self, gate: str, destination: int) -> None:
        """Raise FloorPlanError where there is no way on from a gate, were everything open."""
        router = self._router if self._all_open() else self._router_when_open()
        if not np.isfinite(router.way_from(gate, destination)):
            raise FloorPlanError(f"there is no way from {gate!r} to {self._text(destination)}")

    def _all_open(self) -> bool:
        return all(self._plan.is_open(opening.name) for opening in self._plan.openings())

    def _router_when_open(self) -> Router:
        """Routes as they would be with everything open; destinations have the same numbers."""
        plan = self._plan
        plan = FloorPlan(
            plan.walkable, exits=plan.exits, gates=plan.gates, obstacles=plan.obstacles.values()
        )
        router = Router(plan, clearance=self._clearance)
        gates = {gate.name for gate in plan.gates}
        for names in self._destinations:
            if names is not None and names[0] in gates:
                router.crossing(names[0])
            else:
                router.destination(names)
        return router

    def _text(self, destination: int) -> str:
        names = self._destinations[destination]
        return "any exit" if names is None else " or ".join(repr(name) for name in names)

    @property
    def surroundings(self) -> Surroundings:
        """Walls and exits as they are now."""
        if self._version != self._plan.version:
            self._version = self._plan.version
            self._now = self._survey()
        return self._now

    def _survey(self) -> Surroundings:
        walls = self._plan.walls
        cells = WallIndex(walls).cell_table(CELL_SIZE, self._reach)
        exits = self._plan.exits
        leads_out = np.array(
            [
                [
                    self._plan.is_open(exit_.name) and (names is None or exit_.name in names)
                    for exit_ in exits
                ]
                for names in self._destinations
            ],
            dtype=np.bool_,
        )
        return Surroundings(
            segments=np.ascontiguousarray(walls),
            x0=cells.x0,
            y0=cells.y0,
            nx=cells.nx,
            ny=cells.ny,
            size=cells.cell_size,
            offsets=cells.offsets,
            indices=cells.indices,
            exits=np.array([[*e.a, *e.b] for e in exits], dtype=np.float64).reshape(-1, 4),
            leads_out=leads_out.reshape(len(self._destinations), len(exits)),
        )


def _without_way(
    router: Router, points: NDArray[np.float64], destination: int
) -> NDArray[np.bool_]:
    return ~np.isfinite(router.targets(points, np.full(len(points), destination)).distances)
