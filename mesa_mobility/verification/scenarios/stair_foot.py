"""A room that empties into a corridor with a slow stretch instead of a stair (NIST 5.1)."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, SpeedZone
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate
from mesa_mobility.verification.scenarios.necks import counted

FLOOR = Polygon([(0, 0), (8, 0), (8, 5), (5, 5), (5, 20), (3, 20), (3, 5), (0, 5)])
ROOM = box(0.0, 0.0, 8.0, 5.0)
STAIR = box(3.0, 14.0, 5.0, 20.0)
NECK = box(3.0, 4.5, 5.0, 5.0)
CORRIDOR = box(3.0, 15.0, 5.0, 17.0)
FOOT = box(3.0, 12.0, 5.0, 14.0)
FACTOR = 0.5


def into_corridor(seed: int, *, slow: bool, people: int = 100) -> dict[str, Any]:
    """People leave a room of 8 m x 5 m by a corridor of 2 m x 15 m.

    Args:
        seed: of the run.
        slow: whether the last 6 m are walked at half speed.
        people: in the room at the start.

    Returns:
        The common figures; highest densities (1/m2) in boxes at the ``neck``, in the
        ``corridor`` and at the ``foot`` of the slow stretch, and ``foot_5_s``, the mean of the ten
        highest of half-seconds at the foot.
    """
    zones = [SpeedZone(STAIR, FACTOR)] if slow else []
    plan = FloorPlan(FLOOR, exits=[Exit("end", (3.0, 20.0), (5.0, 20.0))], zones=zones)
    model = crowd_model(plan, seed)
    places = plan.random_points(
        people, model.rng, within=ROOM, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    run = evacuate(model, 300.0)
    boxes = {"neck": NECK, "corridor": CORRIDOR, "foot": FOOT}
    counts = {name: counted(run, area) / area.area for name, area in boxes.items()}
    return {
        **run.figures(),
        **{name: float(values.max()) for name, values in counts.items()},
        "foot_5_s": float(np.sort(counts["foot"])[-10:].mean()),
    }
