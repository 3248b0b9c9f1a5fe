"""75 people before a gate of half a metre behind a funnel.

The floor is that of an experiment of 2018, run 040_c_56_h- of the bottleneck series of
Forschungszentrum Juelich (doi 10.34735/ped.2018.1), as the documentation of PedPy has it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from shapely import Polygon, affinity, box

from benchmarks.conflicts.walking import Walk
from mesa_mobility import Exit, FloorPlan, Trajectories
from mesa_mobility.results import crossings
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model

PEOPLE, WIDTH, LIMIT_S = 75, 0.5, 300.0
LEFT = Polygon(
    [(-0.7, -1.1), (-0.25, -1.1), (-0.25, -0.15), (-0.4, 0.0), (-2.8, 0.0), (-2.8, 6.7),
     (-3.05, 6.7), (-3.05, -0.3), (-0.7, -0.3)]
)  # fmt: skip
"""The barrier on one side; its mirror image is on the other."""
FLOOR = box(-3.5, -2.0, 3.5, 8.0)
START = box(-2.8, 0.0, 2.8, 6.2)
"""Where people stood at the start of the experiment."""
LINE = ((-0.25, -0.15), (0.25, -0.15))
"""Where the funnel ends and the gate begins."""


def plan() -> FloorPlan:
    """The floor, with a way out along the whole wall behind the gate."""
    right = affinity.scale(LEFT, xfact=-1.0, origin=(0.0, 0.0))
    return FloorPlan(
        FLOOR.difference(LEFT).difference(right), exits=[Exit("out", (-3.5, -2.0), (3.5, -2.0))]
    )


def gate(seed: int) -> dict[str, Any]:
    """Figures of a run; ``flow_per_s`` from the first to the last who crosses the line."""
    floor = plan()
    assert abs(affinity.scale(LEFT, -1.0, origin=(0, 0)).distance(LEFT) - WIDTH) < 1e-9
    model = crowd_model(floor, seed)
    places = floor.random_points(
        PEOPLE, model.rng, within=START, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    assert model.inside == PEOPLE
    figures = Walk(model, LIMIT_S).run()
    found = crossings(Trajectories.of(model), *LINE)
    _, first = np.unique(found.person, return_index=True)
    times = np.sort(found.time[first])
    rate = (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 else None
    return {**figures, "passed": len(times), "flow_per_s": rate}


def cases() -> Sequence[Case]:
    """One case, for 100 seeds."""
    return [case(gate)]
