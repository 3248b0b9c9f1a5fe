"""Pictures of maps: level of service, time above a limit, usage and speed on the floor plan."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.engineering.maps import MAPS, FloorMaps
from mesa_mobility.results.engineering.service import LETTERS, service_limits
from mesa_mobility.results.floor import (
    LARGEST,
    Storey,
    draw_floor,
    floor_path,
    panels_of,
    storeys_of,
)
from mesa_mobility.results.plots import finish
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

_NOTHING = 0.0
"""Values up to this are not drawn: nobody was there, or never too many."""


@dataclass(frozen=True)
class _Style:
    label: str
    colours: str


_STYLES = {
    "density_max": _Style("level of service at the greatest density", "YlOrRd"),
    "density_mean": _Style("level of service at the mean density", "YlOrRd"),
    "dense_s": _Style("time above the limit of density (s)", "YlOrRd"),
    "people": _Style("people who passed", "YlGnBu"),
    "person_s": _Style("time that people spent (s, all together)", "YlGnBu"),
    "speed": _Style("mean speed (m/s)", "viridis"),
}


def plot_map(
    found: Mapping[int, FloorMaps],
    trajectories: Tracks,
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    what: str = "density_max",
    service: str = "walkway",
    label: str = "",
    title: str = "",
    largest: tuple[float, float] = LARGEST,
) -> None:
    """Draw one of the maps of a run on its floor plan; in a building a panel for each level.

    Densities have the colours of Fruin's levels of service. Cells in which nobody was, or in which
    the density was never above the limit, stay white.

    Args:
        found: maps of each level, from `maps`.
        trajectories: the run.
        plan: its floor plan, or its building.
        path: picture to write; its suffix chooses the format (.png, .svg, .pdf).
        what: an attribute of `FloorMaps`, such as "dense_s".
        service: kind of the levels of service, "walkway", "stairs" or "queue".
        label: of the scale of colours; by default what the map is of.
        title: first line of the picture.
        largest: width and height of the picture, inches.

    Raises:
        ResultsError: another name, maps of another plan, or the file cannot be written.
    """
    if what not in MAPS:
        raise ResultsError(f"map {what!r}, expected one of {', '.join(MAPS)}")
    storeys = storeys_of(trajectories, plan)
    if len(storeys) != len(found):
        raise ResultsError(
            f"maps of {len(found)} levels for a plan of {len(storeys)}, expected those of this plan"
        )
    figure, panels = panels_of(storeys, largest=largest)
    colours = _colours(found, what, service)
    handles: dict[str, Line2D | Patch] = {}
    for (axes, storey), own in zip(panels, found.values(), strict=True):
        for each in draw_floor(axes, storey.plan, storey.stairs, storey.refuges):
            handles.setdefault(str(each.get_label()), each)
        axes.set_title(storey.title, fontsize=10)
        _draw(axes, storey, own, what, colours)
    # Letters stand in the bar of levels of service.
    aspect = 15 if what.startswith("density") else 30
    bar = figure.colorbar(colours, ax=figure.axes, shrink=0.8, aspect=aspect, pad=0.02)
    bar.set_label(label or _STYLES[what].label)
    if what.startswith("density"):
        limits = colours.norm.boundaries  # type: ignore[attr-defined]
        bar.set_ticks(list(limits[1:-1]))
        bar.set_ticklabels([f"{limit:.2f} /m²" for limit in limits[1:-1]])
        middles = (limits[:-1] + limits[1:]) / 2
        for letter, middle in zip(LETTERS, middles, strict=True):
            ink = "white" if letter in LETTERS[4:] else "black"
            said = bar.ax.text(0.5, middle, letter, ha="center", va="center", color=ink)
            said.set_fontweight("bold")
    finish(figure, list(handles.values()), title, path)


def _colours(found: Mapping[int, FloorMaps], what: str, service: str) -> ScalarMappable:
    """The scale of colours that all panels share."""
    style = _STYLES[what]
    if what.startswith("density"):
        limits = service_limits(service)
        edges = [0.0, *limits, 2.0 * limits[-1]]
        norm: Normalize = BoundaryNorm(edges, len(LETTERS))
        six = ListedColormap(colormaps[style.colours](np.linspace(0.05, 0.95, len(LETTERS))))
        return ScalarMappable(norm, six)
    values = [getattr(each, what) for each in found.values()]
    known = np.concatenate([each[np.isfinite(each)] for each in values])
    return ScalarMappable(Normalize(0.0, max(known.max(initial=0.0), 1e-9)), style.colours)


def _draw(axes: Axes, storey: Storey, own: FloorMaps, what: str, colours: ScalarMappable) -> None:
    """Draw one map, cut off at the walls."""
    values = np.asarray(getattr(own, what), dtype=np.float64)
    # Values beyond the scale have the colour of its end.
    shown = np.clip(values, None, colours.norm.vmax)
    masked = np.ma.masked_where(~(values > _NOTHING), shown)
    mesh = axes.pcolormesh(own.grid.x, own.grid.y, masked, zorder=2, rasterized=True)
    mesh.set_cmap(colours.cmap)
    mesh.set_norm(colours.norm)
    mesh.set_clip_path(PathPatch(floor_path(storey.plan.free), transform=axes.transData))
