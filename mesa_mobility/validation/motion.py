"""Single people inside a crowd: how straight, how smoothly and how near to others they walk.

Beside recorded crowds of the same density. Flows and mean speeds are compared elsewhere; here it
is how each person moves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mesa_mobility.plugins.registry import load_model
from mesa_mobility.results.measures.motion import (
    facing_angles,
    lateral_correlation,
    walked_back,
)
from mesa_mobility.validation.bidirectional import REFERENCE as OPPOSED
from mesa_mobility.validation.bottleneck import bottleneck_run
from mesa_mobility.validation.conditions import conditions
from mesa_mobility.validation.encounters import (
    crossing,
    from_standing,
    head_on,
    past_group,
    past_standing,
)
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.validation.scenes.corridors import alone, before_exit, both_ways, one_way
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, at_most, within
from mesa_mobility.verification.references import published, table
from mesa_mobility.verification.runs import evacuate

FloatArray = NDArray[np.float64]

ALLOWED = 1.3
"""How many times as large as measured a figure may be."""
BOTH_SIDES = 0.7, 1.4
"""How many times as large as measured figures of single people in one-way crowds may be."""
JOINT_JUMP = 0.32
"""p99 of the jump of speed over 0.1 s of the recorded walkers, m/s."""
CROWDS = {
    "corridor": "unidirectional corridor 1.8 m (uo-100-180-180)",
    "before an exit of 1.2 m": "corridor 1.8 m with an exit of 1.2 m (uo-180-180-120)",
}
"""Crowds, and what the reference calls them."""
CONDITIONS = {
    "corridor": {"density": 1.1, "speed": 1.208, "flow": 2.39},
    "before an exit of 1.2 m": {"density": 2.06, "speed": 0.66, "flow": 2.45},
}
"""Density (1/m2) and speed (m/s) of these crowds as measured, and their product with the width."""
OPPOSED_DENSITY = 1.0
BOTH_WAYS = "bidirectional corridor 4 m (bi_corr_400_b_03 and _08)"
PERCENTILES = (50, 95, 99)


def before_door(seed: int, *, width: float) -> Figures:
    """People leave through a door; ``back`` (m,) metres that each has walked back from it."""
    run = bottleneck_run(seed, width=width, people=60)
    return {**run.figures(), "back": walked_back(run.trajectories, (0.0, 0.0))}


def faced(seed: int, *, model: str) -> Figures:
    """A shipped model; ``angles`` (k,) radians between facing and travel of walking people."""
    made = load_model(model)(record=True, rng=seed)
    run = evacuate(made, 120.0)
    return {**run.figures(), "angles": facing_angles(run.trajectories)}


def judge(runs: Runs) -> Verdict:
    """Each scene in its measured condition; each figure 0.7 to 1.4 times as measured in one-way
    crowds, otherwise at most 1.3 times, or within the measured range."""
    by_case = [list(of) for of in zip(*runs, strict=True)]
    free, *crowds, opposed, door_05, door_09, doorway, meet, cross, stand, group, start = by_case
    checks: list[Check] = []
    figures: dict[str, Any] = {}
    reference = {row["set"]: row for row in table("motion_in_crowds")}
    rows = [("alone", "free walk 3 m corridor", free)]
    rows += [(name, CROWDS[name], of) for name, of in zip(CROWDS, crowds, strict=True)]
    checks += conditions("alone", free, {"speed": 1.674})
    for name, of in zip(CROWDS, crowds, strict=True):
        checks += conditions(name, of, CONDITIONS[name])
    theirs = published(OPPOSED)
    speed = float(np.interp(OPPOSED_DENSITY, theirs["density"], theirs["v_mean"]))
    checks += conditions(
        "both ways", opposed, {"density": OPPOSED_DENSITY, "speed": speed}, density=(0.75, 1.25)
    )
    for name, measured, of in rows:
        own = {each: _joined(of, each) for each in ("turns", "across", "speed_changes")}
        spread = {
            "direction change deg": float(np.degrees(own["turns"].std())),
            "lateral step m": float(own["across"].std()),
            "speed change m/s": float(own["speed_changes"].std()),
        }
        columns = ("heading_change_sd_deg", "lateral_disp_sd_m", "speed_change_sd_m_s")
        for (figure, value), column in zip(spread.items(), columns, strict=True):
            least, most = BOTH_SIDES if of is not free else (BOTH_SIDES[0], ALLOWED)
            theirs_sd = float(reference[measured][column])
            bounds = least * theirs_sd, most * theirs_sd
            checks.append(within(f"{name}: sd of {figure}", value, *bounds))
        figures[f"{name}: turns"] = np.degrees(own["turns"]).tolist()
        if of is free:
            lag = lateral_correlation(_joined(of, "successive"))
            checks.append(within(f"{name}: correlation of lateral steps", lag, -0.5, -0.15))
            continue
        *checks_below, highest = _against(
            f"{name}: acceleration m/s2", _joined(of, "accelerations"), reference[measured], "accel"
        )
        p99 = float(reference[measured]["accel_p99"])
        low, high = (each * p99 for each in BOTH_SIDES)
        checks += [*checks_below, within(highest.figure, highest.value, low, high)]
        figures[f"{name}: accelerations"] = _percentiles(_joined(of, "accelerations"))
        figures[f"{name}: jumps"] = _percentiles(_joined(of, "jumps"))
        checks.append(
            at_most(
                f"{name}: jump of speed over 0.1 s, p99 m/s",
                figures[f"{name}: jumps"][-1],
                ALLOWED * JOINT_JUMP,
            )
        )
    checks += _against(
        "both ways: acceleration m/s2",
        _joined(opposed, "accelerations"),
        reference[BOTH_WAYS],
        "accel",
    )
    for name, of in (("0.5", door_05), ("0.9", door_09)):
        share = float(np.mean(_joined(of, "back") > 0.3))
        checks.append(at_most(f"door of {name} m: share who walk back 0.3 m", share, 0.06))
    angles = _joined(doorway, "angles")
    for figure, angle in (("sideways", np.pi / 4), ("backwards", np.pi / 2)):
        share = float(np.mean(angles > angle))
        checks.append(at_most(f"doorway: share of walking {figure}", share, 0.003))
    for name, of, low, high in (
        ("head-on", meet, 0.6, 1.1),
        ("crossing", cross, 0.7, 1.1),
        ("past somebody standing", stand, 0.5, 2.0),
    ):
        closest = float(np.median(_joined(of, "closest")))
        checks.append(within(f"{name}: closest approach m", closest, low, high))
    through = float(np.mean([each["through"] for each in group]))
    checks.append(at_most("standing group of five: share who walk through", through, 0.1))
    covered = float(np.median(_joined(start, "first_second")))
    checks.append(within("first second from standing m", covered, 0.4, 0.7))
    return Verdict(tuple(checks), figures)


def _against(name: str, values: FloatArray, reference: dict[str, str], column: str) -> list[Check]:
    return [
        at_most(f"{name}, p{p}", value, ALLOWED * float(reference[f"{column}_p{p}"]))
        for p, value in zip(PERCENTILES, _percentiles(values), strict=True)
    ]


def _percentiles(values: FloatArray) -> list[float]:
    return [float(each) for each in np.percentile(values, PERCENTILES)]


def _joined(runs: Sequence[Figures], name: str) -> FloatArray:
    return np.concatenate([each[name] for each in runs])


def draw(figures: dict[str, Any]) -> Figure:
    """Plot changes of direction, accelerations and jumps of speed beside measured ones."""
    figure, axes = charts.panels(3)
    reference = {row["set"]: row for row in table("motion_in_crowds")}
    edges = np.arange(-60.0, 61.0, 2.0)
    for (name, measured), colour in zip(
        CROWDS.items(), (charts.OURS.colour, charts.OTHER.colour), strict=True
    ):
        turns = np.array(figures[f"{name}: turns"])
        axes[0].hist(
            turns,
            bins=edges.tolist(),
            density=True,
            histtype="step",
            color=colour,
            label=f"{name}, sd {turns.std():.1f}",
        )
        sd = float(reference[measured]["heading_change_sd_deg"])
        axes[0].plot(
            edges,
            np.exp(-((edges / sd) ** 2) / 2) / (sd * np.sqrt(2 * np.pi)),
            color=colour,
            linestyle=":",
            label=f"experiment, sd {sd:.1f}",
        )
        for panel, column, key in (
            (axes[1], "accel", "accelerations"),
            (axes[2], "speed_jump_0p1s", "jumps"),
        ):
            theirs = [float(reference[measured][f"{column}_p{p}"]) for p in PERCENTILES]
            panel.plot(PERCENTILES, figures[f"{name}: {key}"], "o-", color=colour, label=name)
            panel.plot(PERCENTILES, theirs, "s:", color=colour, label=f"{name}, experiment")
    axes[0].set_xlabel("change of direction between steps of 1.5 s (deg)")
    axes[1].set_ylabel("acceleration (m/s²)")
    axes[2].set_ylabel("jump of speed over 0.1 s (m/s)")
    for panel in axes[1:]:
        panel.set_xlabel("percentile")
    charts.finish(axes)
    return figure


def _encounter(scenario: Callable[[int], Figures]) -> Any:
    return case(scenario, effort=3.0)


EXPERIMENT = Experiment(
    name="motion",
    what="single people inside a crowd: directions, steps, accelerations, distances",
    source="head tracks of HERMES 2009 and BaSiGo 2013 (data archive of Forschungszentrum "
    "Jülich) and of Adrian, Seyfried and Sieben 2020, J. R. Soc. Interface 17: 20190871",
    criterion="Each scene has the density, speed and flow of the measured one. Changes of "
    "direction, speed and lateral steps are 0.7 to 1.4 times as measured in crowds that "
    "walk one way; other figures are at most 1.3 times as measured, or within the "
    "measured range",
    cases=(
        case(alone, effort=2.0),
        case(one_way, effort=3.0, density=1.1, rate=2.39, exit_width=1.8),
        before_exit(1.2),
        case(both_ways, effort=4.0, density=OPPOSED_DENSITY),
        case(before_door, effort=2.0, width=0.5),
        case(before_door, effort=2.0, width=0.9),
        case(faced, effort=2.0, model="doorway"),
        *map(_encounter, (head_on, crossing, past_standing, past_group, from_standing)),
    ),
    judge=judge,
    draw=draw,
)
