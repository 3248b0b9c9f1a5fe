"""Twelve cabins on a corridor, each with an exit allocated to it (IMO test 10)."""

from __future__ import annotations

from typing import Any

from shapely import Polygon, box, union_all

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate

WALL = 0.1
"""Thickness of the walls, taken from the cabins, metres."""
DOOR = 0.9
LOW, HIGH, TOP = 5.0, 5.9, 10.9
END = 17.8
BELOW = tuple((3.0 * k, 3.0 * k + 3.0, 3.0 * k + 1.0) for k in range(6))
"""Cabins 1 to 6: left wall, right wall and left jamb of the door, metres."""
ABOVE = (
    (0.0, 3.0, 1.0), (3.0, 6.0, 4.0), (7.2, 9.0, 7.7), (9.0, 12.0, 10.0), (12.0, 15.0, 13.0),
    (15.0, 18.0, 16.0),
)  # fmt: skip
"""Cabins 7 to 12."""
MAIN = ((6.0, TOP), (7.2, TOP))
SECONDARY = ((END, LOW), (END, HIGH))
TO_SECONDARY = frozenset({5, 6, 11, 12})


def cabin(number: int) -> Polygon:
    """Floor of a cabin, 1 to 12."""
    lower = number <= 6
    left, right, _ = BELOW[number - 1] if lower else ABOVE[number - 7]
    bottom, top = (0.0, LOW - WALL) if lower else (HIGH + WALL, TOP)
    return box(left + WALL / 2, bottom, right - WALL / 2, top)


def cabins_plan() -> FloorPlan:
    """Floor plan of the test: a corridor, a short side corridor and twelve cabins.

    The main exit is at the end of the side corridor, the secondary exit at the right end of the
    corridor. The doors of the cabins are gaps in the walls; the plan has no gates.
    """
    parts = [box(0.0, LOW, END, HIGH), box(6.0, HIGH, 7.2, TOP)]
    for number in range(1, 13):
        lower = number <= 6
        jamb = (BELOW[number - 1] if lower else ABOVE[number - 7])[2]
        low, high = (LOW - WALL, LOW) if lower else (HIGH, HIGH + WALL)
        parts += [cabin(number), box(jamb, low, jamb + DOOR, high)]
    return FloorPlan(
        union_all(parts),
        exits=[Exit("main", *MAIN), Exit("secondary", *SECONDARY)],
        name="cabins",
    )


def cabins(seed: int) -> dict[str, Any]:
    """23 people, two a cabin and one in cabin 3, leave by the exit assigned to their cabin.

    Returns:
        The common figures, and how many of the ``to_main`` and ``to_secondary`` left by
        their exit, and how many left by another, ``astray``.
    """
    plan = cabins_plan()
    model = crowd_model(plan, seed)
    given = []
    for number in range(1, 13):
        count = 1 if number == 3 else 2
        places = plan.random_points(
            count, model.rng, within=cabin(number), spacing=SPACING, clearance=CLEARANCE
        )
        name = "secondary" if number in TO_SECONDARY else "main"
        model.add_pedestrians(places, exits=[name])
        given += [name] * count
    run = evacuate(model, 300.0)
    left = {
        name: {int(person) for person in crossings(run.trajectories, *line).person}
        for name, line in (("main", MAIN), ("secondary", SECONDARY))
    }
    right = {name: sum(given[person] == name for person in people) for name, people in left.items()}
    return {
        **run.figures(),
        "to_main": right["main"],
        "to_secondary": right["secondary"],
        "astray": sum(len(people) for people in left.values()) - sum(right.values()),
    }
