"""One able-bodied person alone: how long they take from all kinds of places.

Nobody is there to be in the way. Whoever takes long is in the way of themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from shapely import Polygon, box, union_all

from benchmarks.conflicts.walking import Walk
from benchmarks.conflicts.ways import Ways
from mesa_mobility import Exit, FloorPlan
from mesa_mobility.floorplan import FloorPlan as Plan
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model

PLANS, STARTS = 40, 500
"""Plans, and starts in them, over all seeds."""
GAP, WIDEST = 0.45, 1.2
"""Least and greatest width of a gap, metres."""
CORE, NEAR = 0.14, 0.7
"""Radius of the body, and metres from a corner within which most of them start."""
TIMES, MORE_S = 2.0, 3.0
"""They have so many times the time of their way at their speed, and so many seconds more."""


def lone(seed: int) -> dict[str, Any]:
    """Figures of one start; ``late`` is 1 for somebody who takes too long."""
    plan = draw_plan(seed % PLANS)
    ways = Ways(plan.free, plan.walls)
    rng = np.random.default_rng([seed, 1])
    model = crowd_model(plan, seed)
    place = _start(plan, ways, rng)
    (person,) = model.add_pedestrians([place], headings=[float(rng.uniform(-np.pi, np.pi))])
    assert model.inside == 1
    goal = plan.exits[0].line
    length, speed = float(ways.lengths([place], goal)[0]), person.preferred_speed
    due = TIMES * length / speed + MORE_S
    figures = Walk(model, max(60.0, 3.0 * due)).run()
    took = figures["out_s"]
    return {
        **figures,
        "late": int(took is None or took > due),
        "start": place.tolist(),
        "length_m": length,
        "speed": speed,
        "due_s": due,
    }


def draw_plan(number: int) -> Plan:
    """One of ``PLANS``: corners of corridors, doors between rooms, and walls with gaps."""
    rng = np.random.default_rng([number, 2])
    gap = GAP if number < 8 else float(rng.uniform(GAP, WIDEST))
    kind = number % 4
    if kind == 0:  # a corridor that meets a narrow row at its end
        wide, long = float(rng.uniform(0.8, 2.0)), float(rng.uniform(4.0, 8.0))
        gap = 0.55 if number == 0 else gap
        floor = union_all([box(0, 0, 1.2 if number == 0 else wide, long), box(-6, 0, 0, gap)])
        exits = [Exit("out", (-6.0, 0.0), (-6.0, gap))]
    elif kind == 1:  # two rooms and a door between them
        low, wall = float(rng.uniform(0.0, 4.0 - gap)), float(rng.choice([0.1, 0.2, 0.5]))
        far = 4.0 + wall
        floor = union_all([box(0, 0, 4, 4), box(4, low, far, low + gap), box(far, 0, far + 3, 4)])
        exits = [Exit("out", (far + 3, 1.0), (far + 3, 3.0))]
    elif kind == 2:  # two gaps in walls that stand 1 to 2 m apart
        apart = float(rng.uniform(1.0, 2.0))
        floor = box(0, 0, 6 + apart, 4)
        for x in (3.0, 3.0 + apart):
            low = float(rng.uniform(0.0, 4.0 - gap))
            floor -= box(x, -1, x + 0.2, low)
            floor -= box(x, low + gap, x + 0.2, 5)
        exits = [Exit("out", (6 + apart, 1.5), (6 + apart, 2.5))]
    else:  # an exit as wide as the gap, and a pillar that leaves another one
        low = float(rng.uniform(0.3, 3.7 - gap))
        x = 6.0 - gap - 0.4
        floor = box(0, 0, 6, 4) - box(x, low - 0.3, x + 0.4, low + gap + 0.3)
        exits = [Exit("out", (6.0, low), (6.0, low + gap))]
    assert isinstance(floor, Polygon)
    return FloorPlan(floor, exits=exits, name=f"lone {number}")


def _start(plan: Plan, ways: Ways, rng: np.random.Generator) -> np.ndarray[Any, Any]:
    """A place with room for a body; three of four near a corner."""
    room = plan.free.buffer(-CORE - 0.01)
    corners = ways.corners
    x0, y0, x1, y1 = plan.free.bounds
    for _ in range(10_000):
        place = rng.uniform((x0, y0), (x1, y1))
        if len(corners) and rng.random() < 0.75:
            place = corners[rng.integers(len(corners))] + rng.uniform(-NEAR, NEAR, 2)
        if room.intersects(box(*place, *place).centroid):
            return np.asarray(place)
    raise AssertionError("no place to start")


def cases() -> Sequence[Case]:
    """One start a seed."""
    return [case(lone)]
