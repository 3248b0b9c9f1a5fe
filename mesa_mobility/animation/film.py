"""Films of a run, seen from above or in three dimensions."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Literal

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

DPI = 80


PLAN, BODIES = "plan", "bodies"


class Film(OutputFormat):
    """Film from above, people coloured by speed, or of walking people; `.mp4` needs ffmpeg."""

    name = "film"
    suffixes = (".mp4", ".gif", ".webp")
    storeys = True

    def write(
        self,
        excerpt: Excerpt,
        path: Path,
        *,
        speed: float = 1.0,
        view: Literal["plan", "bodies"] = "plan",
        camera: str | None = None,
        colour: Literal["clothes", "speed", "type"] = "clothes",
        width: int = 960,
        height: int = 540,
    ) -> None:
        """See ``write_film`` and ``write_film_of_bodies``.

        Args:
            excerpt: what to draw.
            path: the film.
            speed: how many times as fast as it was.
            view: "plan" from above, "bodies" in three dimensions.
            camera: with "bodies": a camera path that the replay page has saved.
            colour: with "bodies": what the colours of people stand for.
            width: with "bodies": pixels.
            height: with "bodies": pixels.
        """
        if view == PLAN:
            write_film(
                excerpt.trajectories,
                excerpt.plan,
                path,
                excerpt.selection,
                speed=speed,
                progress=excerpt.progress,
            )
        else:
            size = (width, height)
            write_film_of_bodies(
                excerpt, path, speed=speed, camera=camera, colour=colour, size=size
            )


def write_film_of_bodies(
    excerpt: Excerpt,
    path: str | os.PathLike[str],
    *,
    speed: float = 1.0,
    camera: str | os.PathLike[str] | None = None,
    colour: str = "clothes",
    size: tuple[int, int] = (960, 540),
) -> None:
    """Draw people as walking figures, by Chromium or Chrome on this machine.

    Args:
        excerpt: the run, and whom and when to show.
        path: the film; its suffix is one of ``Film.suffixes``. MP4 needs ffmpeg.
        speed: how many times as fast as it was.
        camera: a camera path that the replay page has saved; by default the whole floor from aside.
        colour: what the colours of people stand for: "clothes", "speed" or "type".
        size: width and height, pixels, even numbers.

    Raises:
        ResultsError: another suffix, no ffmpeg, no browser, a damaged camera path, a size out of
            bounds, nobody to show, or the file cannot be written.
    """
    from mesa_mobility.animation.film_bodies import LARGEST, camera_path, pictures
    from mesa_mobility.animation.page import page_text
    from mesa_mobility.animation.reels import write_reel

    suffix = _checked(path, speed)
    if not all(16 <= each <= LARGEST and each % 2 == 0 for each in size):
        raise ResultsError(
            f"film of {size[0]} x {size[1]} pixels, expected even numbers from 16 to {LARGEST}"
        )
    views = None if camera is None else camera_path(camera)
    frames = _frames(excerpt.trajectories, excerpt.selection, speed)
    page = page_text(
        excerpt.trajectories,
        excerpt.plan,
        excerpt.selection,
        title=excerpt.title,
        bank=excerpt.bank,
    )

    def told() -> Iterator[NDArray[np.uint8]]:
        drawn = pictures(page, frames, size, views, colour=colour)
        for done, picture in enumerate(drawn, start=1):
            excerpt.progress(done, len(frames))
            yield picture

    with replacing(path, ResultsError) as temporary:
        write_reel(told(), temporary, suffix, PICTURES_A_SECOND)


def _checked(path: str | os.PathLike[str], speed: float) -> str:
    """The suffix of a film."""
    suffix = Path(path).suffix.lower()
    if suffix not in Film.suffixes:
        raise ResultsError(f"{path}: films end with {', '.join(Film.suffixes)}")
    if suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise ResultsError(f"{path}: MP4 needs ffmpeg on the path; .gif and .webp do not")
    if not (np.isfinite(speed) and speed > 0):
        raise ResultsError(f"speed {speed:g}: expected a positive number")
    return suffix


def _frames(trajectories: Tracks, selection: Selection, speed: float) -> list[int]:
    first, last = selection.frames_of(trajectories)
    step = speed * trajectories.frame_rate / PICTURES_A_SECOND
    frames: list[int] = np.floor(np.arange(first, last + 1, step)).astype(np.int64).tolist()
    return frames


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
    from mesa_mobility.animation.reels import write_reel

    selection = selection or Selection()
    suffix = _checked(path, speed)
    shown = np.isin(trajectories.person, selection.people_of(trajectories))
    frames = _frames(trajectories, selection, speed)
    pictures = _pictures(trajectories, plan, shown, frames, progress)
    with replacing(path, ResultsError) as temporary:
        write_reel(pictures, temporary, suffix, PICTURES_A_SECOND)


def _pictures(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    shown: NDArray[np.bool_],
    frames: list[int],
    progress: Callable[[int, int], None] | None,
) -> Iterator[NDArray[np.uint8]]:
    """(high, wide, 4) colours of each picture; only people and titles are drawn anew."""
    # Matplotlib takes half a second to load.
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from mesa_mobility.results.floor import panels_of, storeys_of

    pace = _speeds(trajectories)
    figure, axes = panels_of(storeys_of(trajectories, plan))
    panels = [_Panel(each, storey) for each, storey in axes]
    figure.colorbar(panels[0].bodies, ax=figure.axes, label="speed (m/s)", shrink=0.8)
    figure.set_dpi(DPI)
    for panel in panels:
        panel.show(trajectories, np.zeros(0, dtype=np.int64), pace, 0.0)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    # The layout is worked out once: it would take longer than all else in each picture.
    figure.set_layout_engine("none")
    for panel in panels:
        panel.set_animated()
    canvas.draw()
    still_parts = canvas.copy_from_bbox(figure.bbox)
    for done, frame in enumerate(frames, start=1):
        own = slice(*trajectories.frame_offsets[frame : frame + 2].tolist())
        rows = np.arange(own.start, own.stop)[shown[own]]
        canvas.restore_region(still_parts)
        for panel in panels:
            panel.show(trajectories, rows, pace, frame / trajectories.frame_rate)
            panel.draw()
        yield np.asarray(canvas.buffer_rgba())
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
            [],
            [],
            [],
            units="xy",
            cmap="plasma_r",
            offset_transform=axes.transData,
            zorder=5,
            edgecolors="#333333",
            linewidths=0.5,
        )
        self.bodies.set_clim(0.0, FASTEST)
        self._strokes = LineCollection([], colors="black", linewidths=0.8, zorder=6)
        axes.add_collection(self.bodies)
        axes.add_collection(self._strokes)

    def set_animated(self) -> None:
        """Leave people and title out of the picture of the rest."""
        for each in (self._strokes, self.bodies, self._axes.title):
            each.set_animated(True)

    def draw(self) -> None:
        """Draw people and title over the picture of the rest."""
        for each in (self._strokes, self.bodies, self._axes.title):
            self._axes.draw_artist(each)

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
