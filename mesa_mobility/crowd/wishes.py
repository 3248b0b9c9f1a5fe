"""What those who decide wish for: where to go, and how fast."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.abreast import keep_abreast
from mesa_mobility.crowd.even_pace import keep_pace
from mesa_mobility.crowd.pace import Pace, ask_paces
from mesa_mobility.crowd.patience import look_around
from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.crowd.target_choice import Deciding, TargetChoice, ask
from mesa_mobility.floorplan import FloorPlan, Targets
from mesa_mobility.jit import called


def set_wishes(
    deciding: Deciding,
    crowd: Crowd,
    plan: FloorPlan,
    choice: TargetChoice,
    paces: Sequence[Pace],
    waiting: NDArray[np.bool_] | None = None,
    *,
    abreast: bool = False,
    impatience: bool = False,
    even_pace: bool = False,
) -> Targets:
    """Give those who decide their targets and the speed that they prefer here and now.

    Args:
        deciding: the pedestrians.
        crowd: the crowd; gets their targets, ways left to go and speeds.
        plan: the floor plan, with its zones of reduced speed.
        choice: where they go.
        paces: what slows them down.
        waiting: (n,) who stays where it is, if anybody.
        abreast: whether a crowd spreads out to pass a corner.
        impatience: whether those who get nowhere look for a way round.
        even_pace: whether those who walk freely make up for steps that were too long or too short.

    Raises:
        ModelError: a behaviour gives what it should not.
    """
    rows = deciding.pedestrians
    targets = ask(choice, deciding)
    crowd.route[rows] = targets.distances
    points = keep_abreast(deciding, targets, crowd) if abreast else targets.points
    speeds: NDArray[np.float64] = crowd.agenda["speed"][rows]
    if plan.zones:
        speeds = speeds * plan.speed_factors(deciding.positions)
    speeds = ask_paces(paces, deciding, speeds)
    if waiting is not None and waiting.any():
        # Like those who have no way to go: they come to a stand, and stay.
        speeds = np.where(waiting, 0.0, speeds)
        points = np.where(waiting[:, None], deciding.positions, points)
    if even_pace:
        speeds = keep_pace(rows, crowd, speeds)
    _settle(rows, np.ascontiguousarray(points, dtype=np.float64), speeds, crowd.records)
    if impatience:
        look_around(rows, crowd, deciding.elapsed, deciding.rng)
    return targets


@called()
def _settle(
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    state: CrowdState,
) -> None:
    """Note where those in ``rows`` go, (n, 2) metres, and how fast they would like to, (n,) m/s."""
    for k in range(len(rows)):
        i = rows[k]
        state[i].target_x, state[i].target_y = points[k, 0], points[k, 1]
        state[i].preferred = speeds[k]
