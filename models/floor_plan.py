"""People leaving any floor plan or building, read from a file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np

from mesa_mobility import Building, Files, FloorPlan, MobilityMap, PedestrianModel, Range
from mesa_mobility.buildings import read_floor
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import plan_suffixes
from mesa_mobility.populations import Population


class FloorPlanEgress(PedestrianModel):
    """People all over a floor plan, or all levels of a building, leave by the nearest exit.

    Args:
        plan: file of the floor plan or the building, such as GeoJSON, WKT, DXF or IFC.
        pedestrians: people, at random places all over the free floor.
        pre_movement: seconds before people set off, or their distribution.
        preset: "default" or "paper".
        mobility_map: a map or its file; by default the able-bodied one that ships.
        population: the types of people instead, as "mixed" or "able_bodied: 0.9, child: 0.1".
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
        exits: of a plan whose file has none: "longest", lines "x1 y1, x2 y2" with semicolons
            between them, or a file of such lines.
        level: number or name of one level of a file that has several, which is then the plan.
        fill: who is in which room instead, as "hall=120; office*=office after uniform(0, 30)".
    """

    def __init__(
        self,
        plan: Annotated[Path | str | None, Files(*patterns())] = None,
        pedestrians: Annotated[int, Range(1, 500)] = 50,
        pre_movement: Distribution | float = 0.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        population: Population | str | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: int | np.random.Generator | None = None,
        exits: str | None = None,
        level: str | None = None,
        fill: str | None = None,
    ) -> None:
        if pedestrians < 1:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 or more")
        floor = read_plan(plan, exits, level)
        super().__init__(
            floor,
            preset=preset,
            mobility_map=mobility_map,
            population=population,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        if fill is not None:
            self.fill_as(fill, pre_movement)
            return
        places = floor.random_points(pedestrians, self.rng, spacing=0.5, clearance=0.3)
        self.add_pedestrians(places, pre_movement=pre_movement)


def patterns() -> list[str]:
    """Shell patterns of files that may hold a floor plan."""
    return [f"*{suffix}" for suffix in plan_suffixes()]


def read_plan(
    path: Path | str | None, exits: str | None = None, level: str | None = None
) -> FloorPlan | Building:
    """The floor plan or the building of a file.

    Args:
        path: the file.
        exits: of a plan whose file has none, as ``FloorPlan.from_file`` takes them.
        level: number or name of one level of a file that has several.

    Raises:
        ModelError: no file, or a plan without an exit.
        FloorPlanError: the file cannot be read, or is no floor plan.
    """
    if path is None:
        known = ", ".join(plan_suffixes())
        raise ModelError(f"plan: got none, expected a file of a floor plan ({known})")
    plan = read_floor(path, exits, level=level)
    if isinstance(plan, FloorPlan) and not plan.exits:
        raise ModelError(f"plan: {path} has no exit, expected one to leave by")
    return plan
