"""Whether somebody alone gets through a door, round a corner, and out of a dead end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from shapely import Polygon, box

from mesa_mobility.examination.finding import Finding
from mesa_mobility.examination.subject import Subject
from mesa_mobility.floorplan import Exit, FloorPlan

ROOM, LEG, DEAD_END = 6.0, 6.0, 4.0
"""Metres: side of the room, each leg of the corridor, depth of the dead end."""

ASIDE = (0.4, 1.2)
"""Metres beside the jamb at which people stand who have missed the door."""


def door(subject: Subject) -> Finding:
    """From before a door, and from the wall on both sides of it, facing all ways."""
    half, wall = subject.door / 2, ROOM - subject.radius - 0.02
    plan = FloorPlan(
        box(0.0, 0.0, ROOM, ROOM),
        exits=[Exit("door", (ROOM, ROOM / 2 - half), (ROOM, ROOM / 2 + half))],
    )
    starts = [((1.0, ROOM / 2), 0.0, ROOM - 1.0)]
    starts += [
        ((wall, ROOM / 2 + side * (half + aside)), heading, half + aside)
        for side in (-1.0, 1.0)
        for aside in ASIDE
        for heading in (0.0, 0.4, -0.4, np.pi / 2, -np.pi / 2)
    ]
    return Finding(
        "door",
        f"alone through a door of {subject.door:.2g} m, from before it and from the wall beside it",
        **_all_in_time(subject.times(plan, starts)),
        helps="add recordings of people who sidestep, turn on the spot and walk off gently",
    )


def corner(subject: Subject) -> Finding:
    """Round a corner of 90 degrees to the left and to the right."""
    width, times = subject.corridor, []
    inner = LEG - width
    for side in (1.0, -1.0):
        corners = [(0, 0), (LEG, 0), (LEG, LEG), (inner, LEG), (inner, width), (0, width)]
        plan = FloorPlan(
            Polygon([(x, side * y) for x, y in corners]),
            exits=[Exit("end", (inner, side * LEG), (LEG, side * LEG))],
        )
        start = ((subject.radius + 0.1, side * width / 2), 0.0, 2 * LEG - width)
        times += subject.times(plan, [start])
    return Finding(
        "corner",
        f"alone round a corner of 90 degrees in a corridor of {width:.2g} m",
        **_all_in_time(times),
        helps="add recordings of people who turn while they walk",
    )


def turn(subject: Subject) -> Finding:
    """Out of a dead end, from facing its end and its sides."""
    width = subject.corridor
    plan = FloorPlan(
        box(0.0, 0.0, DEAD_END, width), exits=[Exit("end", (DEAD_END, 0.0), (DEAD_END, width))]
    )
    place = (subject.radius + 0.05, width / 2)
    headings = (np.pi, np.pi - 0.3, np.pi + 0.3, np.pi / 2, -np.pi / 2)
    return Finding(
        "turn",
        f"alone out of a dead end {width:.2g} m wide, from facing its end and its sides",
        **_all_in_time(subject.times(plan, [(place, each, DEAD_END) for each in headings])),
        helps="add recordings of people who turn on the spot",
    )


def _all_in_time(times: Sequence[float | None]) -> dict[str, Any]:
    """What is measured, expected and found of people who all should arrive."""
    arrived = [each for each in times if each is not None]
    return {
        "measured": {
            "starts": len(times),
            "in_time": len(arrived),
            "slowest_s": max(arrived, default=None),
        },
        "expected": f"all {len(times)} in time",
        "passed": len(arrived) == len(times),
    }
