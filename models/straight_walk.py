"""People walking straight ahead, each at a speed of its own, far enough apart not to matter."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from shapely import box

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianModel, Range
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population

LANE = 3.0


class StraightWalk(PedestrianModel):
    """Walkers side by side, 3 m apart, from a standing start to a line straight ahead.

    Args:
        pedestrians: number of walkers.
        slowest: preferred speed of the first, m/s.
        fastest: preferred speed of the last, m/s; the others lie evenly between. People of a
            population have the speeds of their types instead.
        length: metres to walk.
        preset: "default" or "paper".
        mobility_map: a map or its file; by default the able-bodied one that ships.
        population: the types of people instead, as "mixed" or "able_bodied: 0.9, child: 0.1".
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 200)] = 50,
        slowest: Annotated[float, Range(0.3, 2.5)] = 0.9,
        fastest: Annotated[float, Range(0.3, 2.5)] = 1.5,
        length: Annotated[float, Range(5.0, 100.0)] = 40.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        population: Population | str | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        if pedestrians < 1:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 or more")
        if not 0.0 < slowest <= fastest < np.inf:
            raise ModelError(
                f"slowest and fastest: got {slowest} and {fastest} m/s, "
                "expected 0 < slowest <= fastest"
            )
        if not length >= 5.0:
            raise ModelError(f"length: got {length}, expected 5 m or more")
        width = LANE * pedestrians
        plan = FloorPlan(
            box(-2.0, 0.0, length, width),
            exits=[Exit("finish", (length, 0.0), (length, width))],
            name="straight walk",
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
        lanes = LANE * (np.arange(pedestrians) + 0.5)
        self.add_pedestrians(
            np.column_stack([np.zeros(pedestrians), lanes]),
            headings=np.zeros(pedestrians),
            preferred_speeds=np.linspace(slowest, fastest, pedestrians)
            if population is None
            else None,
        )
