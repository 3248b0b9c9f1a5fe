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
    """Draw each level to a file, complete or not at all: floor, walls, obstacles, exits and rooms.

    Args:
        plan: what to draw.
        path: the file.
        marks: for each level from the top, what is odd, with its number.

    Raises:
        FloorPlanError: the file cannot be written.
    """
    from mesa_mobility.results.floor import EXIT, draw_floor, panels_of, storeys_alone

    check_picture(path)
    figure, panels = panels_of(storeys_alone(plan))
    for (axes, storey), odd in zip(panels, marks or [()] * len(panels), strict=True):
        handles = draw_floor(axes, storey.plan, storey.stairs, storey.refuges)
        for each in storey.plan.open_exits():
            x, y = each.midpoint
            name = axes.text(x, y, each.name, ha="center", va="bottom", zorder=6)
            name.set(color=EXIT, fontsize=7)
        for room in storey.plan.rooms:
            spot = room.shape.point_on_surface()
            axes.text(spot.x, spot.y, room.name, ha="center", va="center", fontsize=6, zorder=6)
        for number, oddity in odd:
            x, y = oddity.place
            axes.plot(x, y, "o", ms=9, mfc="none", mec=ODD, mew=1.2, zorder=7)
            mark = axes.annotate(str(number), (x, y), (5, 5), textcoords="offset points", zorder=8)
            mark.set(color=ODD, fontsize=8)
        if storey.title:
            axes.set_title(storey.title)
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False)
    with replacing(path, FloorPlanError) as temporary:
        figure.savefig(temporary, format=path.suffix.lower()[1:])
