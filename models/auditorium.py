"""The paper's auditorium with adjacent offices (Figure 7): 750 people leave at once."""

from __future__ import annotations

from itertools import pairwise
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
    PedestrianType,
    Range,
    Room,
)
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population

WIDTH = 28.0
WING = 3.0
"""How much farther to the right the foyer reaches than the hall."""
HALL = 24.0
FOYER = 5.0
OFFICE = 4.0
WALL = 0.2
OFFICES = 6
PEOPLE_PER_OFFICE = 10

BLOCKS = ((1.5, 8.5), (10.0, 18.0), (19.5, 26.5))
"""Seat blocks, from x to x; aisles run between them and along the walls."""

ROWS = 19
FIRST_ROW = 3.5
ROW_PITCH = 0.95
SEAT_DEPTH = 0.42
SEAT_WIDTH = 0.55

HALL_DOOR = 1.8
EXIT_DOOR = 0.7
WIDE_EXIT_DOOR = 0.9
"""Where somebody is too wide for the narrower ones."""
OUTER_WALL = 0.4
OFFICE_DOOR = 0.9

WHEELCHAIR_SPACING = 1.25
"""Room for two wheelchairs, 1.2 m long, beside each other whichever way they face, metres."""
BEFORE_THE_FIRST_ROW = box(0.0, 0.0, WIDTH, 2.55)
"""Places of wheelchairs, clear of people who stand before the seats of the first row."""

FORECOURT = (3.0, 8.0)
"""Depth and width of the paved area outside each exit door; people leave by crossing it."""


class Auditorium(PedestrianModel):
    """A nearly full auditorium and six offices; everybody starts at once, nearest exit.

    The paper prints no plan.  This one has 19 rows of seats in three blocks, two double doors
    at the back that open to a foyer, offices on the foyer's far side, and an exit door of 0.7 m
    in an outer wall of 0.4 m at each end of the foyer; through both together pass the paper's
    three people a second.

    People too wide for the gap between two rows, such as those in wheelchairs, are before the first
    row.

    Args:
        pedestrians: people; a twelfth of them, but no more than ten an office, are in the offices.
        pre_movement: seconds before people set off, or their distribution.
        preset: "default" or "paper".
        mobility_map: a map or its file; by default the able-bodied one that ships.
        population: the types of people instead, as "mixed" or "able_bodied: 0.9, child: 0.1".
        exit_door: width of the exit doors, metres; by default 0.7, or 0.9 with a population some of
            whom are too wide for the gap between two rows.
        frames_per_step: frames that one step advances; 3 are 0.1 s.
        record: keep every frame.
        rng: seed or NumPy generator.
    """

    reference_occupancy = {5.49: 746, 71.43: 552, 181.31: 222, 307.67: 9}  # noqa: RUF012

    def __init__(
        self,
        pedestrians: Annotated[int, Range(1, 782)] = 750,
        pre_movement: Distribution | float = 0.0,
        preset: str = "default",
        mobility_map: MobilityMap | str | None = None,
        population: Population | str | None = None,
        exit_door: Annotated[float, Range(0.6, 2.0)] | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: int | np.random.Generator | None = None,
    ) -> None:
        seats = seat_places()
        most = len(seats) + OFFICES * PEOPLE_PER_OFFICE
        if not 1 <= pedestrians <= most:
            raise ModelError(f"pedestrians: got {pedestrians}, expected 1 to {most}")
        if exit_door is not None and not 0.6 <= exit_door <= 2.0:
            raise ModelError(f"exit_door: got {exit_door}, expected 0.6 to 2 m")
        plan = auditorium_plan(exit_door or exit_door_for(population))
        super().__init__(
            plan,
            preset=preset,
            mobility_map=mobility_map,
            population=population,
            frames_per_step=frames_per_step,
            record=record,
            rng=rng,
        )
        kinds = self.draw_types(pedestrians)
        wide = np.array([too_wide(kind.half_width) for kind in self.pedestrian_types])[kinds]
        if wide.any():
            places = plan.random_points(
                int(wide.sum()),
                self.rng,
                within=BEFORE_THE_FIRST_ROW,
                spacing=WHEELCHAIR_SPACING,
                clearance=WHEELCHAIR_SPACING / 2,
            )
            self.add_pedestrians(places, pre_movement=pre_movement, type_index=kinds[wide])
        kinds = kinds[~wide]
        in_offices = max(
            min(round(pedestrians / 12), OFFICES * PEOPLE_PER_OFFICE, len(kinds)),
            len(kinds) - len(seats),
        )
        taken = self.rng.choice(len(seats), len(kinds) - in_offices, replace=False)
        taken.sort()
        facing_stage = np.full(len(taken), -np.pi / 2)
        self.add_pedestrians(
            seats[taken],
            headings=facing_stage,
            pre_movement=pre_movement,
            type_index=kinds[in_offices:],
        )
        for office in range(OFFICES):
            own = kinds[office:in_offices:OFFICES]
            if len(own):
                places = plan.random_points(
                    len(own), self.rng, within=office_floor(office), spacing=0.7, clearance=0.35
                )
                headings = self.rng.uniform(-np.pi, np.pi, len(own))
                self.add_pedestrians(
                    places, headings=headings, pre_movement=pre_movement, type_index=own
                )


def too_wide(half_width: float) -> bool:
    """Whether a body of this half width, metres, has no room to walk between two rows of seats."""
    return 2.0 * half_width > ROW_PITCH - SEAT_DEPTH - 0.05


def exit_door_for(population: Population | str | None) -> float:
    """Width of exit doors for these people, metres."""
    types = () if population is None else PedestrianType.all_of(Population.of(population))
    return WIDE_EXIT_DOOR if any(too_wide(kind.half_width) for kind in types) else EXIT_DOOR


def seat_places() -> NDArray[np.float64]:
    """(n, 2) where seated people stand up: in front of each seat, in the gap between rows."""
    places = []
    for row in range(ROWS):
        y = FIRST_ROW + ROW_PITCH * row - (ROW_PITCH - SEAT_DEPTH) / 2
        for left, right in BLOCKS:
            count = int((right - left) / SEAT_WIDTH)
            offset = ((right - left) - count * SEAT_WIDTH) / 2
            x = left + offset + SEAT_WIDTH * (np.arange(count) + 0.5)
            places.append(np.column_stack([x, np.full(count, y)]))
    return np.concatenate(places)


def office_floor(office: int) -> Polygon:
    """Floor of one office."""
    width = WIDTH / OFFICES
    low = HALL + WALL + FOYER + WALL
    return box(office * width + WALL / 2, low, (office + 1) * width - WALL / 2, low + OFFICE)


def auditorium_plan(exit_door: float = EXIT_DOOR) -> FloorPlan:
    """Hall (y 0 to 24 m, stage below), foyer, and a row of offices; exit doors as wide as given."""
    foyer_low, foyer_high = HALL + WALL, HALL + WALL + FOYER
    hall_doors = [((a[1] + b[0]) / 2, HALL) for a, b in pairwise(BLOCKS)]
    parts = [box(0, 0, WIDTH, HALL), box(0, foyer_low, WIDTH + WING, foyer_high)]
    rooms = [Room("hall", parts[0], use="chairs"), Room("foyer", parts[1], use="standing")]
    gates = []
    for k, (x, y) in enumerate(hall_doors):
        a, b = x - HALL_DOOR / 2, x + HALL_DOOR / 2
        parts.append(box(a, y, b, y + WALL))
        gates.append(Gate(f"hall door {k + 1}", (a, y + WALL / 2), (b, y + WALL / 2)))
    for office in range(OFFICES):
        floor = office_floor(office)
        x = floor.centroid.x
        a, b = x - OFFICE_DOOR / 2, x + OFFICE_DOOR / 2
        parts += [floor, box(a, foyer_high, b, foyer_high + WALL)]
        y = foyer_high + WALL / 2
        gates.append(Gate(f"office door {office + 1}", (a, y), (b, y)))
        rooms.append(Room(f"office {office + 1}", floor, use="office"))
    seats = [
        box(left, FIRST_ROW + ROW_PITCH * row, right, FIRST_ROW + ROW_PITCH * row + SEAT_DEPTH)
        for row in range(ROWS)
        for left, right in BLOCKS
    ]
    middle = (foyer_low + foyer_high) / 2
    low, high = middle - exit_door / 2, middle + exit_door / 2
    depth, width = FORECOURT
    exits = []
    for side, wall, out in (("left", 0.0, -1.0), ("right", WIDTH + WING, 1.0)):
        outside, end = wall + out * OUTER_WALL, wall + out * (OUTER_WALL + depth)
        parts.append(box(min(wall, outside), low, max(wall, outside), high))
        parts.append(
            box(min(outside, end), middle - width / 2, max(outside, end), middle + width / 2)
        )
        rooms.append(Room(f"{side} forecourt", parts[-1]))
        x = wall + out * OUTER_WALL / 2
        gates.append(Gate(f"{side} exit door", (x, low), (x, high)))
        exits.append(Exit(f"{side} exit", (end, middle - width / 2), (end, middle + width / 2)))
    return FloorPlan(
        union_all(parts),
        obstacles=seats,
        exits=exits,
        gates=gates,
        name="auditorium",
        rooms=rooms,
    )
