"""Pictures of a run: tracks, occupancy and snapshots.

Figures are made without pyplot, so that no window and no global state is involved.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.floor import LARGEST, draw_floor, panels_of, storeys_of
from mesa_mobility.results.measures.by_type import people_by
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

# Largest number of track pieces in a picture; more cannot be distinguished and are slow to draw.
MOST_PIECES = 250_000
# Up to so many people, tracks are drawn strong enough to be followed one by one.
_FEW = 100
PAPER = "paper (Casburn et al. 2005, Fig. 7)"
# Without the green of exits, the blue of doors and the pale yellow that is lost on white.
TRACK_COLOURS = ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.9, 256)))
# Distinguishable with every kind of colour vision as far as twelve can be; those of the dashboard.
TYPE_COLOURS = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#cc79a7",
    "#56b4e9",
    "#e69f00",
    "#999999",
    "#5b3a93",
    "#8c510a",
    "#b5a300",
    "#00a6a6",
    "#b2182b",
)
BODY, LEFT_INSIDE, REFERENCE = "#2166ac", "#000000", "#d6604d"
STILL_INSIDE: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 5,
    "markeredgecolor": "white",
    "markeredgewidth": 0.6,
    "color": LEFT_INSIDE,
}


def plot_trajectories(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    title: str = "",
    largest: tuple[float, float] = LARGEST,
) -> None:
    """Draw everybody's track on the floor plan, coloured by time.

    In a building each level has a panel, the topmost first. It shows the stairs up from there, too.

    Args:
        trajectories: the run.
        plan: the floor plan or the building; walls are drawn dark, obstacles grey, doors and exits
            coloured.
        path: picture to write; its suffix chooses the format (.png, .svg, .pdf).
        title: first line of the picture.
        largest: width and height of the picture, inches.

    Raises:
        ResultsError: the file cannot be written.
    """
    storeys = storeys_of(trajectories, plan)
    figure, panels = panels_of(storeys, largest=largest)
    handles: dict[str, Line2D | Patch] = {}
    for panel, storey in panels:
        drawn = draw_floor(panel, storey.plan, storey.stairs, storey.refuges)
        panel.set_title(storey.title, fontsize=10)
        own = trajectories if storey.rows.all() else trajectories.only(storey.rows)
        tracks = _tracks(own, few=trajectories.people <= _FEW)
        panel.add_collection(tracks)
        left = _inside_at(own, trajectories.frames - 1)
        if len(left):
            panel.plot(own.x[left], own.y[left], **STILL_INSIDE, zorder=6)
            label = f"still inside after {trajectories.duration:.1f} s"
            drawn.append(Line2D([], [], **STILL_INSIDE, label=label))
        handles |= {str(each.get_label()): each for each in drawn}
    bar = figure.colorbar(tracks, ax=figure.axes, shrink=0.8, aspect=30, pad=0.02)
    bar.set_label("time since the start (s)")
    # Drawn faint so that crossing tracks show; the scale itself is not faint.
    if bar.solids is not None:
        bar.solids.set_alpha(1.0)
    finish(figure, list(handles.values()), title or f"Tracks of {trajectories.people} people", path)


def plot_snapshots(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    times: Sequence[float],
    title: str = "",
) -> None:
    """Draw people at given times: body cores as discs, with a stroke for the facing.

    Where there are several types, discs have the colours of types. In a building there is a panel
    for each level, the topmost first. It shows the people on the stairs up from there, too.

    Args:
        trajectories: the run.
        plan: the floor plan or the building.
        path: picture to write.
        times: seconds, one panel each, or one for each level.
        title: first line of the picture.

    Raises:
        ResultsError: no times, a time outside the run, or the file cannot be written.
    """
    if not times or not all(0 <= time <= trajectories.duration for time in times):
        raise ResultsError(
            f"snapshots at {list(times)} s asked of a run of {trajectories.duration:.2f} s"
        )
    types = people_by(trajectories, "type") if "type" in trajectories.person_data else {}
    storeys = storeys_of(trajectories, plan)
    figure, panels = panels_of(storeys, len(times))
    known: dict[str, Line2D | Patch] = {}
    for number, (panel, storey) in enumerate(panels):
        time = times[number // len(storeys)]
        for each in draw_floor(panel, storey.plan, storey.stairs, storey.refuges):
            known.setdefault(str(each.get_label()), each)
        rows = _inside_at(trajectories, round(time * trajectories.frame_rate))
        rows = rows[storey.rows[rows]]
        _draw_bodies(panel, trajectories, rows, _colours(types, len(trajectories.radii)))
        where = f"{storey.title}, " if storey.title else ""
        panel.set_title(f"{where}{time:g} s: {len(rows)} people inside", fontsize=10)
    said = [("person, facing the stroke", BODY)]
    if len(types) > 1:
        said = list(zip(types, cycle(TYPE_COLOURS), strict=False))
    handles = list(known.values())
    handles += [
        Line2D([], [], linestyle="none", marker="o", color=colour, label=name)
        for name, colour in said
    ]
    finish(figure, handles, title, path)


def plot_occupancy(
    occupancy: Sequence[Sequence[float]],
    path: str | os.PathLike[str],
    *,
    by_type: Mapping[str, Sequence[Sequence[float]]] | None = None,
    reference: Mapping[float, float] | None = None,
    reference_label: str = PAPER,
    title: str = "",
) -> None:
    """Draw how many people were inside against time.

    Args:
        occupancy: [[t, inside], ...], seconds and people.
        path: picture to write.
        by_type: occupancy of each type of people, by name, drawn as thinner lines.
        reference: people inside at some times (s), drawn as points to compare with.
        reference_label: their label in the legend.
        title: first line of the picture.

    Raises:
        ResultsError: an empty occupancy, or the file cannot be written.
    """
    if not len(occupancy):
        raise ResultsError("there is no occupancy to draw")
    time, inside = np.asarray(occupancy, dtype=np.float64).T
    figure = Figure(figsize=(8, 4.5), dpi=150, layout="constrained")
    axes = figure.subplots()
    # A type has the blue of a run that is drawn alone.
    colour, label = (LEFT_INSIDE, "everybody") if by_type else (BODY, "this run")
    axes.fill_between(time, inside, color=colour, alpha=0.08, linewidth=0)
    axes.plot(time, inside, color=colour, linewidth=2, label=label)
    for own_colour, (name, values) in zip(
        cycle(TYPE_COLOURS), (by_type or {}).items(), strict=False
    ):
        own = np.asarray(values, dtype=np.float64)
        words = name.replace("_", " ")
        axes.plot(own[:, 0], own[:, 1], color=own_colour, linewidth=1.2, label=words)
    if inside[-1] == 0:
        out = time[np.flatnonzero(inside == 0)[0]]
        axes.plot([out], [0], marker="o", color=colour, clip_on=False, zorder=5)
        # High enough to stay clear of a reference point beside it.
        axes.annotate(
            f"all out: {out:.1f} s",
            (out, 0),
            (8, 38),
            textcoords="offset points",
            ha="right",
            color=colour,
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8},
        )
    if reference:
        axes.plot(
            list(reference),
            list(reference.values()),
            linestyle="none",
            marker="D",
            markersize=7,
            markerfacecolor="white",
            markeredgewidth=1.8,
            color=REFERENCE,
            label=reference_label,
            clip_on=False,
            zorder=5,
        )
        for t, people in reference.items():
            axes.annotate(
                f"{people:g}",
                (t, people),
                (8, 6),
                textcoords="offset points",
                color=REFERENCE,
                fontsize=9,
            )
    if reference or by_type:
        axes.legend(frameon=False)
    axes.set_xlim(0, max(time[-1], *(reference or {0.0: 0.0}), 1e-9) * 1.03)
    axes.set_ylim(0, max(inside.max(), *(reference or {0.0: 0.0}).values(), 1) * 1.05)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=8, integer=True, steps=[1, 2, 5, 10]))
    axes.set_xlabel("time since the start (s)")
    axes.set_ylabel("people inside")
    axes.grid(alpha=0.25)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(title or "People inside", loc="left", fontsize=11)
    _save(figure, path)


def _inside_at(trajectories: Tracks, frame: int) -> NDArray[np.int64]:
    rows = np.arange(*trajectories.frame_offsets[frame : frame + 2])
    return rows[trajectories.exit_frames[trajectories.person[rows]] != frame]


def _tracks(trajectories: Tracks, *, few: bool) -> LineCollection:
    every = max(1, round(trajectories.frame_rate / 10), -(-len(trajectories) // MOST_PIECES))
    start, end = trajectories.steps(every)
    # Each person's every-th row only: its pieces then join end to end.
    kept = trajectories.frame[start] % every == 0
    start, end = start[kept], end[kept]
    # Later pieces are drawn on top, so the colour shows when the last people passed.
    in_time = np.argsort(trajectories.frame[start], kind="stable")
    start, end = start[in_time], end[in_time]
    pieces = np.empty((len(start), 2, 2))
    pieces[:, 0, 0], pieces[:, 0, 1] = trajectories.x[start], trajectories.y[start]
    pieces[:, 1, 0], pieces[:, 1, 1] = trajectories.x[end], trajectories.y[end]
    tracks = LineCollection(
        list(pieces),
        cmap=TRACK_COLOURS,
        linewidths=1.0 if few else 0.4,
        alpha=0.9 if few else 0.5,
        capstyle="round",
        rasterized=True,
        zorder=3,
    )
    tracks.set_array(trajectories.frame[start] / trajectories.frame_rate)
    tracks.set_clim(0.0, max(trajectories.duration, 1.0 / trajectories.frame_rate))
    return tracks


def _colours(types: Mapping[str, NDArray[np.int64]], people: int) -> NDArray[np.str_]:
    """(people,) colour of each by its type; one for all where there is one type, or none."""
    colours = np.full(people, BODY)
    if len(types) > 1:
        for colour, own in zip(cycle(TYPE_COLOURS), types.values(), strict=False):
            colours[own] = colour
    return colours


def _draw_bodies(
    axes: Axes, trajectories: Tracks, rows: NDArray[np.int64], colours: NDArray[np.str_]
) -> None:
    radius = trajectories.radii[trajectories.person[rows]]
    centre = np.column_stack((trajectories.x[rows], trajectories.y[rows]))
    heading = trajectories.heading[rows]
    tip = centre + 1.8 * radius[:, None] * np.column_stack((np.cos(heading), np.sin(heading)))
    axes.add_collection(
        LineCollection(list(np.stack((centre, tip), axis=1)), colors="black", linewidths=0.8)
    )
    axes.add_collection(
        EllipseCollection(
            2 * radius,
            2 * radius,
            np.zeros(len(radius)),
            units="xy",
            offsets=centre,
            offset_transform=axes.transData,
            facecolors=colours[trajectories.person[rows]].tolist(),
            edgecolors="white",
            linewidths=0.3,
            zorder=4,
        )
    )


def finish(
    figure: Figure, handles: list[Line2D | Patch], title: str, path: str | os.PathLike[str]
) -> None:
    """Write a figure with its legend and its title.

    Raises:
        ResultsError: the file cannot be written.
    """
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=9
    )
    if title:
        figure.suptitle(title, fontsize=12)
    _save(figure, path)


def _save(figure: Figure, path: str | os.PathLike[str]) -> None:
    with replacing(path, ResultsError) as temporary:
        figure.savefig(temporary)
