"""Whether somebody alone stops where they are to stand, and walks as slowly as they are to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from shapely import box

from mesa_mobility.crowd import PedestrianModel, Visit
from mesa_mobility.examination.finding import Finding
from mesa_mobility.examination.subject import Subject
from mesa_mobility.floorplan import Exit, FloorPlan

HALL, POINT = (14.0, 4.0), (7.0, 2.0)
"""Metres: length and width of the hall, and the place to stop at; people start at x = 1 m."""

STAY, NEAR, STILL = 5.0, 0.5, 0.1
"""Seconds to stand there, metres from the point, and m/s below which somebody stands."""

SLOW, OFF = 0.5, 0.2
"""m/s at which people walk in a jam, or half as fast as they prefer; share by which the speed may
be missed."""

STEADY = (3.0, 13.0)
"""Metres of x between which the speed is measured."""


def stop(subject: Subject) -> Finding:
    """At a point on the way, to stand there for a time."""
    model = subject.alone(_hall(), (1.0, POINT[1]), route=[Visit(POINT, STAY)])
    path = _walk(model, subject.limit(HALL[0]) + STAY)
    seconds, away = _stands(path)
    return Finding(
        "stop",
        f"alone to a point, to stand there for {STAY:g} s",
        {"stood_s": seconds, "from_the_point_m": away},
        f"at least {0.8 * STAY:g} s within {NEAR:g} m",
        seconds >= 0.8 * STAY and away is not None and away <= NEAR,
        "add recordings of people who stop and stand",
    )


def slowly(subject: Subject) -> Finding:
    """As slowly as in a jam, and at the type's own speed."""
    slow = min(SLOW, subject.speed / 2)
    found: dict[str, float | None] = {}
    for name, speed in (("slow", slow), ("own", subject.speed)):
        model = subject.alone(_hall(), (1.0, POINT[1]), speed=speed)
        path = _walk(model, subject.limit(HALL[0], speed))
        t, x, _ = path[(path[:, 1] >= STEADY[0]) & (path[:, 1] <= STEADY[1])].T
        steady = not model.inside and len(t) > 1
        walked = float((x[-1] - x[0]) / (t[-1] - t[0])) if steady else None
        found[f"{name}_m_s"] = round(speed, 2)
        found[f"walked_{name}_m_s"] = None if walked is None else round(walked, 2)
    passed = all(
        (walked := found[f"walked_{name}_m_s"]) is not None
        and abs(walked / found[f"{name}_m_s"] - 1.0) <= OFF  # type: ignore[operator]
        for name in ("slow", "own")
    )
    return Finding(
        "speed",
        "alone through a hall, slowly and at the speed of the type",
        dict(found),
        f"both speeds within {OFF:.0%}",
        passed,
        "add recordings of people who walk slowly, start and stop",
    )


def _hall() -> FloorPlan:
    length, width = HALL
    return FloorPlan(
        box(0.0, 0.0, length, width), exits=[Exit("end", (length, 0.0), (length, width))]
    )


def _walk(model: PedestrianModel, limit: float) -> NDArray[np.float64]:
    """(n, 3) time in seconds and place in metres of somebody alone, each 0.1 s."""
    person = model.space.active_agents[0]
    path = []
    while model.inside and model.elapsed < limit:
        path.append((model.elapsed, *person.position))
        model.step()
    return np.array(path)


def _stands(path: NDArray[np.float64]) -> tuple[float, float | None]:
    """Seconds for which somebody stands on the way, and how far from the point they do."""
    speeds = np.hypot(*np.diff(path[:, 1:], axis=0).T) / np.diff(path[:, 0])
    still = (speeds < STILL) & (path[1:, 1] > STEADY[0])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]])))
    if not len(edges):
        return 0.0, None
    starts, ends = edges[::2], edges[1::2]
    longest = int(np.argmax(ends - starts))
    there = path[1:][starts[longest] : ends[longest]]
    away = float(np.hypot(*(there[:, 1:] - POINT).T).max())
    return round(float(there[-1, 0] - there[0, 0]), 1), round(away, 2)
