"""Rooms one behind the other, joined by necks (RiMEA tests 12, 12a to 12d)."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from shapely import Polygon, box, union_all

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.results import flow
from mesa_mobility.verification.runs import (
    CLEARANCE,
    SPACING,
    Run,
    crowd_model,
    evacuate,
    steady_flow,
)

ROOM = 10.0
MIDDLE = 5.0
START = box(0.0, 0.0, 5.0, ROOM)
LIMIT_S = 600.0


def neck(
    seed: int, *, width: float, length: float, goal: float, people: int = 150
) -> dict[str, Any]:
    """People pass from a room 10 m x 10 m through a neck to a goal some way behind it.

    Args:
        seed: of the run.
        width: of the neck, metres.
        length: of the neck, metres.
        goal: distance of the goal behind the neck, metres; 0 is the neck's own end.
        people: how many start in the left half of the room.

    Returns:
        The common figures; ``flow_per_s`` over the end of the neck, without the run-up and
        the tail; and ``passed_s``, the time when the last person had passed it.
    """
    low, high, end = MIDDLE - width / 2, MIDDLE + width / 2, ROOM + length
    parts = [box(0.0, 0.0, ROOM, ROOM), box(ROOM, low, end, high)]
    if goal > 0.0:
        parts.append(box(end, 0.0, end + goal, ROOM))
        line = ((end + goal, 0.0), (end + goal, ROOM))
        gates = [Gate("neck", (ROOM + length / 2, low), (ROOM + length / 2, high))]
    else:
        line, gates = ((end, low), (end, high)), []
    plan = FloorPlan(union_all(parts), exits=[Exit("goal", *line)], gates=gates)
    run = _fill_and_run(plan, START, people, seed)
    times = run.crossing_times((end, low), (end, high))
    return {
        **run.figures(),
        "flow_per_s": steady_flow(times, people),
        "passed_s": float(times[-1]) if len(times) == people else None,
    }


TWO_ROOMS = Polygon(
    [(0, 0), (10, 0), (10, 4.5), (15, 4.5), (15, 0), (25, 0), (25, 4.5), (26, 4.5), (26, 5.5),
     (25, 5.5), (25, 10), (15, 10), (15, 5.5), (10, 5.5), (10, 10), (0, 10)]
)  # fmt: skip
THREE_ROOMS = Polygon(
    [(0, 0), (10, 0), (10, 4.5), (10.2, 4.5), (10.2, 0), (20.2, 0), (20.2, 4.5), (20.4, 4.5),
     (20.4, 0), (25.4, 0), (25.4, 10), (20.4, 10), (20.4, 5.5), (20.2, 5.5), (20.2, 10),
     (10.2, 10), (10.2, 5.5), (10, 5.5), (10, 10), (0, 10)]
)  # fmt: skip


def two_rooms(seed: int, *, people: int = 150) -> dict[str, Any]:
    """Two rooms joined by a neck of 1 m x 5 m, the second with an exit of 1 m (RiMEA test 12)."""
    plan = FloorPlan(
        TWO_ROOMS,
        exits=[Exit("exit", (26.0, 4.5), (26.0, 5.5))],
        gates=[Gate("neck", (12.5, 4.5), (12.5, 5.5))],
    )
    run = _fill_and_run(plan, box(0.0, 0.5, 5.0, 9.5), people, seed)
    return {**run.figures(), **_before(run, ((10.0, 2.0, 3.0), (25.0, 2.0, 3.0)))}


def three_rooms(seed: int, *, people: int = 150) -> dict[str, Any]:
    """Run people through three rooms joined by openings 1 m wide in walls 0.2 m thick.

    This is RiMEA test 12c.
    """
    plan = FloorPlan(
        THREE_ROOMS,
        exits=[Exit("exit", (25.4, 0.0), (25.4, 10.0))],
        gates=[
            Gate("first", (10.1, 4.5), (10.1, 5.5)),
            Gate("second", (20.3, 4.5), (20.3, 5.5)),
        ],
    )
    run = _fill_and_run(plan, START, people, seed)
    return {**run.figures(), **_before(run, ((10.0, 2.0, 3.0), (20.2, 2.0, 3.0)))}


def _before(run: Run, lines: tuple[tuple[float, float, float], ...]) -> dict[str, Any]:
    """Of openings 1 m wide at x: people through, flow, and crowds in a box in front of them."""
    through, flows, peaks, tops = [], [], [], []
    for x, depth, width in lines:
        times = run.crossing_times((x, MIDDLE - 0.5), (x, MIDDLE + 0.5))
        through.append(len(times))
        flows.append(flow(times) or 0.0)
        counts = counted(run, box(x - depth, MIDDLE - width / 2, x, MIDDLE + width / 2))
        peaks.append(float(counts.max()))
        tops.append(float(np.sort(counts)[-10:].mean()))
    return {"through": through, "flow_per_s": flows, "peak": peaks, "top_10": tops}


def counted(run: Run, area: Polygon, every: float = 0.5) -> np.ndarray:
    """People in an area each half a second."""
    tracks = run.trajectories
    frames = np.arange(0, tracks.frames, round(every * tracks.frame_rate))
    inside = shapely.contains_xy(area, tracks.x, tracks.y)
    per_frame = np.bincount(tracks.frame[inside], minlength=tracks.frames)
    return per_frame[frames]


def _fill_and_run(plan: FloorPlan, start: Polygon, people: int, seed: int) -> Run:
    model = crowd_model(plan, seed)
    places = plan.random_points(
        people, model.rng, within=start, spacing=SPACING, clearance=CLEARANCE
    )
    model.add_pedestrians(places)
    return evacuate(model, LIMIT_S)
