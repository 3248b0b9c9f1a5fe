"""Flow through bottlenecks of several widths, and the crowd in front of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from matplotlib.figure import Figure
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.results import individual_densities
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.checks import Check, at_most, exactly, rising, within
from mesa_mobility.verification.references import BOTTLENECK_TOLERANCE, bottleneck_fit, columns
from mesa_mobility.verification.runs import (
    CLEARANCE,
    SPACING,
    Run,
    crowd_model,
    evacuate,
    steady_flow,
)

WIDTHS = (0.8, 0.9, 1.0, 1.2, 1.6, 2.0, 2.5)
JUDGED = (0.9, 1.0, 1.2, 1.6, 2.0)
"""Widths at which figures are reported, metres."""
PEOPLE = 180
ROOM_WIDTH, ROOM_DEPTH, NECK = 8.0, 10.0, 1.0
START = box(-4.0, -8.5, 4.0, -1.0)
FRONT = box(-1.0, -1.5, 1.0, -0.5)
"""Measuring area of the density in front, metres; the neck begins at y = 0."""
DENSITY_IN_FRONT = (3.5, 6.0)


def plan(width: float, room: tuple[float, float] = (ROOM_WIDTH, ROOM_DEPTH)) -> FloorPlan:
    """A holding area, a neck 1 m long, a free area behind.

    Args:
        width: of the neck, metres.
        room: width and depth of the holding area, metres.
    """
    half, side = width / 2, room[0] / 2
    floor = Polygon(
        [
            (-side, -room[1]), (side, -room[1]), (side, 0), (half, 0), (half, NECK),
            (side, NECK), (side, NECK + 5), (-side, NECK + 5), (-side, NECK), (-half, NECK),
            (-half, 0), (-side, 0),
        ]
    )  # fmt: skip
    end = NECK + 5
    return FloorPlan(
        floor,
        exits=[Exit("end", (-side, end), (side, end))],
        gates=[Gate("neck", (-half, NECK / 2), (half, NECK / 2))],
        name=f"bottleneck {width:g} m",
    )


def bottleneck_run(seed: int, *, width: float, people: int, **rules: Any) -> Run:
    """The run of ``bottleneck``, with the same arguments."""
    floor = plan(width)
    model = crowd_model(floor, seed, **rules)
    places = floor.random_points(
        people, model.rng, within=START, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    return evacuate(model, 600.0)


def bottleneck(seed: int, *, width: float, people: int = PEOPLE, **rules: Any) -> dict[str, Any]:
    """People leave a holding area, 3 persons/m2 at the start, through a neck.

    Args:
        seed: of the run.
        width: of the neck, metres.
        people: how many.
        **rules: passed to ``PedestrianModel``, to override the default preset.

    Returns:
        The common figures; ``flow_per_s`` between the 30th and the 150th passage of the
        middle of the neck, and ``density_in_front``, the median over that time of the mean
        individual Voronoi density in a box 2 m x 1 m, half a metre in front of it.
    """
    run = bottleneck_run(seed, width=width, people=people, **rules)
    gate = run.model.floor_plan.gates[0]
    times = run.crossing_times(gate.a, gate.b)
    first, last = round(people / 6) - 1, round(people * 5 / 6) - 1
    return {
        **run.figures(),
        "passed": len(times),
        "flow_per_s": steady_flow(times, people),
        "density_in_front": density_in_front(run, times[first], times[last])
        if len(times) > last
        else None,
    }


def density_in_front(run: Run, start: float, end: float) -> float | None:
    """Median, from one time to another (s), of the mean individual density in ``FRONT``, 1/m2."""
    tracks = run.trajectories
    offsets, means = tracks.frame_offsets, []
    for time in np.arange(start, end, 0.5):
        frame = round(time * tracks.frame_rate)
        rows = slice(offsets[frame], offsets[frame + 1])
        points = np.column_stack([tracks.x[rows], tracks.y[rows]])
        points = points[shapely.intersects_xy(run.model.floor_plan.free, *points.T)]
        inside = shapely.contains_xy(FRONT, *points.T)
        if inside.any():
            means.append(individual_densities(points, run.model.floor_plan.free, inside).mean())
    return float(np.median(means)) if means else None


def judge(runs: Runs) -> Verdict:
    """Flow near the fit of the experiments and rising with width, density in front as measured."""
    columns_ = list(zip(*runs, strict=True))
    flows = [_median([each["flow_per_s"] for each in of]) for of in columns_]
    densities = [_median([each["density_in_front"] for each in of]) for of in columns_]
    checks: list[Check] = []
    for width, rate, density in zip(WIDTHS, flows, densities, strict=True):
        fit = bottleneck_fit(width)
        gates = width in JUDGED
        checks.append(
            within(
                f"flow at {width:g} m",
                rate,
                fit - BOTTLENECK_TOLERANCE,
                fit + BOTTLENECK_TOLERANCE,
                gates=gates,
            )
        )
        checks.append(
            within(f"density in front at {width:g} m", density, *DENSITY_IN_FRONT, gates=gates)
        )
    checks.append(rising("least rise of flow with width", flows))
    left = sum(each["left_inside"] for row in runs for each in row)
    checks.append(exactly("left inside", left, 0))
    shares = [_median([each["fallback_time_share"] for each in of]) for of in columns_]
    checks.append(at_most("greatest fallback share", max(shares), 0.05))  # type: ignore[type-var]
    figures = {
        "width": list(WIDTHS),
        "flow": flows,
        "flow range": [
            [min(values), max(values)] if (values := [f for f in found if f is not None]) else None
            for found in ([each["flow_per_s"] for each in of] for of in columns_)
        ],
        "fit": [bottleneck_fit(width) for width in WIDTHS],
        "density in front": densities,
        "fallback share": shares,
    }
    return Verdict(tuple(checks), figures)


def _median(values: list[float | None]) -> float | None:
    """Median over the seeds; None if one of them has no value."""
    return None if None in values else float(np.median(values))  # type: ignore[arg-type]


def draw(figures: dict[str, Any]) -> Figure:
    """Flow and density in front against width."""
    figure, axes = charts.panels(2)
    widths = np.array(figures["width"])
    studies = columns("bottleneck_flow_envelope")
    shown = studies["width_m"] <= 2.8
    axes[0].errorbar(
        studies["width_m"][shown],
        studies["flow_mean"][shown],
        yerr=[
            (studies["flow_mean"] - studies["flow_min"])[shown],
            (studies["flow_max"] - studies["flow_mean"])[shown],
        ],
        **charts.MEASURED.dots,
    )
    fit = np.array(figures["fit"])
    axes[0].fill_between(
        widths,
        fit - BOTTLENECK_TOLERANCE,
        fit + BOTTLENECK_TOLERANCE,
        color=charts.MEASURED.colour,
        alpha=0.2,
        linewidth=0,
        label="fit of the experiments ± 0.7 persons/s",
    )
    axes[0].plot(widths, charts.numbers(figures["flow"]), **charts.OURS.line)
    axes[0].set_ylabel("flow (persons/s)")
    axes[1].axhspan(
        *DENSITY_IN_FRONT,
        color=charts.MEASURED.colour,
        alpha=0.2,
        linewidth=0,
        label="experiments",
    )
    axes[1].plot(widths, charts.numbers(figures["density in front"]), **charts.OURS.line)
    axes[1].set_ylabel("density in front (persons/m²)")
    for each in axes:
        each.set_xlabel("width of the neck (m)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="bottleneck",
    what="flow through necks 0.8 to 2.5 m wide, 180 people, and density in front",
    source="eight studies of bottlenecks, as the validation of JuPedSim collects them",
    criterion="The flow lies near the fit of the studies (2.233 persons/s for each metre, less "
    "0.155) and rises with the width; the density in front of the neck is as measured",
    cases=tuple(case(bottleneck, effort=4.0, width=width) for width in WIDTHS),
    judge=judge,
    draw=draw,
)
