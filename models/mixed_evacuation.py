"""A floor of a care home: people of all types leave rooms by doors of 0.8 to 1.4 m."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon, box, union_all

from mesa_mobility import (
    Exit,
    FloorPlan,
    Gate,
    MobilityMap,
    PedestrianModel,
    Range,
    SpeedZone,
)
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population

ROOMS = 6
"""On each side of the corridor."""
ROOM_WIDTH, ROOM_DEPTH = 5.0, 5.0
WALL = 0.2
CORRIDOR = 2.2
"""Width of the corridor: two wheelchairs pass each other in 1.8 m (DIN 18040-1)."""
LENGTH = ROOMS * ROOM_WIDTH
DAY_ROOM = 10.0
"""Length of the day room at the corridor's left end."""
LOW = ROOM_DEPTH + WALL
HIGH = LOW + CORRIDOR
TOP = HIGH + WALL + ROOM_DEPTH

FIRE_DOOR_AT = LENGTH / 2
STORES = (2, 9)
"""Rooms that are stores."""

WALKER = 0.25
"""Core radius in metres of the widest people on foot; wider ones are in wheelchairs."""
WHEELCHAIR_SPACING = 1.3
"""Metres between wheelchairs, 1.2 m long, and anybody else."""

STORE_DOOR, ROOM_DOOR, FIRE_DOOR, EXIT_DOOR = 0.8, 0.95, 1.2, 1.4
RAMP, RAMP_WIDTH = 8.0, 1.8
"""Metres, behind the door on the right; the exit on the left is level."""
RAMP_FACTOR = 0.7
"""Share of the speed on the level that people keep on the ramp: an assumption."""


class MixedEvacuation(PedestrianModel):
    """People of all types leave a floor of a care home, by a level exit and by one with a ramp.

    Twelve rooms, two of them stores, lie along a corridor of 2.2 m, which a fire door divides. A
    day room at its left end has an exit of its own. Doors have 0.8 m (stores), 0.95 m (rooms),
    1.2 m (fire door and day room) and 1.4 m (exits). The ramp is a zone of reduced speed. People
    in wheelchairs are not in stores.

    Args:
        pedestrians: people; two fifths are in the day room and the corridor, the others in rooms.
        population: the types of people, as "care_home" or "able_bodied: 0.9, child: 0.1".
        ramp_factor: share of their speed that people keep on the ramp.
        pre_movement: seconds before people set off, or their distribution.
        preset: "default" or "paper".
        mobility_map: a map or its file for everybody, instead of the population.
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 100)] = 60,
        population: Population | str | None = "care_home",
        ramp_factor: Annotated[float, Range(0.1, 1.0)] = RAMP_FACTOR,
        pre_movement: Distribution | float = 0.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        frames_per_step: int = 3,
        record: bool = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        if not 1 <= pedestrians <= 100:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 to 100")
        if not 0.0 < ramp_factor <= 1.0:
            raise ModelError(f"ramp_factor: got {ramp_factor}, expected more than 0 and at most 1")
        plan = care_home_plan(ramp_factor)
        super().__init__(
            plan,
            preset=preset,
            mobility_map=mobility_map,
            population=population if mobility_map is None else None,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        kinds = self.draw_types(pedestrians)
        outside = round(0.4 * pedestrians)
        there = np.empty((0, 2))
        for wide in (True, False):
            for own, floor in (
                (kinds[:outside], union_all([day_room(), corridor()])),
                (kinds[outside:], union_all([room_floor(k) for k in range(2 * ROOMS)])),
            ):
                chosen = own[self._wide[own] == wide]
                if len(chosen):
                    places = self._places(len(chosen), floor, wide, there)
                    self.add_pedestrians(places, pre_movement=pre_movement, type_index=chosen)
                    there = np.concatenate([there, places])

    @property
    def _wide(self) -> NDArray[np.bool_]:
        """(types,) whether people of each type are in wheelchairs, by the width of their body."""
        return np.array([kind.half_width > WALKER for kind in self.pedestrian_types])

    def _places(
        self, n: int, floor: Polygon, wide: bool, there: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Random places on a part of the floor, away from the people who are there."""
        if wide:
            floor = floor.difference(union_all([room_floor(k) for k in STORES]))
        return self.floor_plan.random_points(
            n,
            self.rng,
            within=floor,
            spacing=WHEELCHAIR_SPACING if wide else 2.0 * WALKER + 0.3,
            clearance=WHEELCHAIR_SPACING / 2.0 if wide else WALKER + 0.1,
            avoid=there,
        )


def room_floor(room: int) -> Polygon:
    """Floor of one of the twelve rooms: 0 to 5 below the corridor, 6 to 11 above it."""
    left = (room % ROOMS) * ROOM_WIDTH
    low = 0.0 if room < ROOMS else HIGH + WALL
    return box(left + WALL / 2, low, left + ROOM_WIDTH - WALL / 2, low + ROOM_DEPTH)


def day_room() -> Polygon:
    """Floor of the day room, as deep as the rooms and the corridor together."""
    return box(-WALL - DAY_ROOM, 0.0, -WALL, TOP)


def corridor() -> Polygon:
    """Floor of the corridor."""
    return box(0.0, LOW, LENGTH, HIGH)


def care_home_plan(ramp_factor: float = RAMP_FACTOR) -> FloorPlan:
    """Day room (left), corridor with a fire door, rooms on both sides, a ramp at its right end.

    Args:
        ramp_factor: share of their speed that people keep on the ramp.
    """
    middle = (LOW + HIGH) / 2
    before, behind = FIRE_DOOR_AT - WALL / 2, FIRE_DOOR_AT + WALL / 2
    parts = [day_room(), corridor().difference(box(before, LOW, behind, HIGH))]
    gates: list[Gate] = []
    for room in range(2 * ROOMS):
        floor = room_floor(room)
        low, high = (ROOM_DEPTH, LOW) if room < ROOMS else (HIGH, HIGH + WALL)
        width, kind = (STORE_DOOR, "store") if room in STORES else (ROOM_DOOR, "room")
        left, right = floor.centroid.x - width / 2, floor.centroid.x + width / 2
        parts += [floor, box(left, low, right, high)]
        y = (low + high) / 2
        gates.append(Gate(f"{kind} door {room + 1}", (left, y), (right, y)))
    for name, left, right, width in (
        ("fire door", before, behind, FIRE_DOOR),
        ("day room door", -WALL, 0.0, FIRE_DOOR),
        ("ramp door", LENGTH, LENGTH + WALL, EXIT_DOOR),
    ):
        low, high = middle - width / 2, middle + width / 2
        parts.append(box(left, low, right, high))
        x = (left + right) / 2
        gates.append(Gate(name, (x, low), (x, high)))
    foot = LENGTH + WALL + RAMP
    ramp = box(LENGTH + WALL, middle - RAMP_WIDTH / 2, foot, middle + RAMP_WIDTH / 2)
    left, half = -WALL - DAY_ROOM, RAMP_WIDTH / 2
    return FloorPlan(
        union_all([*parts, ramp]),
        exits=[
            Exit("level exit", (left, middle - EXIT_DOOR / 2), (left, middle + EXIT_DOOR / 2)),
            Exit("foot of the ramp", (foot, middle - half), (foot, middle + half)),
        ],
        gates=gates,
        zones=[SpeedZone(ramp, ramp_factor, "ramp")] if ramp_factor < 1.0 else [],
        name="care home",
    )
