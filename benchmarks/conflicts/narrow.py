"""Narrow places: corridors for one, with and without a niche, and doors both ways and one way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from shapely import Polygon, box, union_all

from benchmarks.conflicts.walking import Walk
from mesa_mobility import Exit, FloorPlan, PedestrianType
from mesa_mobility.populations import presets
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model

ROOM, LENGTH, WIDTH = 8.0, 24.0, 0.8
"""A room at either end of a corridor, metres."""
MIDDLE, NICHE = ROOM + LENGTH / 2, (4.0, 1.0)
"""Middle of the corridor, and the length and depth of a niche there, metres."""
FIRST, FILE = 4.0, 0.6
"""Metres from the middle to the first of those who meet, and from one to the next."""
CROWD = 70
"""People on either side of a door."""
LIMIT_S = 600.0
TEN = 10.0
"""Metres of the room before a door that people of one type leave by, and of the one behind it."""


def niche(seed: int, *, niche: bool) -> dict[str, Any]:
    """Ten meet ten in a corridor in which they cannot pass.

    Args:
        seed: of the run.
        niche: whether there is one beside the middle.
    """
    low, high, end = 4.0 - WIDTH / 2, 4.0 + WIDTH / 2, ROOM + LENGTH
    parts = [box(0, 0, ROOM, 8), box(ROOM, low, end, high), box(end, 0, end + ROOM, 8)]
    if niche:
        parts.append(box(MIDDLE - NICHE[0] / 2, high, MIDDLE + NICHE[0] / 2, high + NICHE[1]))
    exits = [Exit("west", (0, 1), (0, 7)), Exit("east", (end + ROOM, 1), (end + ROOM, 7))]
    floor = union_all(parts)
    assert abs(floor.area - 2 * 64 - LENGTH * WIDTH - niche * NICHE[0] * NICHE[1]) < 1e-9
    model = crowd_model(FloorPlan(floor, exits=exits), seed)
    for sense, goal in ((-1, "east"), (1, "west")):
        places = [(MIDDLE + sense * (FIRST + FILE * k), 4.0) for k in range(10)]
        model.add_pedestrians(places, headings=0.0 if sense < 0 else np.pi, exits=[goal])
    assert model.inside == 20
    return Walk(model, LIMIT_S).run()


def two_rooms(width: float, depth: float) -> FloorPlan:
    """Two rooms of 10 m x 8 m, joined by a passage so many metres wide and deep, with exits to the
    west and the east."""
    low, high, x = 4.0 - width / 2, 4.0 + width / 2, 10.0 + depth
    floor = Polygon(
        [(0, 0), (10, 0), (10, low), (x, low), (x, 0), (x + 10, 0), (x + 10, 8), (x, 8), (x, high),
         (10, high), (10, 8), (0, 8)]
    )  # fmt: skip
    exits = [Exit("west", (0.0, 2.0), (0.0, 6.0)), Exit("east", (x + 10, 2.0), (x + 10, 6.0))]
    return FloorPlan(floor, exits=exits)


def both_ways(seed: int, *, width: float, depth: float) -> dict[str, Any]:
    """70 people on either side of a passage so many metres wide and deep cross it."""
    x, plan = 10.0 + depth, two_rooms(width, depth)
    model = crowd_model(plan, seed)
    for start, goal in ((box(1.5, 0, 9.5, 8), "east"), (box(x + 0.5, 0, x + 8.5, 8), "west")):
        places = plan.random_points(CROWD, model.rng, within=start, spacing=0.5, clearance=0.3)
        model.add_pedestrians(places, exits=[goal])
    assert model.inside == 2 * CROWD
    return Walk(model, LIMIT_S).run()


def door(seed: int, *, kind: str, width: float) -> dict[str, Any]:
    """60 people of one type, or 20 in wheelchairs, leave a room of 10 m by a door."""
    low, high, end = (TEN - width) / 2, (TEN + width) / 2, TEN + 8.2
    floor = union_all(
        [box(0, 0, TEN, TEN), box(TEN, low, TEN + 0.2, high), box(TEN + 0.2, 0, end, TEN)]
    )
    plan = FloorPlan(floor, exits=[Exit("end", (end, 0.0), (end, TEN))])
    type_ = PedestrianType.named(kind)
    core = type_.core_radius
    assert isinstance(core, float)
    people = 20 if "wheelchair" in kind else 60
    model = crowd_model(plan, seed, pedestrian_types=[type_])
    places = plan.random_points(
        people,
        model.rng,
        within=box(0, 0, TEN - 2.0, TEN),
        spacing=max(0.5, 2 * core + 0.1),
        clearance=max(0.3, core + 0.05),
    )
    everybody = model.add_pedestrians(places)
    assert model.inside == people
    slowest = min(person.preferred_speed for person in everybody)
    return Walk(model, LIMIT_S + 2 * TEN / slowest).run()


def cases() -> Sequence[Case]:
    """Corridors, doors both ways, and doors of each type, for 10 seeds each."""
    return [
        *(case(niche, niche=there) for there in (True, False)),
        case(both_ways, width=1.0, depth=0.2),
        case(both_ways, width=0.7, depth=10.0),
        *(case(door, kind=kind, width=width) for width in (0.9, 1.0, 1.2)
          for kind in presets()["every_type"].names),
    ]  # fmt: skip
