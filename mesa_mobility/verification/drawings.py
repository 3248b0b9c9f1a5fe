"""Pictures of runs for reports: walls, and the ways of some of the people."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.results import Trajectories

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_PEOPLE, _MOST_POINTS = 60, 150
_collected: ContextVar[list[Drawing] | None] = ContextVar("_collected", default=None)


@dataclass(frozen=True, eq=False)
class Drawing:
    """What is drawn of a run.

    Attributes:
        walls: (m, 4) metres.
        ways: (k, 2) metres, one array for each person drawn.
        people: people in the run.
    """

    walls: NDArray[np.float64]
    ways: list[NDArray[np.float32]]
    people: int


@contextmanager
def first_run_drawn() -> Iterator[list[Drawing]]:
    """Yields a list, which gets the drawing of the first run whose figures the block computes."""
    found: list[Drawing] = []
    token = _collected.set(found)
    try:
        yield found
    finally:
        _collected.reset(token)


def collect(trajectories: Trajectories, walls: NDArray[np.float64]) -> None:
    """Keep the drawing of a run where one is asked for, with these walls (m, 4), metres."""
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
    found.append(Drawing(walls, [way.astype(np.float32) for way in ways], len(people)))


def draw(drawing: Drawing) -> Figure:
    """Walls black, ways blue with a dot where each begins."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 3.6), dpi=90, layout="constrained")
    axes = figure.subplots()
    axes.add_collection(
        LineCollection(list(drawing.walls.reshape(-1, 2, 2)), colors="#222222", linewidths=1.0)
    )
    axes.add_collection(
        LineCollection(list(drawing.ways), colors="#2166ac", linewidths=0.6, alpha=0.6)
    )
    begins = np.array([way[0] for way in drawing.ways]).reshape(-1, 2)
    axes.plot(*begins.T, ".", color="#2166ac", markersize=3)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set(xlabel="x (m)", ylabel="y (m)")
    return figure
