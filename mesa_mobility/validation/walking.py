"""People who walk alone: speed, straightness and sway."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.results import direction_changes, lateral_sway
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.checks import at_most, exactly, within
from mesa_mobility.verification.references import table
from mesa_mobility.verification.runs import evacuate
from mesa_mobility.verification.scenarios.walks import (
    LENGTH,
    lanes_model,
    put_in_lanes,
    speeds_walked,
)

PEOPLE = 50
MOST_TURN_DEG = 6.0
"""Standard deviation of the change of direction between steps of 1.5 s; measured: 4 to 5."""


def free_walk(seed: int, *, people: int = PEOPLE) -> dict[str, Any]:
    """People with the default speeds walk 40 m in lanes 3 m apart.

    Returns:
        The common figures; ``walked`` and ``assigned`` speeds (m/s); ``turns`` (k,) changes
        of direction between steps of 1.5 s (degrees), ``stride_hz`` and ``sway_m`` by walker.
    """
    model = lanes_model(people, seed)
    speeds = model.pedestrian_types[0].draw_speeds(people, model.rng)
    put_in_lanes(model, speeds)
    run = evacuate(model, 3.0 * LENGTH / float(speeds.min()))
    sways = []
    for person in range(people):
        _, places = run.track(person)
        middle = places[(places[:, 0] > 5.0) & (places[:, 0] < 35.0)]
        sways.append(lateral_sway(middle[:, 0], middle[:, 1], model.frame_rate))
    return {
        **run.figures(),
        "assigned": speeds,
        "walked": np.array(speeds_walked(run, people), dtype=np.float64),
        "turns": np.degrees(direction_changes(run.trajectories)),
        "stride_hz": np.array([sway.stride_frequency for sway in sways]),
        "sway_m": np.array([sway.peak_to_peak / 2 for sway in sways]),
    }


def judge(runs: Runs) -> Verdict:
    """Judge whether people alone walk straight on, at the speeds that they were given."""
    (walks,) = zip(*runs, strict=True)
    walked, assigned, turns, stride, sway = (
        np.concatenate([each[name] for each in walks])
        for name in ("walked", "assigned", "turns", "stride_hz", "sway_m")
    )
    error = float(np.nanmean(walked - assigned))
    checks = (
        exactly("walkers who did not arrive", int(np.isnan(walked).sum()), 0),
        within("mean error of the speed m/s", error, -0.05, 0.05),
        at_most("sd of the change of direction per 1.5 s deg", float(turns.std()), MOST_TURN_DEG),
    )
    figures = {
        "mean speed m/s": float(np.nanmean(walked)),
        "sd of speed m/s": float(np.nanstd(walked, ddof=1)),
        "greatest error of a speed m/s": float(np.nanmax(np.abs(walked - assigned))),
        "median stride Hz": float(np.median(stride)),
        "median sway amplitude m": float(np.median(sway)),
        "walked": walked.tolist(),
        "assigned": assigned.tolist(),
        "turns": turns.tolist(),
    }
    return Verdict(checks, figures)


_MEASURED = ("HERMES, people alone", "ETH, before a building", "ETH, before a hotel")
"""Whose mean free speeds the picture shows."""


def draw(figures: dict[str, Any]) -> Figure:
    """Walked against assigned speeds, and changes of direction."""
    figure, axes = charts.panels(2)
    speeds = np.array(figures["assigned"])
    axes[0].plot(speeds, figures["walked"], **charts.OURS.dots)
    ends = [speeds.min(), speeds.max()]
    axes[0].plot(ends, ends, color="black", linewidth=0.8)
    for row, said in zip(table("free_speed"), _MEASURED, strict=True):
        axes[0].axhline(float(row["mean"]), color=charts.MEASURED.colour, linewidth=0.8)
        axes[0].annotate(
            said,
            (ends[0], float(row["mean"])),
            fontsize=8,
            va="bottom",
        )
    axes[0].set_xlabel("preferred speed (m/s)")
    axes[0].set_ylabel("speed walked over 20 m (m/s)")
    turns = np.array(figures["turns"])
    axes[1].hist(turns, bins=list(range(-30, 31, 2)), color=charts.OURS.colour, density=True)
    axes[1].set_xlabel(f"change of direction per 1.5 s (deg), sd {turns.std():.1f}")
    axes[1].set_ylabel("density")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="walking",
    what="lone walkers: speed, change of direction, side-to-side motion",
    source="head tracks of 50 people who walked alone in a corridor 3 m wide (HERMES 2009, data "
    "archive of Forschungszentrum Jülich)",
    criterion="People who walk alone go straight on, at the speeds that they were given; how they "
    "sway from side to side is reported",
    cases=(case(free_walk, effort=2.0),),
    judge=judge,
    draw=draw,
)
