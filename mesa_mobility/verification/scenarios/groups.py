"""A group of fast people and a slow one behind slow people (NIST 2.9, ISO 14)."""

from __future__ import annotations

from typing import Any

from shapely import box

from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate
from mesa_mobility.verification.scenarios.walks import corridor_plan

LENGTH, WIDTH = 40.0, 4.0
BEHIND, AHEAD = box(1.0, 0.0, 4.0, WIDTH), box(8.0, 0.0, 12.0, WIDTH)
FAST, SLOW = 1.25, 0.5
FAST_MEMBERS, SLOW_PEOPLE = 4, 10


def group_behind(seed: int, *, together: bool) -> dict[str, Any]:
    """Four fast people and a slow one start behind ten slow ones.

    Args:
        seed: of the run.
        together: whether the five are a group.

    Returns:
        The common figures, and ``spread_s``, seconds between the first and the last of the five
        at the end of the corridor.
    """
    model = crowd_model(corridor_plan(LENGTH, WIDTH), seed)
    plan = model.floor_plan
    group = "group 1" if together else None
    places = plan.random_points(
        FAST_MEMBERS + 1, model.rng, within=BEHIND, spacing=2 * SPACING, clearance=CLEARANCE
    )
    speeds = [FAST] * FAST_MEMBERS + [SLOW]
    model.add_pedestrians(places, preferred_speeds=speeds, group=group)
    places = plan.random_points(
        SLOW_PEOPLE, model.rng, within=AHEAD, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places, preferred_speeds=SLOW)
    run = evacuate(model, 3.0 * LENGTH / SLOW)
    found = crossings(run.trajectories, (LENGTH, 0.0), (LENGTH, WIDTH))
    times = found.time[found.person <= FAST_MEMBERS]
    complete = len(times) == FAST_MEMBERS + 1
    return {**run.figures(), "spread_s": float(times[-1] - times[0]) if complete else None}
