"""Films and stills of a run, seen from above."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.excerpts import Selection
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan
    from mesa_mobility.results.excerpts import Excerpt
    from mesa_mobility.results.floor import Storey

PICTURES_A_SECOND = 15
FASTEST = 1.6
"""Speed in m/s at the end of the scale of colours."""

SPEED_OVER = 15
"""Frames over which a person's speed is taken."""

DPI = 100


class Film(OutputFormat):
    """Film from above, people coloured by speed; `.mp4` needs ffmpeg."""

    name = "film"
    suffixes = (".mp4", ".gif", ".webp")
    storeys = True

    def write(self, excerpt: Excerpt, path: Path, *, speed: float = 1.0) -> None:
        """See ``write_film``."""
        write_film(
            excerpt.trajectories,
            excerpt.plan,
            path,
            excerpt.selection,
            speed=speed,
            progress=excerpt.progress,
        )


def write_film(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    selection: Selection | None = None,
    *,
    speed: float = 1.0,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """Draw people as discs of their cores, coloured by speed, with a stroke for the facing.

    In a building each level has a panel, the topmost first. It shows the people on the stairs up
    from there, too.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        path: the film; its suffix is one of ``Film.suffixes``. MP4 needs ffmpeg.
        selection: whom and when; all of it by default.
        speed: how many times as fast as it was.
        progress: called as ``progress(pictures done, pictures)``.

    Raises:
        ResultsError: another suffix, no ffmpeg, nobody to show, or the file cannot be written.
    """
    # Matplotlib takes half a second to load.
    from matplotlib.animation import FFMpegWriter, PillowWriter

    from mesa_mobility.results.floor import panels_of, storeys_of

    selection = selection or Selection()
    suffix = Path(path).suffix.lower()
    if suffix not in Film.suffixes:
        raise ResultsError(f"{path}: films end with {', '.join(Film.suffixes)}")
    if suffix == ".mp4" and not FFMpegWriter.isAvailable():
        raise ResultsError(f"{path}: MP4 needs ffmpeg on the path; .gif and .webp do not")
    if not (np.isfinite(speed) and speed > 0):
        raise ResultsError(f"speed {speed:g}: expected a positive number")
    first, last = selection.frames_of(trajectories)
    shown = np.isin(trajectories.person, selection.people_of(trajectories))
    step = speed * trajectories.frame_rate / PICTURES_A_SECOND
    frames = np.floor(np.arange(first, last + 1, step)).astype(np.int64)
    pace = _speeds(trajectories)
    figure, axes = panels_of(storeys_of(trajectories, plan))
    panels = [_Panel(each, storey) for each, storey in axes]
    figure.colorbar(panels[0].bodies, ax=figure.axes, label="speed (m/s)", shrink=0.8)
    kind: Any = FFMpegWriter if suffix == ".mp4" else PillowWriter
    writer = kind(fps=PICTURES_A_SECOND)
    with replacing(path, ResultsError) as temporary:
        # The layout is worked out once: it would take longer than all else in each picture.
        figure.canvas.draw()
        figure.set_layout_engine("none")
        with writer.saving(figure, str(temporary), DPI):
            for done, frame in enumerate(frames.tolist(), start=1):
                own = slice(*trajectories.frame_offsets[frame : frame + 2].tolist())
                rows = np.arange(own.start, own.stop)[shown[own]]
                for panel in panels:
                    panel.show(trajectories, rows, pace, frame / trajectories.frame_rate)
                writer.grab_frame()
                if progress is not None:
                    progress(done, len(frames))


class _Panel:
    """The picture of a storey and of the people on it."""

    def __init__(self, axes: Axes, storey: Storey) -> None:
        # Matplotlib takes half a second to load.
        from matplotlib.collections import EllipseCollection, LineCollection

        from mesa_mobility.results.floor import draw_floor

        draw_floor(axes, storey.plan, storey.stairs, storey.refuges)
        self._axes, self._storey = axes, storey
        self.bodies = EllipseCollection(
            [], [], [], units="xy", cmap="viridis", offset_transform=axes.transData, zorder=5
        )
        self.bodies.set_clim(0.0, FASTEST)
        self._strokes = LineCollection([], colors="black", linewidths=0.8, zorder=6)
        axes.add_collection(self.bodies)
        axes.add_collection(self._strokes)

    def show(
        self,
        trajectories: Tracks,
        rows: NDArray[np.int64],
        pace: NDArray[np.float64],
        time: float,
    ) -> None:
        """Draw the bodies of those rows that are on the storey."""
        own = rows[self._storey.rows[rows]]
        radius = trajectories.radii[trajectories.person[own]]
        centre = np.column_stack((trajectories.x[own], trajectories.y[own]))
        heading = trajectories.heading[own]
        tip = centre + 1.8 * radius[:, None] * np.column_stack((np.cos(heading), np.sin(heading)))
        self.bodies.set_offsets(centre)
        self.bodies.set_widths(2.0 * radius)
        self.bodies.set_heights(2.0 * radius)
        self.bodies.set_angles(np.zeros(len(radius)))
        self.bodies.set_array(pace[own])
        self._strokes.set_segments(list(np.stack((centre, tip), axis=1)))
        where = f"{self._storey.title}, " if self._storey.title else ""
        self._axes.set_title(f"{where}{time:.1f} s, {len(own)} people")


def _speeds(trajectories: Tracks) -> NDArray[np.float64]:
    """(n,) speed of each row: its way over the frames before, m/s."""
    ordered = trajectories.by_person
    before = np.maximum(np.arange(len(ordered)) - SPEED_OVER, 0)
    same = trajectories.person[ordered] == trajectories.person[ordered[before]]
    way = np.hypot(
        trajectories.x[ordered] - trajectories.x[ordered[before]],
        trajectories.y[ordered] - trajectories.y[ordered[before]],
    )
    frames = np.maximum(trajectories.frame[ordered] - trajectories.frame[ordered[before]], 1)
    found = np.zeros(len(ordered))
    found[ordered] = np.where(same, way / frames * trajectories.frame_rate, 0.0)
    return found
