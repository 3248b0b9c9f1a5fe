"""The picture of a floor plan or a building, with the names of doors, exits, rooms and stairs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from shapely.ops import polylabel

from mesa_mobility.floorplan import FloorPlan, Room
from mesa_mobility.results.floor import (
    DOOR,
    EXIT,
    LARGEST,
    WALL,
    Storey,
    draw_floor,
    ends_of_stairs,
    panels_of,
    storeys_alone,
)

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan.floor.openings import Opening

_MARGIN = 0.06
"""Room around a plan for numbers of exits, as a share of its length."""


def plan_figure(
    plan: FloorPlan | Building,
    largest: tuple[float, float] = LARGEST,
    labels: Mapping[str, str] | None = None,
) -> Figure:
    """A floor plan, or a panel for each level, with the names of doors, exits and rooms.

    Args:
        plan: the floor plan or the building.
        largest: width and height of the figure, inches.
        labels: what stands beside openings instead of their names, by name.
    """
    figure, panels = panels_of(storeys_alone(plan), largest=largest, margin=_MARGIN)
    handles: dict[str, Line2D | Patch] = {}
    for axes, storey in panels:
        for each in draw_floor(axes, storey.plan, storey.stairs, storey.refuges):
            handles.setdefault(str(each.get_label()), each)
        ends = ends_of_stairs(storey.plan, storey.stairs)
        for openings, colour in (
            (storey.plan.open_exits(), EXIT),
            (storey.plan.open_gates(), DOOR),
        ):
            for opening in openings:
                if opening not in ends:
                    _name(axes, storey.plan, opening, colour, labels or {})
        for room in storey.plan.rooms:
            _name_room(axes, storey.plan, room)
        for spot, names in _names_of_stairs(storey):
            _write(axes, spot, "\n".join(names), WALL, 7)
        axes.set_title(storey.title, fontsize=10)
        x_min, y_min, x_max, y_max = storey.plan.bounds
        margin = _MARGIN * max(x_max - x_min, y_max - y_min)
        axes.set_xlim(x_min - margin, x_max + margin)
        axes.set_ylim(y_min - margin, y_max + margin)
    figure.legend(
        handles=list(handles.values()),
        loc="outside lower center",
        ncols=len(handles),
        frameon=False,
        fontsize=9,
    )
    return figure


def _name(
    axes: Axes, plan: FloorPlan, opening: Opening, colour: str, labels: Mapping[str, str]
) -> None:
    """Write an opening's name beside it: a number of an exit outside, names inside."""
    x_min, y_min, x_max, y_max = plan.bounds
    x, y = opening.midpoint
    out = -1.0 if opening.kind == "exit" and opening.name in labels else 1.0
    dx, dy = out * ((x_min + x_max) / 2 - x), out * ((y_min + y_max) / 2 - y)
    level = abs(opening.b[0] - opening.a[0]) < abs(opening.b[1] - opening.a[1])
    # Beside an upright line, above or below one that lies.
    offset = (np.sign(dx) * 6.0 or 6.0, 0.0) if level else (0.0, np.sign(dy) * 6.0 or 6.0)
    axes.annotate(
        labels.get(opening.name, opening.name),
        (x, y),
        offset,
        textcoords="offset points",
        ha={1.0: "left", -1.0: "right"}.get(float(np.sign(offset[0])), "center"),
        va={1.0: "bottom", -1.0: "top"}.get(float(np.sign(offset[1])), "center"),
        color=colour,
        fontsize=9,
        fontweight="bold",
        zorder=7,
        bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 1.0},
    )


def _name_room(axes: Axes, plan: FloorPlan, room: Room) -> None:
    """Write a room's name where most free floor is around it, upright in a narrow room."""
    free = shapely.get_parts(shapely.intersection(room.shape, plan.free))
    parts = [part for part in free if isinstance(part, shapely.Polygon)]
    if not parts:
        return
    spot = polylabel(max(parts, key=lambda part: part.area), 0.1)
    x_min, y_min, x_max, y_max = room.shape.bounds
    text = _write(axes, spot, room.name, WALL, 7)
    text.set_rotation(90 if y_max - y_min > 1.5 * (x_max - x_min) else 0)


def _write(axes: Axes, spot: shapely.Point, said: str, colour: str, size: float) -> Text:
    return axes.text(
        spot.x,
        spot.y,
        said,
        ha="center",
        va="center",
        color=colour,
        fontsize=size,
        zorder=6,
        bbox={"facecolor": "white", "alpha": 0.85, "linewidth": 0, "pad": 0.3},
    )


def _names_of_stairs(storey: Storey) -> Iterator[tuple[shapely.Point, list[str]]]:
    """Where names of stairs and lifts go, those that lie above one another in one place."""
    own: dict[str, shapely.Geometry] = {}
    for name, shape in storey.named:
        own[name] = shapely.union(own.get(name, shapely.Polygon()), shape)
    named: list[tuple[shapely.Geometry, list[str]]] = []
    for name, shape in own.items():
        for number, (area, names) in enumerate(named):
            if shapely.intersection(area, shape).area > 0.0:
                named[number] = (shapely.union(area, shape), [*names, name])
                break
        else:
            named.append((shape, [name]))
    for area, names in named:
        yield area.centroid, names
