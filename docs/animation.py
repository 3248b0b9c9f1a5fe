"""Draw a run as a moving picture of discs, from above.

    mesa-mobility run doorway --seed 1 --out out/doorway
    python docs/animation.py out/doorway out/doorway.webp

People are discs of their body core with a stroke for the facing, coloured by speed. The suffix of
the picture chooses its format: .webp, .gif or .png (animated).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.collections import EllipseCollection, LineCollection, PatchCollection
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from shapely import Polygon

from mesa_mobility import FloorPlan
from mesa_mobility.results import read_parquet

WIDTH = 7.0
"""Inches."""


def floor_patch(polygon: Polygon) -> PathPatch:
    """The polygon with its holes."""
    rings = [polygon.exterior, *polygon.interiors]
    return PathPatch(Outline.make_compound_path(*(Outline(np.array(r.coords)) for r in rings)))


def draw(run: Path, picture: Path, *, rate: int, speed_up: int, dpi: int) -> None:
    """Draw the run in a folder, `rate` pictures a second, `speed_up` times as fast as it was."""
    tracks = read_parquet(run / "trajectories.parquet")
    plan = FloorPlan.from_geojson(run / "floorplan.geojson")
    x0, y0, x1, y1 = plan.bounds
    figure = plt.figure(figsize=(WIDTH, WIDTH * (y1 - y0 + 0.4) / (x1 - x0 + 0.4)), dpi=dpi)
    ax = figure.add_axes((0, 0, 1, 1))
    ax.set(xlim=(x0 - 0.2, x1 + 0.2), ylim=(y0 - 0.2, y1 + 0.2), aspect="equal")
    ax.axis("off")
    floor = getattr(plan.free, "geoms", [plan.free])
    ax.add_collection(PatchCollection([floor_patch(p) for p in floor], fc="#f2f2ee", ec="none"))
    ax.add_collection(
        LineCollection(plan.walls.reshape(-1, 2, 2), colors="#333333", linewidths=1.5)
    )
    bodies = EllipseCollection(
        [], [], [], units="xy", cmap="plasma_r", offset_transform=ax.transData
    )
    bodies.set_clim(0.0, 1.6)
    strokes = LineCollection([], colors="black", linewidths=0.8)
    ax.add_collection(strokes)
    ax.add_collection(bodies)

    speed = np.zeros(len(tracks))
    start, end = tracks.steps(15)
    moved = np.hypot(tracks.x[end] - tracks.x[start], tracks.y[end] - tracks.y[start])
    speed[start] = moved * tracks.frame_rate / 15

    def show(frame: int) -> list[EllipseCollection | LineCollection]:
        rows = slice(*tracks.frame_offsets[frame : frame + 2])
        centre = np.column_stack([tracks.x[rows], tracks.y[rows]])
        heading, radius = tracks.heading[rows], tracks.radii[tracks.person[rows]]
        nose = 1.7 * radius[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        bodies.set(
            widths=2 * radius,
            heights=2 * radius,
            angles=0 * radius,
            offsets=centre,
            array=speed[rows],
        )
        strokes.set_segments(np.stack([centre, centre + nose], axis=1))
        return [strokes, bodies]

    frames = range(0, tracks.frames, round(tracks.frame_rate * speed_up / rate))
    FuncAnimation(figure, show, frames, blit=True).save(picture, PillowWriter(fps=rate))


def main() -> None:
    """Read the command line and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder that `mesa-mobility run --out` wrote")
    parser.add_argument("picture", type=Path)
    parser.add_argument("--rate", type=int, default=10, help="pictures a second")
    parser.add_argument("--speed-up", type=int, default=2, help="times as fast as in reality")
    parser.add_argument("--dpi", type=int, default=80)
    draw(**vars(parser.parse_args()))


if __name__ == "__main__":
    main()
