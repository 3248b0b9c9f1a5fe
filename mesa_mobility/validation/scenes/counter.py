"""A counter: people who are to be served stand one behind the other, and not in a cloud."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.behaviors import Counter, Queueing
from mesa_mobility.results.tracks import Tracks
from mesa_mobility.validation.conditions import median
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import at_least, at_most, exactly
from mesa_mobility.verification.runs import CLEARANCE, crowd_model, evacuate

FloatArray = NDArray[np.float64]

SIZE = (10.0, 8.0)
COUNTER = (8.0, 4.0)
"""Where people are served, metres; the line goes back along -x."""
PEOPLE, SERVICE_S, LIMIT_S = 8, 5.0, 180.0
WAIT_M = 6.0
"""People this near to the counter who have not been served yet wait, metres."""
LEAST_WAITING = 4
"""Fewer people are neither queue nor cloud."""
STANDS_M_S = 0.1
MOST_BROAD = 0.2
"""SD of waiting people across the queue over that along it; in a half disc, a cloud before a
counter, it is 0.53. Chosen, not measured."""


def counter(seed: int) -> Figures:
    """Eight people come from all over a room and are served for 5 s each.

    Returns:
        The common figures; ``breadth`` (k,), at each second at which four or more people stand and
        wait, how broad they stand over how long; ``waiting`` (k,) how many they are.
    """
    width, depth = SIZE
    plan = FloorPlan(
        box(0.0, 0.0, width, depth), exits=[Exit("out", (width, 0.2), (width, 1.4))], name="counter"
    )
    model = crowd_model(plan, seed)
    served = Counter(line=[COUNTER, (COUNTER[0] - 1.0, COUNTER[1])], service=SERVICE_S)
    model.tactics.append(Queueing([served]))
    places = plan.random_points(
        PEOPLE, model.rng, within=box(0.5, 0.5, 4.0, depth - 0.5), spacing=1.0, clearance=CLEARANCE
    )
    model.add_pedestrians(places, route=[served.visit])
    run = evacuate(model, LIMIT_S, stop_when_stalled=False)
    breadth, waiting = breadths(run.trajectories)
    return {**run.figures(), "breadth": breadth, "waiting": waiting}


def breadths(tracks: Tracks) -> tuple[FloatArray, NDArray[np.int64]]:
    """How broad the group of people before the counter is, once a second.

    Only the k seconds at which four or more people stand near the counter count.

    Returns:
        (k,) breadth of the group over its length, and (k,) number of people in the group.
    """
    frames = round(tracks.frame_rate)
    start, end = tracks.steps(frames)
    x, y = tracks.x[end], tracks.y[end]
    gone = np.hypot(x - tracks.x[start], y - tracks.y[start])
    stands = (gone < STANDS_M_S) & (np.hypot(x - COUNTER[0], y - COUNTER[1]) < WAIT_M)
    stands &= tracks.frame[end] % frames == 0
    found, numbers = [], []
    for frame in np.unique(tracks.frame[end[stands]]):
        here = stands & (tracks.frame[end] == frame)
        if np.count_nonzero(here) >= LEAST_WAITING:
            short, long = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(x[here], y[here])), 0.0))
            found.append(short / long)
            numbers.append(np.count_nonzero(here))
    return np.array(found), np.array(numbers, dtype=np.int64)


def judge(runs: Runs) -> Verdict:
    """Four or more people wait, in a line."""
    (own,) = zip(*runs, strict=True)
    broadest = [
        float(np.percentile(each["breadth"], 90)) if len(each["breadth"]) else None for each in own
    ]
    most = median([float(each["waiting"].max(initial=0)) for each in own])
    checks = (
        at_least("condition of the counter: most people who wait", most, LEAST_WAITING),
        at_most("breadth over length of the queue, p90", median(broadest), MOST_BROAD),
        exactly("left inside", sum(each["left_inside"] for each in own), 0),
    )
    return Verdict(checks, {"breadths": np.concatenate([e["breadth"] for e in own]).tolist()})


def draw(figures: dict[str, Any]) -> Figure:
    """How broad those who wait stand over how long."""
    figure, axes = charts.panels(1)
    axes[0].hist(figures["breadths"], bins=np.linspace(0, 1, 41).tolist(), color=charts.OURS.colour)
    axes[0].axvline(MOST_BROAD, color=charts.OTHER.colour, label="bound of 90 %")
    axes[0].set(xlabel="breadth over length of people who wait", ylabel="seconds")
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="counter",
    what="people who wait before a counter stand in a queue",
    source="none: the bound is chosen",
    criterion="Four or more people wait, and they stand in a line, not in a cloud",
    cases=(case(counter, effort=3.0),),
    judge=judge,
    draw=draw,
)
