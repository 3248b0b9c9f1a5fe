"""Share of time that people spend in the fallback, when no option is possible."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.validation import bottleneck
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.checks import Check, at_most, exactly
from mesa_mobility.verification.scenarios.shipped import shipped

IN_JAMS, ELSEWHERE = 0.05, 0.02
MODELS = {"open_space": ELSEWHERE, "auditorium": ELSEWHERE, "doorway": IN_JAMS}
EFFORT = {"open_space": 1.0, "auditorium": 15.0, "doorway": 1.0}


def judge(runs: Runs) -> Verdict:
    """The share of pedestrian-time in each scenario, medians over the seeds."""
    names = [*MODELS, *(f"bottleneck {width:g} m" for width in bottleneck.JUDGED)]
    bounds = [*MODELS.values(), *(IN_JAMS for _ in bottleneck.JUDGED)]
    columns = list(zip(*runs, strict=True))
    shares = [float(np.median([each["fallback_time_share"] for each in of])) for of in columns]
    checks: list[Check] = [
        at_most(f"share in {name}", share, bound)
        for name, share, bound in zip(names, shares, bounds, strict=True)
    ]
    checks.append(
        exactly("left inside", sum(each["left_inside"] for row in runs for each in row), 0)
    )
    return Verdict(tuple(checks), {"scenario": names, "share": shares, "bound": bounds})


def draw(figures: dict[str, Any]) -> Figure:
    """Share of time by scenario, and the bound."""
    figure, (axes,) = charts.panels(1)
    place = np.arange(len(figures["scenario"]))
    axes.bar(place, 100 * np.array(figures["share"]), color=charts.OURS.colour, width=0.6)
    axes.plot(
        place,
        100 * np.array(figures["bound"]),
        color=charts.OTHER.colour,
        marker="_",
        markersize=16,
        linestyle="none",
        label="bound",
    )
    axes.set_xticks(place, figures["scenario"], rotation=45, ha="right", fontsize=7)
    axes.set_ylabel("fallback, % of pedestrian-time")
    charts.finish([axes])
    return figure


EXPERIMENT = Experiment(
    name="fallback",
    what="share of pedestrian-time in the fallback",
    source="Casburn, Srinivasan, Metoyer and Quinn 2005, Pedestrian and Evacuation Dynamics: 2 "
    "% in all",
    criterion="People spend little of their time in the fallback movement, which the model uses if "
    "no recorded movement is possible",
    cases=(
        *(case(shipped, effort=EFFORT[model], model=model) for model in MODELS),
        *(case(bottleneck.bottleneck, effort=4.0, width=width) for width in bottleneck.JUDGED),
    ),
    judge=judge,
    draw=draw,
)
