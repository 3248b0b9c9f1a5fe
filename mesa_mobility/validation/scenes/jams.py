"""Jams in a corridor 1.8 m wide before exits of several widths."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.validation.conditions import median
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.validation.scenes.corridors import before_exit
from mesa_mobility.verification import Verdict, charts
from mesa_mobility.verification.checks import Check, at_least, within
from mesa_mobility.verification.references import columns, corridor_band

WIDTHS = (0.7, 0.8, 0.9, 1.0, 1.2)
"""Of the exits, metres."""
JAMMED = 1.75
"""Density from which on flow falls with density, persons/m2 (Weidmann 1993)."""


def judge(runs: Runs) -> Verdict:
    """A jam before each exit, with a flow between the least and the greatest of all studies, and
    the speed of measured corridors of that density."""
    checks: list[Check] = []
    figures: dict[str, Any] = {"width": list(WIDTHS)}
    studies = columns("bottleneck_flow_envelope")
    by_name: dict[str, list[float | None]] = {
        name: [median([each[name] for each in of]) for of in zip(*runs, strict=True)]
        for name in ("density", "speed", "flow")
    }
    for k, width in enumerate(WIDTHS):
        density, speed, flow = (by_name[name][k] for name in ("density", "speed", "flow"))
        name = f"condition of an exit of {width:g} m: density of a jam 1/m2"
        checks.append(at_least(name, density, JAMMED))
        row = int(np.argmin(np.abs(studies["width_m"] - width)))
        low, high = studies["flow_min"][row], studies["flow_max"][row]
        checks.append(within(f"exit of {width:g} m: flow 1/s", flow, low, high))
        slowest, _, fastest = corridor_band(np.nan if density is None else density)
        checks.append(
            within(f"exit of {width:g} m: speed m/s", speed, float(slowest), float(fastest))
        )
    return Verdict(tuple(checks), {**figures, **by_name})


def draw(figures: dict[str, Any]) -> Figure:
    """Flow against width, and speed against density."""
    figure, axes = charts.panels(2)
    studies = columns("bottleneck_flow_envelope")
    shown = (studies["width_m"] >= WIDTHS[0] - 0.01) & (studies["width_m"] <= WIDTHS[-1] + 0.01)
    low, mean, high = (studies[f"flow_{name}"][shown] for name in ("min", "mean", "max"))
    errors = [mean - low, high - mean]
    axes[0].errorbar(studies["width_m"][shown], mean, yerr=errors, **charts.MEASURED.dots)
    axes[0].plot(figures["width"], charts.numbers(figures["flow"]), **charts.OURS.line)
    axes[0].set(xlabel="width of the exit (m)", ylabel="flow (1/s)")
    density = np.linspace(0.5, 5.0, 46)
    charts.band(
        axes[1],
        density,
        *corridor_band(density),
        charts.Look(charts.MEASURED.colour, "experiments, corridors", ""),
    )
    axes[1].plot(
        charts.numbers(figures["density"]), charts.numbers(figures["speed"]), **charts.OURS.dots
    )
    axes[1].axvline(JAMMED, color=charts.OTHER.colour, linewidth=0.8, label="a jam from here on")
    axes[1].set(xlabel="density before the exit (1/m\u00b2)", ylabel="speed (m/s)")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="jams",
    what="jams in a corridor 1.8 m wide before exits of 0.7 to 1.2 m",
    source="eight studies of bottlenecks, as the validation of JuPedSim collects them; "
    "corridors of HERMES 2009 and BaSiGo 2013 (data archive of Forschungszentrum Jülich)",
    criterion="A jam stands before each exit; the flow lies between the least and the greatest of "
    "all studies, and the speed is that of measured corridors of this density",
    cases=tuple(before_exit(width) for width in WIDTHS),
    judge=judge,
    draw=draw,
)
