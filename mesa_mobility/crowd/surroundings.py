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

    def targets(self, points: NDArray[np.float64], destinations: NDArray[np.int32]) -> Targets:
        """Where people at ``points`` (n, 2) should aim now."""
        return self._router.targets(points, destinations)

    def check_way_out(self, points: NDArray[np.float64], destination: int) -> None:
        """Raise FloorPlanError for places without a way out, were everything open."""
        lost = points[_without_way(self._router, points, destination)]
        plan = self._plan
        if len(lost) and not all(plan.is_open(opening.name) for opening in plan.openings()):
            plan = FloorPlan(
                plan.walkable, exits=plan.exits, gates=plan.gates, obstacles=plan.obstacles.values()
            )
            router = Router(plan, clearance=self._clearance)
            number = router.destination(self._destinations[destination])
            lost = lost[_without_way(router, lost, number)]
        if len(lost):
            names = self._destinations[destination]
            to = "any exit" if names is None else " or ".join(repr(name) for name in names)
            raise FloorPlanError(
                f"{len(lost)} of {len(points)} people have no way to {to}; the first stands at "
                f"({lost[0, 0]:.2f}, {lost[0, 1]:.2f})"
            )

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
            exits=np.array([[*exit_.a, *exit_.b] for exit_ in exits], dtype=np.float64),
            leads_out=leads_out,
        )


def _without_way(
    router: Router, points: NDArray[np.float64], destination: int
) -> NDArray[np.bool_]:
    return ~np.isfinite(router.targets(points, np.full(len(points), destination)).distances)
