"""Scenarios of other simulations, read as a floor plan and the people on it."""

import os
from pathlib import Path
from typing import Any

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.checks import one_line
from mesa_mobility.floorplan.formats.people import People
from mesa_mobility.floorplan.formats.plan_format import PLANS
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.floorplan.plan import FloorPlan
from mesa_mobility.plugins.formats import READ


def read_scenario(
    path: str | os.PathLike[str], exits: str | None = None
) -> tuple[FloorPlan, list[People]]:
    """The floor plan of a scenario, and its people.

    Warns of what the reader has changed or left out.

    Args:
        path: of a format whose files have people.
        exits: of a scenario that has none, as ``FloorPlan.from_file`` takes them.

    Raises:
        FloorPlanError: the file cannot be read, or has no people.
    """
    chosen: Any = PLANS.of(path, READ)
    with one_line(str(path)):
        content = chosen.read(Path(path))
        if isinstance(content, Storeys) or not content.people:
            raise FloorPlanError(f"{path}: has no people, expected a scenario with some")
        people, content.people = content.people, []
        return FloorPlan.of_content(content, str(path), exits, None), people


def has_people(path: str | os.PathLike[str]) -> bool:
    """Whether a file is a scenario, or a plan with sources, whose people can walk.

    Raises:
        FloorPlanError: no format reads such a file, or it cannot be read.
    """
    chosen: Any = PLANS.of(path, READ)
    found: bool = chosen.has_people(Path(path))
    return found
