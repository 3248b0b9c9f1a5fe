"""Desired motion: the targets and preferred speeds of deciding pedestrians."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.crowd.tactics.corner_spreading import spread_at_corners
from mesa_mobility.crowd.tactics.impatience import perturb_targets
from mesa_mobility.crowd.tactics.speed_compensation import compensate_speed
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule, apply_speed_rules
from mesa_mobility.crowd.tactics.target_choice import Deciding, TargetChoice, query_targets
from mesa_mobility.crowd.tactics.turns import Turns
from mesa_mobility.floorplan import Targets


class Steps(NamedTuple):
    """Which steps of the tactics a model takes.

    Attributes:
        spread_at_corners: whether a crowd spreads out to pass a corner.
        take_turns: whether people take turns where two cannot pass each other.
        compensate_speed: whether free walkers correct their accumulated distance error.
        perturb_targets: whether people who get nowhere look for a way round.
    """

    spread_at_corners: bool
    take_turns: bool
    compensate_speed: bool
    perturb_targets: bool


class Tactics(NamedTuple):
    """The behaviours that say what people want, as a model has them now.

    Attributes:
        choice: the target choice.
        speed_rules: the speed rules.
        rng: the model's generator.
    """

    choice: TargetChoice
    speed_rules: Sequence[SpeedRule]
    rng: np.random.Generator


class DesiredMotion:
    """Sets targets and preferred speeds for the next movement.

    Args:
        environment: the floor plan, with its routes and zones of reduced speed.
        crowd: the crowd.
        steps: which steps are taken.
    """

    def __init__(self, environment: Environment, crowd: Crowd, steps: Steps) -> None:
        self._environment = environment
        self._crowd = crowd
        self._steps = steps
        self._turns = Turns(environment.plan)

    def update(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        frame: int,
        tactics: Tactics,
        *,
        all_go: bool = False,
    ) -> Targets:
        """Update targets, route lengths and preferred speeds of the pedestrians in ``rows``.

        Args:
            rows: (n,) the pedestrians.
            inside: rows of everybody inside, themselves included.
            frame: now.
            tactics: the model's behaviours.
            all_go: whether those who wait get a target and a speed as well.

        Raises:
            ModelError: a behaviour gives values of the wrong shape or out of range.
        """
        n, plan, steps, crowd = len(rows), self._environment.plan, self._steps, self._crowd
        positions, speeds = np.empty((n, 2)), np.empty(n)
        destinations = np.empty(n, dtype=np.int64)
        stay = _look_up(rows, frame, crowd.records, crowd.agenda, positions, destinations, speeds)
        elapsed = frame * FRAME_SECONDS
        deciding = Deciding(
            rows, positions, destinations, elapsed, CrowdView(inside, crowd), tactics.rng,
            self._environment,
        )  # fmt: skip
        targets = query_targets(tactics.choice, deciding, crowd)
        points = targets.points
        if steps.spread_at_corners:
            points = spread_at_corners(deciding, targets, crowd)
        if plan.zones:
            speeds = speeds * plan.speed_factors(positions)
        speeds = apply_speed_rules(tactics.speed_rules, deciding, speeds)
        if steps.take_turns and not all_go:
            points, speeds = self._turns.take(rows, inside, frame, crowd, points, speeds)
        if stay and not all_go:
            # As for people without a route: they stop, and stay.
            waiting = crowd.agenda["waits_until"][rows] > frame
            speeds = np.where(waiting, 0.0, speeds)
            points = np.where(waiting[:, None], positions, points)
        if steps.compensate_speed:
            speeds = compensate_speed(rows, crowd, speeds)
        _settle(rows, points, speeds, crowd.records)
        if steps.perturb_targets:
            perturb_targets(rows, crowd, elapsed, tactics.rng)
        return targets


@entry_point()
def _look_up(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
    destinations: NDArray[np.int64],
    speeds: NDArray[np.float64],
) -> int:
    """Write positions (n, 2) in metres, destinations (n,) and unhindered speeds (n,) in m/s of
    those in ``rows``. Returns how many of them wait."""
    count = 0
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        destinations[k], speeds[k] = state[i].destination, agenda[i]["speed"]
        count += int(agenda[i]["waits_until"] > frame)
    return count


@entry_point()
def _settle(
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Write targets (n, 2), metres, and preferred speeds (n,), m/s, of those in ``rows``."""
    for k in range(len(rows)):
        i = rows[k]
        state[i].target_x, state[i].target_y = points[k, 0], points[k, 1]
        state[i].preferred = speeds[k]
