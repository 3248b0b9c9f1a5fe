"""Draw somebody who walks, from the side and from behind: docs/images/bodies.png.

mesa-mobility run doorway --seed 1 --seconds 40 --record decisions --out out/doorway
python docs/bodies_picture.py out/doorway docs/images/bodies.png
"""

from __future__ import annotations

import sys

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.bodies.rotations import about_z
from mesa_mobility.bodies.skeleton import JOINTS, PARENTS
from mesa_mobility.results.run import read_run

PERSON, FIRST, EVERY, COUNT, APART = 3, 15, 3, 12, 1.05
COLOURS = {"left": "#b2182b", "right": "#2166ac"}


def draw(run: str, picture: str) -> None:
    """Draw the person of a run's folder."""
    trajectories = read_run(run).trajectories
    motion = trajectories.poses(PERSON, FIRST + EVERY * np.arange(COUNT))
    rows = trajectories.rows_of(PERSON)
    heading = trajectories.heading[rows[FIRST + EVERY * np.arange(COUNT)]]
    places = motion.positions - motion.positions[:, :1] * [1, 1, 0]
    places = np.einsum("nij,nkj->nki", about_z(-heading), places)
    figure = Figure(figsize=(11, 4.2), dpi=110, layout="constrained")
    for axes, along, label in zip(
        figure.subplots(2, 1), (0, 1), ("the side", "behind"), strict=True
    ):
        for k, body in enumerate(places):
            across = (body[:, 0] if along == 0 else -body[:, 1]) + APART * k
            for joint, parent in enumerate(PARENTS[1:].tolist(), start=1):
                side = JOINTS[joint].split("_")[0]
                axes.plot(
                    across[[parent, joint]],
                    body[[parent, joint], 2],
                    linewidth=2,
                    color=COLOURS.get(side, "#333333"),
                    solid_capstyle="round",
                )
        axes.axhline(0.0, color="#999999", linewidth=0.8)
        axes.set(aspect="equal", xticks=[], ylabel=f"from {label}\nz (m)", ylim=(-0.05, 1.85))
        axes.spines[["top", "right", "bottom"]].set_visible(False)
    axes.set_xlabel(f"one picture every {EVERY / 30:g} s; left limbs red, right ones blue")
    figure.savefig(picture)


if __name__ == "__main__":
    draw(*sys.argv[1:])
