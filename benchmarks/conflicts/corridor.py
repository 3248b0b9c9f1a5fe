"""Eight people from either end of a corridor, who all go to the far end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from shapely import box

from benchmarks.conflicts.walking import Walk
from mesa_mobility import Exit, FloorPlan, Pedestrian, PedestrianModel
from mesa_mobility.populations import Population
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model

LENGTH, PEOPLE = 16.0, 8
"""Metres, and people from either end."""
WIDTHS = (1.6, 2.0, 2.4, 3.0)
POPULATIONS = (
    "every_type",
    "able_bodied: 0.75, wheelchair_manual: 0.25",
    "able_bodied: 0.5, walking_frame: 0.5",
)
START = 5.5
"""Metres from either end within which people start."""
SPACING, CLEARANCE = 0.75, 0.4
"""Metres: two wheelchairs of 0.35 m, and one and a little."""
LIMIT_S = 300.0
"""Beside the time that the slowest one takes alone."""


def crowd(seed: int, *, width: float, population: str) -> tuple[PedestrianModel, list[Pedestrian]]:
    """A model of the corridor, and its people: first those from the west."""
    exits = [Exit("east", (LENGTH, 0.0), (LENGTH, width)), Exit("west", (0.0, 0.0), (0.0, width))]
    plan = FloorPlan(box(0.0, 0.0, LENGTH, width), exits=exits)
    model = crowd_model(plan, seed, pedestrian_types=None, population=Population.of(population))
    starts = (box(0.0, 0.0, START, width), "east"), (box(LENGTH - START, 0, LENGTH, width), "west")
    people: list[Pedestrian] = []
    for area, goal in starts:
        places = plan.random_points(
            PEOPLE, model.rng, within=area, spacing=SPACING, clearance=CLEARANCE
        )
        people += model.add_pedestrians(places, exits=[goal])
    assert model.inside == 2 * PEOPLE
    assert all(person.position[0] < START for person in people[:PEOPLE])
    assert all(person.position[0] > LENGTH - START for person in people[PEOPLE:])
    return model, people


def corridor(seed: int, *, width: float, population: str) -> dict[str, Any]:
    """Figures of a run, with the types of those who are lost and who stood."""
    model, people = crowd(seed, width=width, population=population)
    slowest = min(person.preferred_speed for person in people)
    return Walk(model, LIMIT_S + LENGTH / slowest).run()


def cases() -> Sequence[Case]:
    """Each width with each population, for 20 seeds."""
    return [
        case(corridor, width=width, population=population)
        for population in POPULATIONS
        for width in WIDTHS
    ]
