"""500 people through three wide corridors (RiMEA test 15), and crowds in one of 60 m (ISO 13)."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import CLEARANCE, SPACING, crowd_model, evacuate, passing_time
from mesa_mobility.verification.scenarios.walks import corridor_plan

WAYS = {
    "long": (box(0.0, 0.0, 20.0, 81.4), ((0.0, 0.0), (20.0, 0.0)), 81.4),
    "corner": (
        Polygon([(0, 0), (30, 0), (30, 20), (20, 20), (20, 60), (0, 60)]),
        ((30.0, 0.0), (30.0, 20.0)),
        60.0,
    ),
    "short": (box(0.0, 0.0, 20.0, 50.0), ((0.0, 0.0), (20.0, 0.0)), 50.0),
}
"""Floor, line of arrival and upper edge of the strip, 6 m deep, in which people start."""
STRIP = 6.0


def wide_way(seed: int, *, way: str, people: int = 500) -> dict[str, Any]:
    """People cross a way 20 m wide: the same people, in the same places, in each of the three."""
    floor, line, top = WAYS[way]
    plan = FloorPlan(floor, exits=[Exit("end", *line)])
    model = crowd_model(plan, seed)
    strip = box(0.0, 0.0, 20.0, STRIP)
    empty = FloorPlan(strip, exits=[Exit("end", (0.0, 0.0), (20.0, 0.0))])
    places = empty.random_points(people, model.rng, spacing=SPACING, clearance=CLEARANCE)
    model.add_pedestrians(places + np.array([0.0, top - STRIP]))
    run = evacuate(model, 400.0)
    return run.figures()


LENGTH, WIDTH = 60.0, 2.0
ZONE = (20.0, 40.0)
FROM_S, TO_S = 5.0, 15.0
"""Measuring interval: people are under way and the zone is still fed."""


def full_corridor(seed: int, *, people: int, speed: float) -> dict[str, Any]:
    """People all over a corridor of 60 m x 2 m walk to its right end.

    Returns:
        The common figures; ``density`` (1/m2) from x = 20 to 40 m and ``flow`` (1/(m s))
        over x = 40 m, both from 5 s to 15 s, and ``speed``, the mean over people of 20 m divided
        by the time from x = 20 to 40 m (m/s).
    """
    plan = corridor_plan(LENGTH, WIDTH)
    model = crowd_model(plan, seed)
    places = plan.random_points(people, model.rng, spacing=SPACING, clearance=CLEARANCE)
    model.add_pedestrians(places, headings=np.zeros(people), preferred_speeds=speed)
    run = evacuate(model, 600.0)
    tracks = run.trajectories
    times = tracks.frame / tracks.frame_rate
    now = (times >= FROM_S) & (times < TO_S)
    zone = box(ZONE[0], 0.0, ZONE[1], WIDTH)
    inside = shapely.contains_xy(zone, tracks.x[now], tracks.y[now]).sum()
    found = crossings(tracks, (ZONE[1], 0.0), (ZONE[1], WIDTH))
    passed = np.count_nonzero((found.time >= FROM_S) & (found.time < TO_S))
    behind = np.flatnonzero(places[:, 0] < ZONE[0])
    transits = [passing_time(*run.track(int(person)), 0, *ZONE) for person in behind]
    speeds = [(ZONE[1] - ZONE[0]) / each for each in transits if each is not None]
    span = TO_S - FROM_S
    return {
        **run.figures(),
        "density": float(inside) / (span * tracks.frame_rate) / zone.area,
        "flow": passed / span / WIDTH,
        "speed": float(np.mean(speeds)) if speeds else None,
    }
