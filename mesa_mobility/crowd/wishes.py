"""What those who decide wish for: where to go, and how fast."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.abreast import keep_abreast
from mesa_mobility.crowd.even_pace import keep_pace
from mesa_mobility.crowd.inside import Inside
from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.crowd.pace import Pace, ask_paces
from mesa_mobility.crowd.patience import look_around
from mesa_mobility.crowd.presets import Preset
from mesa_mobility.crowd.state import Crowd, CrowdState
from mesa_mobility.crowd.surroundings import Site
from mesa_mobility.crowd.target_choice import Deciding, TargetChoice, ask
from mesa_mobility.floorplan import Targets
from mesa_mobility.jit import Entry, called


def set_wishes(
    rows: NDArray[np.int64],
    inside: NDArray[np.int64],
    frame: int,
    crowd: Crowd,
    site: Site,
    choice: TargetChoice,
    paces: Sequence[Pace],
    preset: Preset,
    rng: np.random.Generator,
    *,
    all_go: bool = False,
) -> Targets:
    """Give those who decide their targets and the speed that they prefer here and now.

    Args:
        rows: (n,) the pedestrians.
        inside: rows of everybody inside, themselves included.
        frame: now.
        crowd: the crowd; gets their targets, ways left to go and speeds.
        site: the floor plan, with its routes and zones of reduced speed.
        choice: where they go.
        paces: what slows them down.
        preset: whether a crowd spreads out to pass a corner, whether those who get nowhere look for
            a way round, and whether those who walk freely make up for steps that were too long or
            too short.
        rng: the model's generator.
        all_go: whether those who wait get a target and a speed like everybody else.

    Raises:
        ModelError: a behaviour gives what it should not.
    """
    n = len(rows)
    positions, speeds, destinations = np.empty((n, 2)), np.empty(n), np.empty(n, dtype=np.int64)
    stay = _look_up(rows, frame, crowd.records, crowd.agenda, positions, destinations, speeds)
    elapsed = frame * FRAME_SECONDS
    deciding = Deciding(rows, positions, destinations, elapsed, Inside(inside, crowd), rng, site)
    targets = ask(choice, deciding, crowd)
    points = keep_abreast(deciding, targets, crowd) if preset.abreast else targets.points
    if site.plan.zones:
        speeds = speeds * site.plan.speed_factors(positions)
    speeds = ask_paces(paces, deciding, speeds)
    if stay and not all_go:
        # Like those who have no way to go: they come to a stand, and stay.
        waiting = crowd.agenda["waits_until"][rows] > frame
        speeds = np.where(waiting, 0.0, speeds)
        points = np.where(waiting[:, None], positions, points)
    if preset.even_pace:
        speeds = keep_pace(rows, crowd, speeds)
    _settle(rows, points, speeds, crowd.records)
    if preset.impatience:
        look_around(rows, crowd, elapsed, rng)
    return targets


@Entry
@called()
def _look_up(
    rows: NDArray[np.int64],
    frame: int,
    state: CrowdState,
    agenda: NDArray[np.void],
    positions: NDArray[np.float64],
    destinations: NDArray[np.int64],
    speeds: NDArray[np.float64],
) -> int:
    """Write where those in ``rows`` are, (n, 2) metres, where they go, and how fast they walk, m/s,
    if nothing slows them down. Returns how many of them wait."""
    count = 0
    for k in range(len(rows)):
        i = rows[k]
        positions[k, 0], positions[k, 1] = state[i].x, state[i].y
        destinations[k], speeds[k] = state[i].destination, agenda[i]["speed"]
        count += int(agenda[i]["waits_until"] > frame)
    return count


@Entry
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
