"""An office tower: people of all types leave its storeys by two stairs and a lift."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from shapely import Polygon, box

from mesa_mobility import (
    Building,
    Exit,
    Level,
    Lift,
    MobilityMap,
    PedestrianModel,
    Range,
    Stairs,
)
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population

LENGTH, DEPTH, RISE = 36.0, 18.0, 3.4
"""Length and depth of a storey, and metres from floor to floor."""
RISERS, TREAD, STAIR = 20, 0.28, 1.4
"""Of each stair: risers of 0.17 m, treads and clear width, metres."""
ROOMS, ROOM_LENGTH, ROOM_DEPTH, ROOM_DOOR, WALL = 3, 6.0, 4.5, 0.95, 0.1
"""Meeting rooms along the front of a storey, and the walls around them, metres."""
FIRST_ROOM = 8.0
"""Metres from the left end of a storey to the first room."""
LIFT_DOOR, LIFT_AT = 1.1, 17.5
"""Width of the door of the lift, and metres to its left edge."""
CAR_WIDTH, CAR_DEPTH, CAPACITY, SPEED = 1.6, 2.1, 13, 2.5
"""Of the car, metres, people and m/s."""
EXIT_DOOR, EXITS_AT = 1.8, (12.0, 24.0)
"""Width of the two exits, and metres to their left edges."""

WALKER = 0.25
"""Core radius in metres of the widest people on foot; wider ones are in wheelchairs."""
SPACING, WIDE_SPACING = 0.8, 1.3
"""Metres between people, and between wheelchairs, 1.2 m long, and anybody else."""


class OfficeTower(PedestrianModel):
    """People of all types leave an office tower by two stairs and a lift.

    Each storey is 36 m long and 18 m deep, with three meeting rooms. Dog-leg stairs 1.4 m wide at
    both ends and a lift for 13 people lead from storey to storey. The ground floor has two exits of
    1.8 m. Only people who do not use stairs take the lift.

    Args:
        pedestrians: people in all, spread evenly over the storeys.
        storeys: their number, the ground floor included.
        population: the types of people, as "mixed" or "able_bodied: 0.9, child: 0.1".
        pre_movement: seconds before people set off, or their distribution.
        preset: "default" or "paper".
        mobility_map: a map or its file for everybody, instead of the population.
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 1500)] = 600,
        storeys: Annotated[int, Range(2, 20)] = 6,
        population: Population | str | None = "mixed",
        pre_movement: Distribution | float = 0.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        frames_per_step: int = 3,
        record: bool = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        if not 1 <= pedestrians <= 1500:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 to 1500")
        if not 2 <= storeys <= 20:
            raise ModelError(f"storeys: got {storeys}, expected 2 to 20")
        tower = office_tower(storeys)
        super().__init__(
            tower,
            preset=preset,
            mobility_map=mobility_map,
            population=population if mobility_map is None else None,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        kinds = self.draw_types(pedestrians)
        wide = np.array([kind.half_width > WALKER for kind in self.pedestrian_types])[kinds]
        storey = self.rng.permutation(pedestrians) % storeys
        for level in range(storeys):
            ours = storey == level
            there = np.empty((0, 2))
            for chosen, spacing in (
                (kinds[ours & wide], WIDE_SPACING),
                (kinds[ours & ~wide], SPACING),
            ):
                if len(chosen):
                    places = tower.random_points(
                        len(chosen),
                        self.rng,
                        level=level,
                        spacing=spacing,
                        clearance=spacing / 2.0,
                        avoid=there,
                    )
                    self.add_pedestrians(places, pre_movement=pre_movement, type_index=chosen)
                    there = np.concatenate([there, places])


def office_tower(storeys: int = 6) -> Building:
    """The tower.

    Args:
        storeys: how many, the ground floor included.
    """
    levels = [_storey(k) for k in range(storeys)]
    heads = {
        "west": ((2.0, DEPTH), (2.0, DEPTH - STAIR)),
        "east": ((LENGTH - 2.0, 0.0), (LENGTH - 2.0, STAIR)),
    }
    stairs = [
        Stairs.dog_leg(f"{name} {k}", k + 1, k, head=head, risers=RISERS, tread=TREAD, turn="right")
        for name, head in heads.items()
        for k in range(storeys - 1)
    ]
    y = DEPTH - CAR_DEPTH - 0.2
    lift = Lift(
        "lift",
        levels,
        ((LIFT_AT, y), (LIFT_AT + LIFT_DOOR, y)),
        capacity=CAPACITY,
        speed=SPEED,
        width=CAR_WIDTH,
        depth=CAR_DEPTH,
    )
    return Building(levels, stairs, lifts=[lift], name="office tower")


def _storey(number: int) -> Level:
    exits = [
        Exit(f"exit {k + 1}", (left, 0.0), (left + EXIT_DOOR, 0.0))
        for k, left in enumerate(EXITS_AT)
    ]
    if number == 0:
        return Level(0, box(0.0, 0.0, LENGTH, DEPTH), exits=exits, name="ground floor")
    return Level(
        number,
        box(0.0, 0.0, LENGTH, DEPTH),
        RISE * number,
        obstacles=[wall for room in range(ROOMS) for wall in _room_walls(room)],
        name=f"storey {number}",
    )


def _room_walls(room: int) -> list[Polygon]:
    """The walls of a meeting room, with a door in the middle of the side away from the front."""
    left = FIRST_ROOM + room * ROOM_LENGTH
    right, middle, half = left + ROOM_LENGTH, left + ROOM_LENGTH / 2.0, ROOM_DOOR / 2.0
    low = ROOM_DEPTH - WALL
    return [
        box(left, 0.0, left + WALL, ROOM_DEPTH),
        box(left, low, middle - half, ROOM_DEPTH),
        box(middle + half, low, right, ROOM_DEPTH),
        box(right - WALL, 0.0, right, ROOM_DEPTH),
    ]
