"""People who stand: in front of a door that has closed, and in a jam."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from mesa_mobility import Trajectories
from mesa_mobility.validation.bottleneck import START, plan
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case, charts
from mesa_mobility.verification.checks import at_most, exactly
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model, evacuate

FloatArray = NDArray[np.float64]

PEOPLE = 120
WIDTH = 0.8
CLOSES_S, SETTLE_S, MEASURE_S = 20.0, 5.0, 30.0
WINDOW_S = 1.5
STANDS_M = 0.1
"""A person who stays this near to one place for 1.5 s stands, metres."""
STEP_S = 0.1
"""Time over which the pelvis's speed is taken."""
MOST_SPEED, MOST_TURN_DEG = 0.1, 5.0


def queue(seed: int, *, closes: bool) -> dict[str, Any]:
    """A crowd presses towards a neck 0.8 m wide.

    Args:
        seed: of the run.
        closes: whether the neck is shut after 20 s. If so, everybody is measured
            from 25 s to 55 s. If not, people keep moving, and those who stand at
            any time from 10 s to 55 s are measured.

    Returns:
        The common figures and, of people who stand: ``speed_max``, ``speed_p99`` (m/s),
        ``moving_share``, the share of their time with the pelvis above 0.1 m/s, ``turn_max`` and
        ``turn_p99``, degrees between the extremes of heading within 1.5 s, ``standing_share``
        of the time of all, and ``crossed_closed``, people through the neck once it was shut.
    """
    floor = plan(WIDTH)
    model = crowd_model(floor, seed)
    places = floor.random_points(
        PEOPLE, model.rng, within=START, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    end = CLOSES_S + SETTLE_S + MEASURE_S
    events = [(CLOSES_S, lambda m: m.floor_plan.close_gate("neck"))] if closes else []
    run = evacuate(model, end, events, stop_when_stalled=False)
    times = run.crossing_times(floor.gates[0].a, floor.gates[0].b)
    start = CLOSES_S + SETTLE_S if closes else 10.0
    return {
        **run.figures(),
        **_at_rest(run, start, everybody=closes),
        "crossed_closed": int(np.count_nonzero(times > CLOSES_S)) if closes else 0,
    }


def _at_rest(run: Run, start: float, *, everybody: bool) -> dict[str, float | None]:
    tracks = run.trajectories
    rate = tracks.frame_rate
    window, step = round(WINDOW_S * rate), round(STEP_S * rate)
    speeds, turns, standing, total = [], [], 0, 0
    # In front of the closed door everybody stands; people already behind it still leave.
    people = tracks.remaining if everybody else None
    for places, headings in _tracks_from(tracks, round(start * rate), window, people):
        middle = window // 2
        around = sliding_window_view(places, window + 1, axis=0)
        away = np.hypot(*(around - around[:, :, middle : middle + 1]).transpose(1, 0, 2))
        stands = (away.max(axis=1) <= STANDS_M) | everybody
        standing, total = standing + int(stands.sum()), total + len(stands)
        shift = np.hypot(*(places[step:] - places[:-step]).T)[middle : middle + len(stands)]
        speeds.append(shift[stands] / STEP_S)
        span = sliding_window_view(headings, window + 1)[stands]
        turns.append(np.degrees(span.max(axis=1) - span.min(axis=1)))
    speed = np.concatenate(speeds) if speeds else np.empty(0)
    turn = np.concatenate(turns) if turns else np.empty(0)
    if not len(speed):
        names = ("speed_max", "speed_p99", "moving_share", "turn_max", "turn_p99")
        return {**dict.fromkeys(names), "standing_share": 0.0}
    return {
        "speed_max": float(speed.max()),
        "speed_p99": float(np.percentile(speed, 99)),
        "moving_share": float(np.mean(speed > MOST_SPEED)),
        "turn_max": float(turn.max()),
        "turn_p99": float(np.percentile(turn, 99)),
        "standing_share": standing / total,
    }


def _tracks_from(
    tracks: Trajectories, frame: int, window: int, people: NDArray[np.int32] | None
) -> list[tuple[FloatArray, FloatArray]]:
    """Places and unwrapped headings of people from a frame on, where long enough."""
    rows = tracks.by_person[tracks.frame[tracks.by_person] >= frame]
    if people is not None:
        rows = rows[np.isin(tracks.person[rows], people)]
    cuts = np.flatnonzero(np.diff(tracks.person[rows])) + 1
    return [
        (np.column_stack([tracks.x[own], tracks.y[own]]), np.unwrap(tracks.heading[own]))
        for own in np.split(rows, cuts)
        if len(own) > window + 1
    ]


def judge(runs: Runs) -> Verdict:
    """People in front of the closed door stand quietly; those in the jam are only reported."""
    closed, jam = zip(*runs, strict=True)

    def worst(of: Any, name: str) -> float | None:
        values = [each[name] for each in of]
        return None if None in values else float(max(values))

    checks = (
        exactly("through the closed door", sum(each["crossed_closed"] for each in closed), 0),
        at_most("closed door: greatest pelvis speed m/s", worst(closed, "speed_max"), MOST_SPEED),
        at_most(
            "closed door: greatest turn in 1.5 s deg", worst(closed, "turn_max"), MOST_TURN_DEG
        ),
        at_most(
            "jam: greatest pelvis speed of standing people m/s",
            worst(jam, "speed_max"),
            MOST_SPEED,
            gates=False,
        ),
        at_most(
            "jam: greatest turn of standing people deg",
            worst(jam, "turn_max"),
            MOST_TURN_DEG,
            gates=False,
        ),
    )
    figures = {
        f"{where}: {name}": float(np.median([each[name] for each in of]))
        for where, of in (("closed door", closed), ("jam", jam))
        for name in ("speed_p99", "turn_p99", "moving_share", "standing_share")
        if all(each[name] is not None for each in of)
    }
    return Verdict(checks, figures)


def draw(figures: dict[str, Any]) -> Figure:
    """Residual motion of people who stand."""
    figure, axes = charts.panels(2)
    for each, name, bound, label in (
        (axes[0], "speed_p99", MOST_SPEED, "pelvis speed of standing people, p99 (m/s)"),
        (axes[1], "turn_p99", MOST_TURN_DEG, "turn of standing people within 1.5 s, p99 (deg)"),
    ):
        places = ("closed door", "jam")
        values = [figures.get(f"{place}: {name}", float("nan")) for place in places]
        each.bar(places, values, color=charts.OURS.colour, width=0.5)
        each.axhline(bound, color=charts.OTHER.colour, label="bound")
        each.set_ylabel(label)
    charts.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="standing",
    what="motion at rest in a crowd before a closed door, and of those who stand in a jam",
    source="none: people who stand do not move",
    criterion="People before a door that has closed stand still, up to small movements of the "
    "body; those in a jam are reported",
    cases=tuple(case(queue, effort=2.0, closes=closes) for closes in (True, False)),
    judge=judge,
    draw=draw,
)
