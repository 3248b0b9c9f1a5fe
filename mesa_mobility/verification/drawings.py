"""Pictures of runs for reports: walls, and the ways of some of the people."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results import Trajectories
from mesa_mobility.results.engineering.doors import doors_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mesa_mobility.buildings import Building

_MOST_PEOPLE, _MOST_POINTS = 60, 150

_LARGEST = 6.0, 3.4
"""Width and height of the floor in a picture at most, inches."""

_COLUMN = 1.3
"""Width of a column of the legend, inches."""

_FLAT = 12.0
"""Times that a floor is longer than wide, from which on its width is stretched to be seen."""

_collected: ContextVar[list[Drawing] | None] = ContextVar("_collected", default=None)


@dataclass(frozen=True, eq=False)
class Drawing:
    """What is drawn of a run.

    Attributes:
        walls: (m, 4) metres.
        ways: (k, 2) metres, one array for each person drawn.
        people: people in the run.
        exits: (k, 4) lines by which people leave, metres.
        doors: (k, 4) lines of other doors, metres.
        stairs: (k, 2) metres, the outline of each flight, landing and car of a lift.
    """

    walls: NDArray[np.float64]
    ways: list[NDArray[np.float32]]
    people: int
    exits: NDArray[np.float64]
    doors: NDArray[np.float64]
    stairs: list[NDArray[np.float64]]


@contextmanager
def first_run_drawn() -> Iterator[list[Drawing]]:
    """Yields a list, which gets the drawing of the first run whose figures the block computes."""
    found: list[Drawing] = []
    token = _collected.set(found)
    try:
        yield found
    finally:
        _collected.reset(token)


def collect(
    trajectories: Trajectories, walls: NDArray[np.float64], plan: FloorPlan | Building
) -> None:
    """Keep the drawing of a run where one is asked for.

    Args:
        trajectories: the run.
        walls: (m, 4) metres.
        plan: its floor plan, or its building.
    """
    found = _collected.get()
    if found is None or found:
        return
    rows = trajectories.by_person
    people, starts = np.unique(trajectories.person[rows], return_index=True)
    tracks = np.split(rows, starts[1:])
    chosen = np.linspace(0, len(people) - 1, min(len(people), _MOST_PEOPLE)).astype(np.int64)
    ways = []
    for track in (tracks[k] for k in chosen):
        some = track[np.unique(np.linspace(0, len(track) - 1, _MOST_POINTS).astype(np.int64))]
        ways.append(np.column_stack([trajectories.x[some], trajectories.y[some]]))
    exits, doors = (
        np.array(
            [[*each.a, *each.b] for each, _ in doors_of(plan) if each.kind == kind],
            dtype=np.float64,
        ).reshape(-1, 4)
        for kind in ("exit", "gate")
    )
    shapes = []
    if not isinstance(plan, FloorPlan):
        shapes = [shape for stairs in plan.stairs for shape in plan.shapes_of(stairs)]
        shapes += [lift.shape for lift in plan.lifts]
    found.append(
        Drawing(
            walls,
            [way.astype(np.float32) for way in ways],
            len(people),
            exits,
            doors,
            [np.asarray(shape.exterior.coords)[:, :2] for shape in shapes],
        )
    )


def draw(drawing: Drawing) -> Figure:
    """Walls, doors, exits and stairs, and ways with a dot where each begins."""
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    from mesa_mobility.results.floor import DOOR, EXIT, STAIRS, WALL
    from mesa_mobility.results.plots import BODY

    points = np.concatenate(
        [np.asarray(drawing.walls).reshape(-1, 2), *map(np.asarray, drawing.stairs)]
    )
    wide, high = np.maximum(np.ptp(points, axis=0), 1e-3)
    flat = wide > _FLAT * high
    scale = min(_LARGEST[0] / wide, _LARGEST[1] / high)
    size = max(wide * scale, 2.4) + 0.8, (0.6 if flat else max(high * scale, 0.5)) + 1.1
    figure = Figure(figsize=size, dpi=130, layout="constrained")
    axes = figure.subplots()
    handles: list[Line2D | Patch] = [Line2D([], [], color=WALL, label="wall")]
    if drawing.stairs:
        axes.add_collection(PolyCollection(drawing.stairs, facecolor=STAIRS, edgecolor=WALL, lw=1))
        handles.append(Patch(color=STAIRS, label="stairs or lift"))
    for lines, colour, label in ((drawing.doors, DOOR, "door"), (drawing.exits, EXIT, "exit")):
        if len(lines):
            axes.add_collection(
                LineCollection(list(lines.reshape(-1, 2, 2)), colors=colour, linewidths=3, zorder=4)
            )
            handles.append(Line2D([], [], color=colour, linewidth=3, label=label))
    axes.add_collection(
        LineCollection(list(drawing.walls.reshape(-1, 2, 2)), colors=WALL, linewidths=1.0)
    )
    axes.add_collection(LineCollection(list(drawing.ways), colors=BODY, linewidths=0.7, alpha=0.6))
    begins = np.array([way[0] for way in drawing.ways]).reshape(-1, 2)
    axes.plot(*begins.T, ".", color=BODY, markersize=4)
    handles.append(Line2D([], [], color=BODY, marker=".", label="way of a person, from its dot"))
    axes.set_aspect("auto" if flat else "equal")
    axes.autoscale_view()
    axes.margins(0.03)
    axes.set(xlabel="x (m)", ylabel="y (m),\nstretched" if flat else "y (m)")
    columns = int(np.clip(size[0] / _COLUMN, 1, len(handles)))
    figure.legend(
        handles=handles, loc="outside lower center", ncols=columns, frameon=False, fontsize=8
    )
    return figure
