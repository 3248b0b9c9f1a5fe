"""Two groups crossing a plaza at right angles."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from shapely import box

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianModel, Range
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population


class OpenSpace(PedestrianModel):
    """One group walks east, another north; they meet in the middle of a square plaza.

    Args:
        pedestrians: people in both groups together.
        size: side of the plaza, metres.
        pre_movement: seconds before people set off, or their distribution.
        preset: "default" or "paper".
        mobility_map: a map or its file; by default the able-bodied one that ships.
        population: the types of people instead, as "mixed" or "able_bodied: 0.9, child: 0.1".
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 1000)] = 100,
        size: Annotated[float, Range(10.0, 100.0)] = 30.0,
        pre_movement: Distribution | float = 0.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        population: Population | str | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        if pedestrians < 1:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 or more")
        if not size >= 10.0:
            raise ModelError(f"size: got {size}, expected 10 m or more")
        plan = FloorPlan(
            box(0.0, 0.0, size, size),
            exits=[
                Exit("east", (size, 0.0), (size, size)),
                Exit("north", (0.0, size), (size, size)),
            ],
            name="plaza",
        )
        super().__init__(
            plan,
            preset=preset,
            mobility_map=mobility_map,
            population=population,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        eastwards = pedestrians - pedestrians // 2
        third, margin = size / 3.0, 0.5
        west = box(margin, third, third - margin, 2.0 * third)
        south = box(third, margin, 2.0 * third, third - margin)
        for count, area, exit_name in (
            (eastwards, west, "east"),
            (pedestrians // 2, south, "north"),
        ):
            if count:
                places = plan.random_points(
                    count, self.rng, within=area, spacing=0.6, clearance=0.3
                )
                self.add_pedestrians(places, exits=[exit_name], pre_movement=pre_movement)
