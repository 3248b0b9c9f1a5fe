"""Walkers in an endless corridor: individual density and speed in the middle of a straight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.distributions import Distribution
from mesa_mobility.results import individual_densities
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.runs import Run
from mesa_mobility.verification.scenarios.tracks.oval import Oval, oval_model

FloatArray = NDArray[np.float64]

STRAIGHT, RADIUS, BOX_M = 15.0, 3.0, 4.0
WINDOW_S, EVERY_S = 1.5, 1.0
DENSITY_BIN, DENSEST_BIN = 0.25, 5.25
"""Bins of individual density as the reference has them, and where they end, persons/m2."""
DENSEST = 0.34
"""Spacing of people at the start, metres: two cores and a little, room for 6 persons/m2."""


def track(
    seed: int,
    *,
    density: float,
    width: float,
    speed: float | Distribution | None = None,
    settle_s: float = 30.0,
    measure_s: float = 60.0,
    **rules: Any,
) -> dict[str, Any]:
    """People walk round an oval; those in the middle of a straight are measured once a second.

    Args:
        seed: of the run.
        density: persons per square metre of the whole track.
        width: of the track, metres.
        speed: preferred by everybody, m/s, or a distribution; by default the type's own.
        settle_s: seconds before anything is measured.
        measure_s: seconds that count.
        **rules: passed to ``PedestrianModel``, to override the default preset.

    Returns:
        The common figures; ``density`` (k,) individual Voronoi densities and ``along``
        (k,) speeds along the corridor over 1.5 s, m/s, of people in the boxes; ``mean_speed``
        and ``mean_density``, means over people, and over time in the boxes.
    """
    oval = Oval(STRAIGHT, RADIUS, width)
    people = round(density * oval.length * oval.width)
    model = oval_model(oval, people, seed, speed=speed, spacing=DENSEST, clearance=0.18, **rules)
    while model.elapsed < settle_s + measure_s + WINDOW_S:
        model.step()
    run = Run(model, model.floor_plan.walls)
    boxes = oval.boxes(BOX_M)
    densities, speeds, counts = [], [], []
    for time in np.arange(settle_s, settle_s + measure_s, EVERY_S) + WINDOW_S / 2:
        places, gone = _around(run, float(time), oval)
        inside = np.zeros(people, dtype=np.bool_)
        for box in boxes:
            inside |= shapely.contains_xy(box, places[:, 0], places[:, 1])
        counts.append(int(inside.sum()))
        densities.append(individual_densities(places, model.floor_plan.free, inside))
        speeds.append(gone[inside] / WINDOW_S)
    area = sum(box.area for box in boxes)
    along = np.concatenate(speeds)
    return {
        **run.figures(),
        "density": np.concatenate(densities),
        "along": along,
        "mean_speed": float(along.mean()) if len(along) else None,
        "mean_density": float(np.mean(counts)) / area,
    }


def _around(run: Run, time: float, oval: Oval) -> tuple[FloatArray, FloatArray]:
    """(n, 2) places at a time, and metres gone along the track in the 1.5 s around it."""
    tracks = run.trajectories
    offsets = tracks.frame_offsets
    half = WINDOW_S / 2
    frames = [round((time + shift) * tracks.frame_rate) for shift in (-half, 0.0, half)]
    before, now, after = (
        np.column_stack([tracks.x[a:b], tracks.y[a:b]])
        for a, b in ((offsets[frame], offsets[frame + 1]) for frame in frames)
    )
    gone = oval.unroll(after)[0] - oval.unroll(before)[0]
    return now, np.mod(gone + oval.length / 2, oval.length) - oval.length / 2


def binned(runs: Sequence[Figures], least: int = 20) -> dict[str, FloatArray]:
    """p10, p50, p90 of the speed in bins of individual density that hold `least` entries."""
    density = np.concatenate([each["density"] for each in runs])
    along = np.concatenate([each["along"] for each in runs])
    number = np.floor(density / DENSITY_BIN).astype(np.int64)
    rows = []
    for k in range(1, round(DENSEST_BIN / DENSITY_BIN)):
        here = along[number == k]
        if len(here) >= least:
            rows.append(((k + 0.5) * DENSITY_BIN, len(here), *np.percentile(here, (10, 50, 90))))
    table = np.array(rows).reshape(-1, 5)
    return dict(zip(("density", "n", "p10", "p50", "p90"), table.T, strict=True))
