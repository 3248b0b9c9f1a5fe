"""Wide necks: flow and the density in front of them."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure
from shapely import box

from mesa_mobility.validation.bottleneck import density_in_front, plan
from mesa_mobility.validation.conditions import NEAR, median
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, within
from mesa_mobility.verification.references import table
from mesa_mobility.verification.runs import (
    CLEARANCE,
    SPACING,
    Run,
    crowd_model,
    steady_flow,
)

PEOPLE = 350
ROOM = (10.0, 14.0)
"""Width and depth of the holding area, metres."""
START = box(-5.0, -12.7, 5.0, -1.0)
DENSITY_AT_START = PEOPLE / START.area
"""2.99 persons/m2; the experiments began with 3."""
LIMIT_S = 240.0
FLOW_ALLOWED = 0.88, 1.12
ALLOWED = 0.7, 1.4
MEASURED = {float(row["width_m"]): row for row in table("wide_necks")}


def wide_neck(seed: int, *, width: float) -> Figures:
    """350 people leave a holding area 10 m wide, 3 persons/m2 at the start, through a neck 1 m
    long.

    Args:
        seed: of the run.
        width: of the neck, metres.

    Returns:
        The common figures; ``flow`` (1/s) between the passage of a sixth and of five sixths of
        the people; ``density`` (1/m2) in that time in a box 2 m x 1 m, half a metre in front;
        ``start_density`` (1/m2), of the people who were put in.
    """
    floor = plan(width, ROOM)
    model = crowd_model(floor, seed)
    places = floor.random_points(
        PEOPLE, model.rng, within=START, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    gate = floor.gates[0]
    walls = floor.walls
    # What the last of them do is not measured.
    while model.inside > PEOPLE / 12 and model.elapsed < LIMIT_S and not model.stalled:
        model.step()
    run = Run(model, walls)
    times = run.crossing_times(gate.a, gate.b)
    first, last = round(PEOPLE / 6), round(PEOPLE * 5 / 6)
    through = len(times) > last
    return {
        **run.figures(),
        "start_density": len(places) / START.area,
        "flow": steady_flow(times, PEOPLE),
        "density": density_in_front(run, times[first], times[last]) if through else None,
    }


def judge(runs: Runs) -> Verdict:
    """A crowd as dense as measured before each neck; flows within 12 %."""
    checks: list[Check] = []
    by_name: dict[str, list[float | None]] = {
        name: [median([each[name] for each in of]) for of in zip(*runs, strict=True)]
        for name in ("start_density", "density", "flow")
    }
    for k, (width, row) in enumerate(MEASURED.items()):
        name = f"condition of a neck of {width:g} m: density at the start 1/m2"
        low, high = (each * DENSITY_AT_START for each in NEAR)
        checks.append(within(name, by_name["start_density"][k], low, high))
        for figure, column, allowed in (
            ("flow", "flow_1_s", FLOW_ALLOWED),
            ("density", "density_in_front_1_m2", ALLOWED),
        ):
            low, high = (each * float(row[column]) for each in allowed)
            unit = "1/s" if figure == "flow" else "in front 1/m2"
            name = f"neck of {width:g} m: {figure} {unit}"
            checks.append(within(name, by_name[figure][k], low, high))
    return Verdict(tuple(checks), {"width": list(MEASURED), **by_name})


def draw(figures: dict[str, Any]) -> Figure:
    """Flow and density in front against width."""
    figure, axes = charts.panels(2)
    for each, name, column in (
        (axes[0], "flow", "flow_1_s"),
        (axes[1], "density", "density_in_front_1_m2"),
    ):
        theirs = [float(row[column]) for row in MEASURED.values()]
        each.plot(list(MEASURED), theirs, **charts.MEASURED.line)
        each.plot(figures["width"], charts.numbers(figures[name]), **charts.OURS.line)
        each.set_xlabel("width of the neck (m)")
    axes[0].set_ylabel("flow (persons/s)")
    axes[1].set_ylabel("density in front (persons/m\u00b2)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="wide_necks",
    what="flow through necks 2.4 to 5 m wide, 350 people, and density in front",
    source="bottlenecks 2.4 m to 5 m wide of HERMES 2009 (data archive of Forschungszentrum "
    "Jülich), values of the calibration of JuPedSim with Dakota",
    criterion="The crowd before each neck is as dense as measured, and the flow is within 12 % of "
    "the measured one",
    cases=tuple(case(wide_neck, effort=25.0, width=width) for width in MEASURED),
    judge=judge,
    draw=draw,
)
