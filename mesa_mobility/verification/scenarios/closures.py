"""Exits that close, are assigned, or lie on the shorter way (NIST 4.1, ISO 17)."""

from __future__ import annotations

from typing import Any

import numpy as np
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.verification.runs import crowd_model, evacuate

SIDE = 10.0
CLOSES_S = 1.0
RIGHT = ((SIDE, 4.5), (SIDE, 5.5))
LEFT = ((0.0, 4.5), (0.0, 5.5))


def closing_exit(seed: int) -> dict[str, Any]:
    """One person heads for exit 1, 4 m away, which closes after 1 s; exit 2 is 6 m away."""
    plan = FloorPlan(
        box(0.0, 0.0, SIDE, SIDE), exits=[Exit("exit 1", *RIGHT), Exit("exit 2", *LEFT)]
    )
    model = crowd_model(plan, seed)
    model.add_pedestrians([[6.0, 5.0]])
    run = evacuate(model, 60.0, [(CLOSES_S, lambda m: m.floor_plan.close_gate("exit 1"))])
    times, places = run.track(0)
    return {
        **run.figures(),
        "x_when_closed": float(np.interp(CLOSES_S, times, places[:, 0])),
        "by_exit_1": len(run.crossing_times(*RIGHT)),
        "by_exit_2": len(run.crossing_times(*LEFT)),
    }


ROOM = box(0.0, 0.0, 14.0, 20.0)
NEAR = ((0.0, 9.5), (0.0, 10.5))
FAR = ((14.0, 9.5), (14.0, 10.5))
SCREEN = box(2.0, 0.0, 2.4, 19.0)
"""Leaves 1 m at its upper end: round it, the near exit is more than 18 m away."""


def shortest_way(seed: int, *, screen: bool = False, assigned: str = "") -> dict[str, Any]:
    """One person stands 4 m from one exit and 10 m from the other.

    Args:
        seed: of the run.
        screen: whether a screen in front of the near exit makes that way the longer one.
        assigned: "near" or "far", or nothing.
    """
    plan = FloorPlan(
        ROOM, exits=[Exit("near", *NEAR), Exit("far", *FAR)], obstacles=[SCREEN] if screen else []
    )
    model = crowd_model(plan, seed)
    model.add_pedestrians([[4.0, 10.0]], exits=[assigned] if assigned else None)
    run = evacuate(model, 60.0)
    return {
        **run.figures(),
        "by_near": len(run.crossing_times(*NEAR)),
        "by_far": len(run.crossing_times(*FAR)),
    }
