"""People walking both ways in a corridor 4 m wide: speed and lanes."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mesa_mobility.validation import drawing
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case
from mesa_mobility.verification.checks import Check, at_least, more_than
from mesa_mobility.verification.references import published
from mesa_mobility.verification.runs import Run
from mesa_mobility.verification.scenarios.oval import Oval, oval_model

FloatArray = NDArray[np.float64]

OVAL = Oval(straight=15.0, radius=4.0, width=4.0)
BOX_M, ROW_M = 8.0, 0.4
DENSITIES = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75)
SETTLE_S, MEASURE_S, WINDOW_S, EVERY_S = 60.0, 60.0, 1.5, 1.0
LEAST_ORDER = 0.76
"""Least order measured in lanes at 0.75 to 1.75 persons/m2; shuffled people gave 0.22 to 0.48."""
STANDSTILL = 0.1
"""Mean speed below which counterflow counts as stuck, m/s."""


def both_ways(seed: int, *, density: float) -> dict[str, Any]:
    """People walk round an oval, half of them the other way round.

    Args:
        seed: of the run.
        density: persons per square metre of the whole track.

    Returns:
        With what every run tells, over the middle 8 m of both straights: ``mean_speed`` in each
        one's own direction over 1.5 s (m/s), ``mean_density`` (1/m2), ``lane_order`` and the
        same with directions shuffled.
    """
    people = 2 * round(density * OVAL.length * OVAL.width / 2)
    model = oval_model(OVAL, people, seed, clockwise=people // 2, spacing=0.4, clearance=0.2)
    while model.elapsed < SETTLE_S + MEASURE_S + WINDOW_S:
        model.step()
    run = Run(model, model.floor_plan.walls)
    tracks = run.trajectories
    offsets, boxes = tracks.frame_offsets, OVAL.boxes(BOX_M)
    sign = np.where(np.arange(people) < people // 2, -1.0, 1.0)
    shuffle = np.random.default_rng(seed)
    speeds, counts, order, shuffled = [], [], [], []
    for time in np.arange(SETTLE_S, SETTLE_S + MEASURE_S, EVERY_S):
        first, last = (round((time + k) * tracks.frame_rate) for k in (0.0, WINDOW_S))
        now, then = (
            np.column_stack([tracks.x[a:b], tracks.y[a:b]])
            for a, b in ((offsets[f], offsets[f + 1]) for f in (first, last))
        )
        gone = OVAL.unroll(then)[0] - OVAL.unroll(now)[0]
        gone = np.mod(gone + OVAL.length / 2, OVAL.length) - OVAL.length / 2
        for box in boxes:
            inside = shapely.contains_xy(box, *now.T)
            counts.append(int(inside.sum()))
            speeds.append((gone * sign)[inside] / WINDOW_S)
            across = OVAL.unroll(now[inside])[1]
            order.append(lane_order(across, sign[inside]))
            shuffled.append(lane_order(across, shuffle.permutation(sign[inside])))
    return {
        **run.figures(),
        "mean_speed": float(np.concatenate(speeds).mean()),
        "mean_density": float(np.mean(counts)) / boxes[0].area,
        "lane_order": float(np.nanmean(order)),
        "lane_order_shuffled": float(np.nanmean(shuffled)),
    }


def lane_order(across: FloatArray, direction: FloatArray) -> float:
    """How well people of one direction keep to rows of their own (Rex and Loewen 2007).

    Mean over people of ((a - b) / (a + b))^2, where a and b people of either direction are in the
    same row, 0.4 m wide: 1 in perfect lanes.

    Args:
        across: (n,) metres from the middle of the corridor.
        direction: (n,) +1 or -1.
    """
    if not len(across):
        return float("nan")
    _, row = np.unique(np.floor(across / ROW_M), return_inverse=True)
    net = np.bincount(row, direction)
    total = np.bincount(row)
    return float(np.mean(((net / total) ** 2)[row]))


def judge(runs: Runs) -> Verdict:
    """Nobody is stuck, and people keep to lanes as measured."""
    columns = list(zip(*runs, strict=True))

    def over_seeds(name: str) -> list[float]:
        return [float(np.median([each[name] for each in of])) for of in columns]

    speeds, orders = over_seeds("mean_speed"), over_seeds("lane_order")
    checks: list[Check] = [
        more_than(
            "least mean speed of any run",
            min(each["mean_speed"] for row in runs for each in row),
            STANDSTILL,
        )
    ]
    for density, order in zip(DENSITIES, orders, strict=True):
        checks.append(
            at_least(f"lane order at {density:g}/m2", order, LEAST_ORDER, gates=density >= 0.75)
        )
    figures = {
        "density": list(DENSITIES),
        "measured density": over_seeds("mean_density"),
        "mean speed": speeds,
        "lane order": orders,
        "lane order shuffled": over_seeds("lane_order_shuffled"),
        "fallback share": over_seeds("fallback_time_share"),
    }
    return Verdict(tuple(checks), figures)


def draw(figures: dict[str, Any]) -> Figure:
    """Speed and lane order against density."""
    figure, axes = drawing.panels(2)
    reference = published("bo bidirectional")
    shown = reference["density"] <= 2.5
    axes[0].errorbar(
        reference["density"][shown],
        reference["v_mean"][shown],
        yerr=[
            (reference["v_mean"] - reference["v_min"])[shown],
            (reference["v_max"] - reference["v_mean"])[shown],
        ],
        **drawing.MEASURED.dots,
    )
    axes[0].plot(figures["measured density"], figures["mean speed"], **drawing.OURS.line)
    axes[0].set_ylabel("mean speed (m/s)")
    axes[1].axhspan(0.76, 0.94, color=drawing.MEASURED.colour, alpha=0.3, label="experiments")
    axes[1].axhspan(0.22, 0.48, color=drawing.OTHER.colour, alpha=0.15,
                    label="experiments, shuffled")  # fmt: skip
    axes[1].plot(figures["density"], figures["lane order"], **drawing.OURS.line)
    axes[1].plot(figures["density"], figures["lane order shuffled"],
                 **{**drawing.OTHER.line, "label": "mesa-mobility, shuffled"})  # fmt: skip
    axes[1].set_ylabel("lane order")
    axes[1].set_ylim(0, 1)
    for each in axes:
        each.set_xlabel("density (1/m²)")
    drawing.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="bidirectional",
    what="speed and lanes of people walking both ways in an endless corridor 4 m wide",
    source="bidirectional 3.6 m (fd_juelich_published.csv), lane order (data/README.md)",
    cases=tuple(case(both_ways, effort=2.0 + 4.0 * each, density=each) for each in DENSITIES),
    judge=judge,
    draw=draw,
)
