"""Scenarios of JuPedSim and Vadere, and plans with sources: their people on their floors."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility import Files, FloorPlan, MobilityMap, PedestrianModel, Source, Visit
from mesa_mobility.errors import FloorPlanError, MobilityError, ModelError
from mesa_mobility.floorplan.formats.people import People
from mesa_mobility.floorplan.scenario import read_scenario
from mesa_mobility.populations import Population

PLACES = (0.5, 0.3), (0.45, 0.27), (0.4, 0.25)
"""Least distances of people to each other and to walls, metres: the next where there is no room."""

NEAR = 1.0
"""Metres within which people stand whose place is taken or too near to a wall."""


class Scenario(PedestrianModel):
    """The people of a scenario of another simulation, or of the sources of a floor plan.

    Start areas, numbers, times, speeds, pre-movement, places to visit and exits are those of the
    file; bodies and behaviour are not. Warnings say what is left out.

    Args:
        plan: file or folder of the scenario: JuPedSim's zip, Vadere's .scenario, or a floor plan
            with sources.
        preset: "default" or "paper".
        mobility_map: a map or its file; by default the able-bodied one that ships.
        population: the types of people instead, as "mixed" or "able_bodied: 0.9, child: 0.1".
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
        exits: of a scenario that has none, as the model `floor_plan` takes them.

    Raises:
        ModelError: no file, or no room for the people of a start area.
        FloorPlanError: the file cannot be read, or has no people.
    """

    def __init__(
        self,
        plan: Annotated[Path | str | None, Files("*.zip", "*.scenario", "*.geojson")] = None,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        population: Population | str | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: int | np.random.Generator | None = None,
        exits: str | None = None,
    ) -> None:
        if plan is None:
            raise ModelError("plan: got none, expected a scenario (.zip, .scenario, .geojson)")
        floor, people = read_scenario(plan, exits)
        super().__init__(
            floor,
            preset=preset,
            mobility_map=mobility_map,
            population=population,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        self._taken = np.empty((0, 2))
        moved = 0
        for each in people:
            try:
                moved += self._add(each, floor)
            except MobilityError as error:
                raise ModelError(f"{plan}: {each.name}: {error}") from None
        if moved:
            warnings.warn(
                f"{plan}: {moved} people start up to {NEAR:g} m from their place, which has no "
                "room for their bodies",
                stacklevel=2,
            )

    def _add(self, people: People, floor: FloorPlan) -> int:
        """Put people on the floor, or a source; how many start elsewhere than asked for."""
        free = shapely.union_all([floor.free])
        known: dict[str, Any] = {
            "route": [
                Visit(_on(free, stop.area), stop.stay, stop.capacity)
                for stop in people.stops
                if not stop.area.intersection(free).is_empty
            ],
            "exits": _exits(people, floor),
            "preferred_speeds": people.speed,
        }
        if people.pre_movement is not None:
            known["pre_movement"] = people.pre_movement
        if people.times:
            self.add_source(Source(area=_on(free, people.area), times=people.times, **known))
            return 0
        if people.spots:
            try:
                self.add_pedestrians(people.spots, **known)
            except (ModelError, FloorPlanError):
                around = people.area.buffer(NEAR)
                self._put(self._places(1, around.intersection(free), floor), known)
                return 1
            self._taken = np.vstack([self._taken, people.spots])
            return 0
        self._put(self._places(people.number, _on(free, people.area), floor), known)
        return 0

    def _put(self, places: np.ndarray, known: dict[str, Any]) -> None:
        self.add_pedestrians(places, **known)
        self._taken = np.vstack([self._taken, places])

    def _places(self, count: int, area: BaseGeometry, floor: FloorPlan) -> np.ndarray:
        """Random places in an area, closer to each other where there is no room for all."""
        for spacing, clearance in PLACES[:-1]:
            try:
                return floor.random_points(
                    count,
                    self.rng,
                    within=area,
                    spacing=spacing,
                    clearance=clearance,
                    avoid=self._taken,
                )
            except FloorPlanError:
                continue
        spacing, clearance = PLACES[-1]
        return floor.random_points(
            count, self.rng, within=area, spacing=spacing, clearance=clearance, avoid=self._taken
        )


def _on(free: BaseGeometry, area: BaseGeometry) -> BaseGeometry:
    """The largest part of an area on the floor.

    Raises:
        ModelError: no part is.
    """
    parts = [
        part
        for part in shapely.get_parts(shapely.intersection(area, free))
        if part.geom_type == "Polygon" and part.area > 0
    ]
    if not parts:
        spot = area.centroid
        raise ModelError(f"the area around ({spot.x:.2f}, {spot.y:.2f}) has no floor in it")
    return max(parts, key=lambda part: part.area)


def _exits(people: People, floor: FloorPlan) -> list[str] | None:
    """Names of the exits by which people leave; None for all."""
    names = [
        exit.name
        for exit in floor.exits
        for asked in people.exits or ()
        if exit.name == asked or exit.name.startswith(f"{asked} side ")
    ]
    return names or None
