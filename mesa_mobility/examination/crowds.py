"""Whether a small crowd leaves by a door."""

from __future__ import annotations

from shapely import box

from mesa_mobility.examination.finding import Finding
from mesa_mobility.examination.subject import BESIDE, Subject
from mesa_mobility.floorplan import Exit, FloorPlan

PEOPLE, SEEDS = 20, 3

DOOR = 1.0
"""Least width in metres."""

LONGEST = 300.0
"""Seconds; runs without progress end sooner."""


def crowd(subject: Subject) -> Finding:
    """Twenty people through a door."""
    width = max(DOOR, 2.0 * subject.radius + BESIDE)
    spacing = 2.0 * subject.radius + 0.15
    side = max(6.0, 7.0 * spacing)
    plan = FloorPlan(
        box(0.0, 0.0, side + 2.0, side),
        exits=[Exit("door", (side + 2.0, (side - width) / 2), (side + 2.0, (side + width) / 2))],
    )
    left, seconds = [], []
    for seed in range(SEEDS):
        model = subject.model(plan, seed)
        places = plan.random_points(
            PEOPLE,
            model.rng,
            within=box(0.0, 0.0, side, side),
            spacing=spacing,
            clearance=subject.radius + 0.05,
        )
        model.add_pedestrians(places)
        model.run(max_seconds=LONGEST)
        left.append(model.inside)
        seconds.append(round(model.elapsed, 1))
    return Finding(
        "crowd",
        f"{PEOPLE} people through a door of {width:.2g} m, {SEEDS} runs",
        {"most_left_inside": max(left), "longest_s": max(seconds)},
        "nobody left inside",
        max(left) == 0,
        "add recordings of people who stop, sidestep and turn on the spot",
    )
