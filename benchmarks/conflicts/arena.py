"""40 people in the arena of JuPedSim's examples, whose rows are half a metre wide.

The plan is a file of JuPedSim's repository, examples/geometry/arena.wkt (LGPL-3.0), which is not
part of this one: ``--plans`` names the folder that has it as ``jupedsim_arena.wkt``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import Polygon

from benchmarks.conflicts.walking import Walk
from mesa_mobility import Exit, FloorPlan
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model

FILE = "jupedsim_arena.wkt"
PEOPLE, EXIT, LIMIT_S = 40, 1.2, 600.0
KINDS = ("natural", "row", "row, within", "row, anywhere")
NATURAL = (
    ((48.320587, 65.369087), (49.523266, 65.369339)),
    ((54.520294, 65.369339), (55.72057, 65.369339)),
    ((59.650173, 53.549717), (59.338211, 52.390953)),
    ((51.419758, 43.769276), (52.621613, 43.769276)),
)
"""The pieces of the outline that are 1.2 m long: the ends of the aisles, and one at the right."""
ROW = ((41.923298, 43.768486), (51.419758, 43.769276))
"""The wall of the bottom row, left of the aisle."""
MIDDLE = 3.077
"""Metres from its end: the exit begins at x = 45 m."""
OFF = 0.001
"""Metres that the exit in the row lies off the wall."""
OPPOSITE = ((41.923382, 44.269329), (51.419758, 44.269329))
"""The other wall of that row."""


def arena(seed: int, *, exits: str, file: str) -> dict[str, Any]:
    """Figures of a run.

    Args:
        seed: of the run, and of the place of the exit in the row.
        exits: "natural", or one of 1.2 m in the wall of the bottom row: "row" at its middle,
            1 mm beyond the wall; "row, within" there, 1 mm within the floor; "row, anywhere" at a
            place of the seed's, 1 mm beyond.
        file: the plan.
    """
    floor = floor_of(Path(file))
    lines: Sequence[Any] = NATURAL
    if exits != "natural":
        start, end = np.array(ROW)
        along = (end - start) / np.hypot(*(end - start))
        place = np.random.default_rng(seed).uniform(0.2, 8.0) if "any" in exits else MIDDLE
        beyond = np.array([along[1], -along[0]]) * (-OFF if "within" in exits else OFF)
        first = start + place * along + beyond
        lines = ((tuple(first), tuple(first + EXIT * along)),)
        row = shapely.LineString(ROW).distance(shapely.LineString(OPPOSITE))
        assert abs(row - 0.5) < 0.01
    for line in lines:
        assert abs(shapely.LineString(line).length - EXIT) < 0.01
        assert floor.boundary.distance(shapely.LineString(line)) < 2 * OFF
    plan = FloorPlan(floor, exits=[Exit(f"out {k}", *line) for k, line in enumerate(lines)])
    model = crowd_model(plan, seed)
    model.add_pedestrians(
        plan.random_points(PEOPLE, model.rng, spacing=SPACING, clearance=CLEARANCE)
    )
    assert model.inside == PEOPLE
    return Walk(model, LIMIT_S).run()


def floor_of(file: Path) -> Polygon:
    """The one polygon of the file."""
    (floor,) = shapely.from_wkt(file.read_text(encoding="utf-8")).geoms
    assert isinstance(floor, Polygon)
    assert len(floor.interiors) == 18
    assert abs(floor.area - 262.45) < 0.01
    return floor


def cases(plans: Path | None) -> Sequence[Case]:
    """Each kind of exits, for 50 seeds each; none where the file is not there."""
    if plans is None or not (plans / FILE).exists():
        print(f"arena: skipped, --plans {plans} has no {FILE}")
        return []
    return [case(arena, exits=kind, file=str(plans / FILE)) for kind in KINDS]
