"""One person chooses between two exits, again and again (NIST 3.2 and 3.3)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, TargetChoice
from mesa_mobility.behaviors import FamiliarExit, SocialInfluence
from mesa_mobility.results import crossings
from mesa_mobility.verification.runs import Run, crowd_model, evacuate

Line = tuple[tuple[float, float], tuple[float, float]]

SIDE = 10.0
EXIT_1: Line = ((0.0, 4.5), (0.0, 5.5))
EXIT_2: Line = ((SIDE, 4.5), (SIDE, 5.5))
NEAR, FAR = 3.0, 8.0
"""Metres to the near exit, in the left wall, and to the far one."""
HESITATES_S = 2.0
"""Seconds before the person chooses, in which they can see where another goes."""


def influenced(seed: int, *, trials: int, other: bool) -> dict[str, Any]:
    """One person in the middle of a room with an exit at either side, 5 m away.

    Args:
        seed: of the first trial; each trial has a generator of its own.
        trials: how many.
        other: whether a second person beside them heads for exit 2.

    Returns:
        The common figures over all trials; ``share``, of trials in which the person left by
        exit 2, and ``trials``.
    """
    floor = box(0.0, 0.0, SIDE, SIDE)

    def people(model: PedestrianModel) -> None:
        model.add_pedestrians([[5.0, 5.0]], headings=[np.pi / 2], pre_movement=HESITATES_S)
        if other:
            model.add_pedestrians([[5.0, 6.0]], headings=[np.pi / 2], exits=["exit 2"])

    return _trials(seed, trials, floor, EXIT_2, SocialInfluence, people)


def familiar(seed: int, *, trials: int, knows: bool) -> dict[str, Any]:
    """One person 3 m from one exit and 8 m from another, which they know or not.

    Returns:
        As of `influenced`, with the ``share`` of the far exit, "exit 2".
    """
    width = NEAR + FAR
    known = ["exit 2"] if knows else []

    def people(model: PedestrianModel) -> None:
        model.add_pedestrians([[NEAR, 5.0]], headings=[np.pi / 2])

    line = ((width, 4.5), (width, 5.5))
    return _trials(
        seed, trials, box(0.0, 0.0, width, SIDE), line, lambda: FamiliarExit(known), people
    )


def _trials(
    seed: int,
    trials: int,
    floor: Polygon,
    exit_2: Line,
    choice: Callable[[], TargetChoice],
    people: Callable[[PedestrianModel], None],
) -> dict[str, Any]:
    runs: list[Run] = []
    taken = 0
    for number in range(trials):
        plan = FloorPlan(floor, exits=[Exit("exit 1", *EXIT_1), Exit("exit 2", *exit_2)])
        rng = np.random.default_rng([seed, number])
        model = crowd_model(plan, rng, target_choice=choice())
        people(model)
        run = evacuate(model, 60.0)
        taken += 0 in crossings(run.trajectories, *exit_2).person
        runs.append(run)
    return {**together([run.figures() for run in runs]), "share": taken / trials, "trials": trials}


def together(figures: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Common figures of several runs, combined into one."""
    time = sum(each["person_s"] for each in figures)
    sums = ("pedestrians", "left_inside", "overlaps", "wall_crossings", "person_s")
    shares = ("fallback_time_share", "fallback_decision_share")
    return {
        **{name: sum(each[name] for each in figures) for name in sums},
        **{name: sum(each[name] * each["person_s"] for each in figures) / time for name in shares},
    }
