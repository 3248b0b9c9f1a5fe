"""The floor plan as the background of a picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building, Level, Refuge
    from mesa_mobility.floorplan.floor.openings import Opening

OUTSIDE, OBSTACLE, WALL, EXIT, DOOR = "#f2f2f0", "#b5b5b5", "#2b2b2b", "#00a03c", "#18a5d6"
ZONE, STAIRS, REFUGE = "#fbe9c8", "#e3def2", "#d3ecdb"
# Room on the page for labels, colour bar and legend, inches.
FRAME = (1.6, 1.4)
# More of it for each further row of panels: title, numbers and name of the axis.
ROW = 0.75
LARGEST = (11.0, 9.5)
_LEAST_ROW = 1.2
MARGIN = 0.02


@dataclass(frozen=True)
class Storey:
    """What one panel shows.

    Attributes:
        plan: the floor plan.
        stairs: polygons of flights, landings and cars of lifts that lead up or down from there.
        refuges: its refuges.
        rows: (n,) bool; rows of the run of people on it, and on the stairs up from it.
        title: of the panel.
        named: the polygons of ``stairs``, each with the name of the stairs or lift.
    """

    plan: FloorPlan
    stairs: tuple[shapely.Polygon, ...]
    refuges: tuple[Refuge, ...]
    rows: NDArray[np.bool_]
    title: str = ""
    named: tuple[tuple[str, shapely.Polygon], ...] = ()


def storeys_of(tracks: Tracks, plan: FloorPlan | Building) -> list[Storey]:
    """The panels of a run: one for a floor plan, one for each level of a building, from the top."""
    shown = storeys_alone(plan)
    if isinstance(plan, FloorPlan):
        return [replace(shown[0], rows=np.ones(len(tracks), dtype=np.bool_))]
    levels = _from_the_top(plan)
    found, above = list[Storey](), np.inf
    for level, storey in zip(levels, shown, strict=True):
        on_stairs = ~np.isin(tracks.level, [each.number for each in levels])
        rows = on_stairs & (level.elevation <= tracks.z) & (tracks.z < above)
        found.append(replace(storey, rows=rows | (tracks.level == level.number)))
        above = level.elevation
    return found


def storeys_alone(plan: FloorPlan | Building) -> list[Storey]:
    """The panels of a floor plan or a building without people."""
    nobody = np.zeros(0, dtype=np.bool_)
    if isinstance(plan, FloorPlan):
        return [Storey(plan, (), (), nobody)]
    found = []
    for level in _from_the_top(plan):
        named = tuple(_stairs_of(plan, level.number))
        found.append(
            Storey(
                plan.floor_plan_of(level.number),
                tuple(shape for _, shape in named),
                tuple(level.refuges),
                nobody,
                f"level {level.number}" + (f" ({level.name})" if level.name else ""),
                named,
            )
        )
    return found


def _from_the_top(building: Building) -> list[Level]:
    return sorted(building.levels, key=lambda level: level.elevation, reverse=True)


def panels_of(
    storeys: Sequence[Storey],
    times: int = 1,
    largest: tuple[float, float] = LARGEST,
    margin: float = MARGIN,
) -> tuple[Figure, list[tuple[Axes, Storey]]]:
    """A figure with a panel for each storey, at each of some times, and what each panel shows.

    The panels of one time follow each other. Those of one storey have two columns.

    Args:
        storeys: what to show.
        times: how many.
        largest: width and height of the figure, inches.
        margin: room around a floor, as a share of its length.
    """
    count = len(storeys) * times
    columns = min(2, count) if len(storeys) == 1 or times == 1 else len(storeys)
    x0, y0, x1, y1 = shapely.total_bounds([each.plan.walkable for each in storeys])
    around = margin * max(x1 - x0, y1 - y0)
    bounds = (x0 - around, y0 - around, x1 + around, y1 + around)
    rows = -(-count // columns)
    figure, axes = floor_figure(bounds, rows=rows, columns=columns, largest=largest)
    for panel in axes[count:]:
        panel.set_axis_off()
    return figure, list(zip(axes, list(storeys) * times, strict=False))


def ends_of_stairs(plan: FloorPlan, stairs: Sequence[shapely.Polygon]) -> list[Opening]:
    """The exits of a level that lead onto stairs, and the gates of lifts."""
    on_stairs = shapely.union_all(stairs).buffer(1e-6)
    return [
        each
        for each in (*plan.open_exits(), *plan.open_gates())
        if stairs and on_stairs.covers(each.line)
    ]


def _stairs_of(building: Building, level: int) -> Iterator[tuple[str, shapely.Polygon]]:
    """The flights, landings and cars of lifts that lead up or down from a level, with names."""
    for stairs in building.stairs:
        if level in (stairs.upper, stairs.lower):
            for shape in building.shapes_of(stairs):
                yield stairs.name, shape
    for lift in building.lifts:
        if level in lift.numbers:
            yield lift.name, lift.shape


def floor_figure(
    bounds: tuple[float, float, float, float],
    *,
    rows: int,
    columns: int,
    largest: tuple[float, float] = LARGEST,
) -> tuple[Figure, list[Axes]]:
    """A figure of panels as large as the plan's shape allows, and its axes in reading order.

    Args:
        bounds: of what a panel shows: least x and y, greatest x and y, metres.
        rows: of panels.
        columns: of panels.
        largest: width and height of the figure, inches.
    """
    x_min, y_min, x_max, y_max = bounds
    width, height = columns * (x_max - x_min), rows * (y_max - y_min)
    frame = FRAME[1] + ROW * (rows - 1)
    # Of many rows the panels need some room, even on a picture that is higher than asked.
    high = max(largest[1] - frame, _LEAST_ROW * rows)
    scale = min((largest[0] - FRAME[0]) / width, high / height)
    size = (max(width * scale + FRAME[0], 6.5), max(height * scale + frame, 2.6))
    figure = Figure(figsize=size, dpi=150, layout="compressed")
    return figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def draw_floor(
    axes: Axes,
    plan: FloorPlan,
    stairs: Sequence[shapely.Polygon] = (),
    refuges: Sequence[Refuge] = (),
) -> list[Line2D | Patch]:
    """Draw free floor white, obstacles grey, walls dark, exits, doors and slow zones coloured.

    Refuges are coloured areas with their names.

    Args:
        axes: to draw on.
        plan: the floor plan.
        stairs: flights, landings and cars of lifts beside it, coloured.
        refuges: areas on it.

    Returns:
        Handles for a legend that explains what was drawn.
    """
    axes.set_facecolor(OUTSIDE)
    handles: list[Line2D | Patch] = []
    # Holes of the walkable area are pillars and the like: obstacles to the eye.
    outlines = [shapely.Polygon(part.exterior) for part in shapely.get_parts(plan.walkable)]
    solid = shapely.difference(shapely.union_all(outlines), plan.free)
    axes.add_patch(PathPatch(floor_path(plan.free), facecolor="white", linewidth=0, zorder=1))
    if not solid.is_empty:
        axes.add_patch(PathPatch(floor_path(solid), facecolor=OBSTACLE, linewidth=0, zorder=1))
        handles.append(Patch(color=OBSTACLE, label="obstacle"))
    for part in stairs:
        axes.add_patch(
            PathPatch(floor_path(part), facecolor=STAIRS, edgecolor=WALL, lw=0.5, zorder=2)
        )
    if stairs:
        handles.append(Patch(color=STAIRS, label="stairs or lift"))
    for zone in plan.zones:
        inside = shapely.intersection(zone.area, plan.free)
        if inside.is_empty:
            continue
        axes.add_patch(PathPatch(floor_path(inside), facecolor=ZONE, linewidth=0, zorder=2))
    if plan.zones:
        handles.append(Patch(color=ZONE, label="slow zone"))
    for refuge in refuges:
        axes.add_patch(
            PathPatch(floor_path(refuge.shape), facecolor=REFUGE, edgecolor=EXIT, zorder=2)
        )
        spot = refuge.shape.representative_point()
        name = axes.text(spot.x, spot.y, refuge.name, ha="center", va="center", zorder=2)
        name.set(color=EXIT, fontsize=7)
    if refuges:
        handles.append(Patch(facecolor=REFUGE, edgecolor=EXIT, label="refuge"))
    axes.add_collection(
        LineCollection(
            list(np.asarray(plan.walls).reshape(-1, 2, 2)), colors=WALL, linewidths=1.1, zorder=4
        )
    )
    handles.insert(0, Line2D([], [], color=WALL, linewidth=1.6, label="wall"))
    ends = ends_of_stairs(plan, stairs)
    exits = [each for each in plan.open_exits() if each not in ends]
    for openings, colour, label in ((plan.open_gates(), DOOR, "door"), (exits, EXIT, "exit")):
        if openings:
            lines = [(opening.a, opening.b) for opening in openings]
            axes.add_collection(
                LineCollection(lines, colors=colour, linewidths=3.5, capstyle="butt", zorder=5)
            )
            handles.append(Line2D([], [], color=colour, linewidth=3.5, label=label))
    x_min, y_min, x_max, y_max = plan.bounds
    margin = MARGIN * max(x_max - x_min, y_max - y_min)
    axes.set_xlim(x_min - margin, x_max + margin)
    axes.set_ylim(y_min - margin, y_max + margin)
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.spines[:].set_visible(False)
    return handles


def _polygons(area: shapely.Geometry) -> list[shapely.Polygon]:
    return [part for part in shapely.get_parts(area) if isinstance(part, shapely.Polygon)]


def floor_path(area: shapely.Geometry) -> Path:
    """The outlines and holes of an area as one path."""
    rings = [
        Path(np.asarray(ring.coords)[:, :2], closed=True)
        # Normalised, holes run against their outline and stay empty when filled.
        for part in _polygons(shapely.normalize(area))
        for ring in (part.exterior, *part.interiors)
    ]
    return Path.make_compound_path(*rings)
