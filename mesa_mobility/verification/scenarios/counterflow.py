"""Two rooms joined by a corridor, with people on their way in both directions (IMO test 8)."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.distributions import Uniform
from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate
from mesa_mobility.verification.scenarios.rooms import MALES_30_TO_50

ROOMS = Polygon(
    [(0, 0), (10, 0), (10, 4), (20, 4), (20, 0), (30, 0), (30, 10), (20, 10), (20, 6), (10, 6),
     (10, 10), (0, 10)]
)  # fmt: skip
START_1, START_2 = box(0.0, 0.0, 5.5, 10.0), box(24.7, 0.0, 30.0, 10.0)
ENTRANCE_2 = ((20.0, 4.0), (20.0, 6.0))
FDS_EVAC_S = 136.0
"""Seconds that FDS+Evac needs for 100 against 100."""
LIMIT_S = 300.0
"""People inside after so many seconds count as stuck."""


def counterflow(
    seed: int, *, opposing: int, people: int = 100, limit_s: float = LIMIT_S, **rules: Any
) -> dict[str, Any]:
    """100 people cross from room 1 to room 2 while others come the other way.

    They leave by the far wall of the room that they go to, which is open over its whole width:
    people who have arrived do not obstruct others.

    Args:
        seed: of the run.
        opposing: people who start in room 2.
        people: people who start in room 1.
        limit_s: when the run ends at the latest, seconds.
        **rules: passed to ``PedestrianModel``, to override the default preset.
    """
    plan = FloorPlan(
        ROOMS,
        exits=[Exit("room 2", (30.0, 0.0), (30.0, 10.0)), Exit("room 1", (0.0, 0.0), (0.0, 10.0))],
        gates=[Gate("entrance 1", (10.0, 4.0), (10.0, 6.0)), Gate("entrance 2", *ENTRANCE_2)],
    )
    model = crowd_model(plan, seed, **rules)
    for count, start, goal in ((people, START_1, "room 2"), (opposing, START_2, "room 1")):
        if count:
            places = plan.random_points(
                count, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE
            )
            model.add_pedestrians(places, preferred_speeds=Uniform(*MALES_30_TO_50), exits=[goal])
    run = evacuate(model, limit_s)
    found = crossings(run.trajectories, *ENTRANCE_2)
    first = found.person < people
    entered = np.unique(found.person[first])
    last = float(found.time[first].max()) if len(entered) == people else None
    return {**run.figures(), "last_entered_s": last, "entered": len(entered)}
