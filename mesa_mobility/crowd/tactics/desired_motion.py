"""Desired motion: the targets and preferred speeds of deciding pedestrians."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import FARTHEST, Crowd, CrowdState
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice, query_targets
from mesa_mobility.crowd.tactics.unchanged import Given
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets
from mesa_mobility.plugins.output import numbers_given


class Wants(NamedTuple):
    """The behaviours that say what people want, as a model has them now.

    Attributes:
        choice: the target choice.
        tactics: the tactics, in the order in which they apply.
        rng: the model's generator.
    """

    choice: TargetChoice
    tactics: Sequence[Tactic]
    rng: np.random.Generator


class DesiredMotion:
    """Sets targets and preferred speeds for the next movement.

    Args:
        environment: the floor plan, with its routes.
        crowd: the crowd.
    """

    def __init__(self, environment: Environment, crowd: Crowd) -> None:
        self._environment = environment
        self._crowd = crowd

    def update(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        frame: int,
        wants: Wants,
        *,
        newcomers: bool = False,
    ) -> Targets:
        """Update targets, route lengths and preferred speeds of the pedestrians in ``rows``.

        Args:
            rows: (n,) the pedestrians.
            inside: rows of everybody inside, themselves included.
            frame: now.
            wants: the model's behaviours.
            newcomers: whether they have only just been put on the floor.

        Raises:
            ModelError: a behaviour gives values of the wrong shape or out of range.
        """
        n, crowd = len(rows), self._crowd
        positions, speeds = np.empty((n, 2)), np.empty(n)
        destinations = np.empty(n, dtype=np.int64)
        _look_up(rows, crowd.records, crowd.agenda, positions, destinations, speeds)
        deciding = Deciding(
            rows,
            positions,
            destinations,
            frame * FRAME_SECONDS,
            CrowdView(inside, crowd),
            wants.rng,
            self._environment,
        )
        given = Given(deciding)
        targets = query_targets(wants.choice, deciding, crowd, given)
        desired = Desired(targets.points, speeds, targets, newcomers)
        for tactic in wants.tactics:
            points, speeds, outside = desired.points, desired.speeds, given.keep(tactic)
            tactic.apply(deciding, desired)
            if outside:
                given.check(tactic)
            if outside or desired.points is not points or desired.speeds is not speeds:
                _check(tactic, desired, n)
        _settle(rows, desired.points, desired.speeds, crowd.records)
        return targets


def _check(tactic: Tactic, desired: Desired, n: int) -> None:
    """Raise ModelError where a tactic gives arrays of another shape, or numbers out of range."""
    giver = f"behaviour {tactic.name!r}"
    desired.points = numbers_given(giver, "points", desired.points, (n, 2))
    desired.speeds = numbers_given(giver, "speeds", desired.speeds, (n,))
    if not _in_range(desired.points, desired.speeds):
        raise ModelError(
            f"{giver}: gave points or speeds out of range, expected finite points within "
            f"{FARTHEST:g} m and speeds of 0 to {FASTEST:g} m/s"
        )


@entry_point()
def _in_range(points: NDArray[np.float64], speeds: NDArray[np.float64]) -> bool:
    """Whether points (n, 2), metres, and speeds (n,), m/s, can be those of people."""
    fine = True
    for k in range(len(speeds)):
        fine &= abs(points[k, 0]) <= FARTHEST and abs(points[k, 1]) <= FARTHEST
        fine &= 0.0 <= speeds[k] <= FASTEST
    return fine


@entry_point()
def _look_up(
    rows: NDArray[np.int64],
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
    destinations: NDArray[np.int64],
    speeds: NDArray[np.float64],
) -> None:
    """Write positions (n, 2) in metres, destinations (n,) and unhindered speeds (n,) in m/s of
    those in ``rows``."""
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        destinations[k], speeds[k] = state[i].destination, agenda[i]["speed"]


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
