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
"""Metres from the jamb at which people start who have missed the door."""


def door(subject: Subject) -> Finding:
    """Test whether somebody alone gets through a door in time.

    They start in front of the door, and at the wall to either side of it. There they face the wall
    (straight, and 0.4 rad to either side) or one way along it.
    """
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
    """Test whether somebody alone gets round a corner of 90 degrees, left and right, in time."""
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
    """Test whether somebody alone gets out of a dead end in time.

    They start at its closed end and face that end (straight, and 0.3 rad to either side) or one of
    the sides. The test is passed if they leave within ``Subject.limit`` from each of these
    headings.
    """
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
    """``measured``, ``expected`` and ``passed`` of a ``Finding`` that everybody arrives in time.

    Args:
        times: seconds until each person arrived; None for those who did not in time.
    """
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
