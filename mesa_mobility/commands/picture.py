"""The picture of a floor plan or a building."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mesa_mobility.buildings import Building
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan import FloorPlan, Oddity

ODD = "#c1121f"
"""Colour of what is odd."""

KINDS = ".png", ".svg", ".pdf"
"""Ends of the names of pictures."""


def check_picture(path: Path) -> None:
    """Raise FloorPlanError unless a file's name ends as a picture's does."""
    if path.suffix.lower() not in KINDS:
        raise FloorPlanError(f"{path}: expected a name that ends in {', '.join(KINDS)}")


def draw_plan(
    plan: FloorPlan | Building, path: Path, marks: Sequence[Sequence[tuple[int, Oddity]]] = ()
) -> None:
    """Draw each level to a file, complete or not at all, with the names of doors, exits and rooms.

    Args:
        plan: what to draw.
        path: the file.
        marks: for each level from the top, what is odd, with its number.

    Raises:
        FloorPlanError: the file cannot be written.
    """
    from mesa_mobility.results.plan_picture import plan_figure

    check_picture(path)
    figure = plan_figure(plan)
    for axes, odd in zip(figure.axes, marks or [()] * len(figure.axes), strict=True):
        for number, oddity in odd:
            x, y = oddity.place
            axes.plot(x, y, "o", ms=9, mfc="none", mec=ODD, mew=1.2, zorder=7)
            mark = axes.annotate(str(number), (x, y), (5, 5), textcoords="offset points", zorder=8)
            mark.set(color=ODD, fontsize=8)
    with replacing(path, FloorPlanError) as temporary:
        figure.savefig(temporary, format=path.suffix.lower()[1:])
