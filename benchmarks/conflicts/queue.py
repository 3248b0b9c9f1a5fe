"""Six people with walking aids line up, are served for 2 s each, and leave."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from mesa_mobility.behaviors import Counter, Queueing
from shapely import box

from benchmarks.conflicts.walking import Walk
from mesa_mobility import Exit, FloorPlan, PedestrianType
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import crowd_model

KINDS = ("walking_frame", "wheelchair_manual", "crutches")
PEOPLE, SERVICE_S, LIMIT_S = 6, 2.0, 600.0
SPEED = 0.6
"""Preferred speed of everybody, m/s: what is compared is lining up, not walking."""
WANTED = 1.5
"""Greatest ratio of the times."""
HALL = (16.0, 8.0)
SPACING, CLEARANCE = 0.9, 0.45
"""Metres at the start: two wheelchairs of 0.35 m and a little, and one."""


def queue(seed: int, *, kind: str) -> dict[str, Any]:
    """Figures of a run; ``ratio`` of the time of six able-bodied people of the same speed.

    Seed 0 has a line of 4 m in the middle of the hall, and people who come from beyond its end;
    others draw both.
    """
    figures = _served(seed, kind)
    out, theirs = figures["out_s"], _served(seed, "able_bodied")["out_s"]
    ratio = out / theirs if out and theirs else None
    wrong = "" if ratio is not None and ratio <= WANTED else f"ratio {ratio}"
    return {**figures, "able_bodied_s": theirs, "ratio": ratio, "too_long": wrong}


@cache
def _served(seed: int, kind: str) -> dict[str, Any]:
    plan = FloorPlan(box(0, 0, *HALL), exits=[Exit("out", (16, 0), (16, 2))])
    rng = np.random.default_rng([seed, 3])
    head, long, y = rng.uniform(8.0, 12.0), rng.uniform(3.0, 6.0), rng.uniform(2.0, 6.0)
    within = box(0.0, 0.0, head, HALL[1])
    places = plan.random_points(PEOPLE, rng, within=within, spacing=SPACING, clearance=CLEARANCE)
    if seed == 0:
        head, long, y = 8.0, 4.0, 4.0
        places = np.array([(1.0 + k % 3, 3.0 + k // 3) for k in range(PEOPLE)])
    counter = Counter([(head, y), (head - long, y)], service=SERVICE_S)
    model = crowd_model(plan, seed, pedestrian_types=[PedestrianType.named(kind)])
    lines = Queueing([counter])
    model.add_tactic(lines)
    model.add_pedestrians(places, route=[counter.visit], preferred_speeds=SPEED)
    assert model.inside == PEOPLE
    return Walk(model, LIMIT_S, queueing=lines, longest_service=SERVICE_S).run()


def cases() -> Sequence[Case]:
    """Each aid, for 20 seeds."""
    return [case(queue, kind=kind) for kind in KINDS]
