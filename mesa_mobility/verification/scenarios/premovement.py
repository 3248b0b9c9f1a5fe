"""People in a room who start after individual pre-movement times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.distributions import Distribution
from mesa_mobility.verification.runs import CLEARANCE, Run, crowd_model, evacuate
from mesa_mobility.verification.scenarios.rooms import SMALL_ROOM, SMALL_ROOM_DOOR

MOVED_M = 0.05
"""A person this far from their initial position has started, metres."""

ROOM_TO_STAND = 1.0
"""Metres between people at the start: nobody has to wait for another to get going."""


def late_starters(seed: int, *, people: int, times: Distribution) -> dict[str, Any]:
    """People leave a room of 8 m x 5 m, each after a time drawn for them.

    Returns:
        The common figures, and ``assigned`` and ``started``, seconds by person; None for one
        who never started.
    """
    plan = FloorPlan(SMALL_ROOM, exits=[Exit("door", *SMALL_ROOM_DOOR)])
    model = crowd_model(plan, seed)
    places = plan.random_points(people, model.rng, spacing=ROOM_TO_STAND, clearance=CLEARANCE)
    assigned = times.draw(people, model.rng)
    model.add_pedestrians(places, pre_movement=assigned)
    run = evacuate(model, float(assigned.max()) + 60.0, stop_when_stalled=False)
    started = [_start(run, person, places[person]) for person in range(people)]
    return {**run.figures(), "assigned": assigned.tolist(), "started": started}


def _start(run: Run, person: int, place: NDArray[np.float64]) -> float | None:
    times, track = run.track(person)
    away = np.flatnonzero(np.hypot(*(track - place).T) > MOVED_M)
    return float(times[away[0]]) if len(away) else None
