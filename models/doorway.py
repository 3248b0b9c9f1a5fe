"""The paper's doorway (Figure 6): through one door, then on to a second."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate, MobilityMap, PedestrianModel, Range
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population

ROOM = 10.0
HALL = 8.0
WALL = 0.2


class Doorway(PedestrianModel):
    """A room, a door, a hall behind it, and a second door to leave by.

    The paper gives no dimensions: the room is 10 m square, the hall 8 m deep, and the second
    door lies 2 m to the side of the first.

    Args:
        pedestrians: people, all in the room at the start.
        door_width: width of both doors, metres.
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
        pedestrians: Annotated[int, Range(1, 200)] = 60,
        door_width: Annotated[float, Range(0.6, 4.0)] = 1.0,
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
        if not 0.6 <= door_width <= 4.0:
            raise ModelError(f"door_width: got {door_width}, expected 0.6 to 4 m")
        plan = doorway_plan(door_width)
        super().__init__(
            plan,
            preset=preset,
            mobility_map=mobility_map,
            population=population,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        places = plan.random_points(
            pedestrians,
            self.rng,
            within=box(0.0, 0.0, ROOM - 2.0, ROOM),
            spacing=0.5,
            clearance=0.3,
        )
        self.add_pedestrians(places, pre_movement=pre_movement)


def doorway_plan(door_width: float) -> FloorPlan:
    """Room (x 0 to 10 m), wall with the first door, hall, second door at the far end."""
    low, high = 5.0 - door_width / 2, 5.0 + door_width / 2
    end = ROOM + WALL + HALL
    floor = Polygon(
        [
            (0, 0),
            (ROOM, 0),
            (ROOM, low),
            (ROOM + WALL, low),
            (ROOM + WALL, 0),
            (end, 0),
            (end, ROOM),
            (ROOM + WALL, ROOM),
            (ROOM + WALL, high),
            (ROOM, high),
            (ROOM, ROOM),
            (0, ROOM),
        ]
    )
    return FloorPlan(
        floor,
        exits=[Exit("second door", (end, low + 2.0), (end, high + 2.0))],
        gates=[Gate("first door", (ROOM + WALL / 2, low), (ROOM + WALL / 2, high))],
        name="doorway",
    )
