"""Doors, exits and obstacles that come and go by a click."""

from __future__ import annotations

from typing import Any

from mesa_mobility import PedestrianModel
from mesa_mobility.animation.buildings.storeys import drawn_building
from mesa_mobility.dashboard.session import serialization
from mesa_mobility.floorplan.occupants import check_vacant


class PlanChanges:
    """Changes of one model's floor plan.

    Args:
        model: the model, its plan as it was made.
    """

    def __init__(self, model: PedestrianModel) -> None:
        self._plan, self._building = model.floor_plan, model.building
        self._polygons = list(self._plan.obstacles.values())
        self._there: list[int | None] = list(self._plan.obstacles)

    def drawn(self) -> dict[str, Any]:
        """The plan as the canvas draws it."""
        there = [number is not None for number in self._there]
        obstacles = list(zip(self._polygons, there, strict=True))
        return serialization.floor(self._plan, obstacles, self._building)

    def solid(self) -> dict[str, Any]:
        """The building as the three-dimensional view draws it; {} for a floor plan."""
        return {} if self._building is None else drawn_building(self._building)

    def toggle_opening(self, name: str) -> None:
        """Close a door or exit, or stairs or a lift of this name, or open what is closed."""
        building, plan = self._building, self._plan
        if building is not None:
            (building.close if building.is_open(name) else building.open)(name)
        else:
            (plan.close_gate if plan.is_open(name) else plan.open_gate)(name)

    def toggle_obstacle(self, number: int) -> None:
        """Take away an obstacle of the plan as it was made, or bring it back.

        Raises:
            FloorPlanError: somebody stands where it would be, or it would lock somebody in.
        """
        known = self._there[number]
        if known is not None:
            self._plan.remove_obstacle(known)
            self._there[number] = None
            return
        polygon = self._polygons[number]
        # The plan would refuse it by the number that it has next.
        check_vacant(self._plan, polygon, f"obstacle {number}", self._plan.free)
        self._there[number] = self._plan.add_obstacle(polygon)
