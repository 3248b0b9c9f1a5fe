"""A slow and larger person at the mouth of a passage (NIST 2.10, which is test 7 of ISO 20414)."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianType
from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import SPACING, crowd_model, evacuate

ROOM, PASSAGE = 6.0, 60.0
"""Metres, long enough for people behind to catch up with the slow one. The door lets 25 people
through in some 20 s; a person at 0.8 m/s loses this lead to people at 1.25 m/s in 45 m. In a
shorter passage the last people walk freely, with or without a slow one ahead."""
OTHERS = 24
BODY, LARGER_BODY = 0.2, 0.31
"""Core radii, metres: the larger body takes more than half of the narrow passage."""
SPEED, SLOWER = 1.25, 0.8


def passage(seed: int, *, width: float, impaired: bool) -> dict[str, Any]:
    """24 people, and one nearer to the passage than they, cross to the far side of two rooms.

    Args:
        seed: of the run.
        width: of the passage between the rooms, metres.
        impaired: whether that person is slow and larger, or like the others.

    Returns:
        The common figures, and ``overtaken_by``, the number of others who left earlier.
    """
    low, high = (ROOM - width) / 2, (ROOM + width) / 2
    end = 2 * ROOM + PASSAGE
    floor = union_all(
        [
            box(0.0, 0.0, ROOM, ROOM),
            box(ROOM, low, ROOM + PASSAGE, high),
            box(ROOM + PASSAGE, 0.0, end, ROOM),
        ]
    )
    line = ((end, 0.0), (end, ROOM))
    plan = FloorPlan(floor, exits=[Exit("end", *line)])
    shipped = MobilityMap.load()
    kinds = [
        PedestrianType(mobility_map=shipped, name="adult", core_radius=BODY),
        PedestrianType(mobility_map=shipped, name="impaired", core_radius=LARGER_BODY),
    ]
    model = crowd_model(plan, seed, pedestrian_types=kinds)
    model.add_pedestrians(
        [[ROOM - 0.5, ROOM / 2]],
        preferred_speeds=SLOWER if impaired else SPEED,
        type_index=int(impaired),
    )
    places = plan.random_points(
        OTHERS,
        model.rng,
        within=box(0.0, 0.0, ROOM - 1.5, ROOM),
        spacing=max(SPACING, 2 * BODY + 0.05),
        clearance=BODY + 0.05,
    )
    model.add_pedestrians(places, preferred_speeds=SPEED)
    run = evacuate(model, 300.0)
    found = crossings(run.trajectories, *line)
    own = np.flatnonzero(found.person == 0)
    return {**run.figures(), "overtaken_by": int(own[0]) if len(own) else None}
