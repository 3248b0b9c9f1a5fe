"""The picture of a floor plan or a building."""

from __future__ import annotations

from pathlib import Path

from mesa_mobility.buildings import Building
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan import FloorPlan

KINDS = ".png", ".svg", ".pdf"
"""Ends of the names of pictures."""


def check_picture(path: Path) -> None:
    """Raise FloorPlanError unless a file's name ends as a picture's does."""
    if path.suffix.lower() not in KINDS:
        raise FloorPlanError(f"{path}: expected a name that ends in {', '.join(KINDS)}")


def draw_plan(plan: FloorPlan | Building, path: Path) -> None:
    """Draw each level to a file, complete or not at all, with the names of doors and exits.

    Raises:
        FloorPlanError: the file cannot be written.
    """
    from mesa_mobility.results.floor import plan_figure

    check_picture(path)
    figure = plan_figure(plan)
    with replacing(path, FloorPlanError) as temporary:
        figure.savefig(temporary, format=path.suffix.lower()[1:])
