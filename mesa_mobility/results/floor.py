"""The floor plan as the background of a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan

OUTSIDE, OBSTACLE, WALL, EXIT, DOOR = "#f2f2f0", "#b5b5b5", "#2b2b2b", "#00a03c", "#18a5d6"
ZONE = "#fbe9c8"
# Room on the page for labels, colour bar and legend, inches.
FRAME = (1.6, 1.4)
LARGEST = (11.0, 9.5)


def floor_figure(plan: FloorPlan, *, rows: int, columns: int) -> tuple[Figure, list[Axes]]:
    """A figure of panels as large as the plan's shape allows, and its axes in reading order."""
    x_min, y_min, x_max, y_max = plan.bounds
    width, height = columns * (x_max - x_min), rows * (y_max - y_min)
    scale = min((LARGEST[0] - FRAME[0]) / width, (LARGEST[1] - FRAME[1]) / height)
    size = (
        max(width * scale + FRAME[0], 6.5),
        max(height * scale + FRAME[1] + 0.25 * (rows - 1), 2.6),
    )
    figure = Figure(figsize=size, dpi=150, layout="constrained")
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def draw_floor(axes: Axes, plan: FloorPlan) -> list[Line2D | Patch]:
    """Draw free floor white, obstacles grey, walls dark, exits, doors and slow zones coloured.

    Returns:
        Handles for a legend that explains what was drawn.
    """
    axes.set_facecolor(OUTSIDE)
    handles: list[Line2D | Patch] = []
    # Holes of the walkable area are pillars and the like: obstacles to the eye.
    outlines = [shapely.Polygon(part.exterior) for part in shapely.get_parts(plan.walkable)]
    solid = shapely.difference(shapely.union_all(outlines), plan.free)
    axes.add_patch(PathPatch(_path(plan.free), facecolor="white", linewidth=0, zorder=1))
    if not solid.is_empty:
        axes.add_patch(PathPatch(_path(solid), facecolor=OBSTACLE, linewidth=0, zorder=1))
        handles.append(Patch(color=OBSTACLE, label="obstacle"))
    for zone in plan.zones:
        inside = shapely.intersection(zone.area, plan.free)
        if inside.is_empty:
            continue
        axes.add_patch(PathPatch(_path(inside), facecolor=ZONE, linewidth=0, zorder=2))
    if plan.zones:
        handles.append(Patch(color=ZONE, label="slow zone"))
    axes.add_collection(
        LineCollection(
            list(np.asarray(plan.walls).reshape(-1, 2, 2)), colors=WALL, linewidths=1.1, zorder=4
        )
    )
    handles.insert(0, Line2D([], [], color=WALL, linewidth=1.6, label="wall"))
    for openings, colour, label in (
        (plan.open_gates(), DOOR, "door"),
        (plan.open_exits(), EXIT, "exit"),
    ):
        if openings:
            lines = [(opening.a, opening.b) for opening in openings]
            axes.add_collection(
                LineCollection(lines, colors=colour, linewidths=3.5, capstyle="butt", zorder=5)
            )
            handles.append(Line2D([], [], color=colour, linewidth=3.5, label=label))
    x_min, y_min, x_max, y_max = plan.bounds
    margin = 0.02 * max(x_max - x_min, y_max - y_min)
    axes.set_xlim(x_min - margin, x_max + margin)
    axes.set_ylim(y_min - margin, y_max + margin)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.spines[:].set_visible(False)
    return handles


def _polygons(area: shapely.Geometry) -> list[shapely.Polygon]:
    return [part for part in shapely.get_parts(area) if isinstance(part, shapely.Polygon)]


def _path(area: shapely.Geometry) -> Path:
    rings = [
        Path(np.asarray(ring.coords)[:, :2], closed=True)
        # Normalised, holes run against their outline and stay empty when filled.
        for part in _polygons(shapely.normalize(area))
        for ring in (part.exterior, *part.interiors)
    ]
    return Path.make_compound_path(*rings)
