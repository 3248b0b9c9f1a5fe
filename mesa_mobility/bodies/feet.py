"""Feet that stay where they bear on the floor.

A person's path is not exactly the recorded one: its samples lie 0.1 s apart, its legs are those of
the neutral skeleton, and steps may be shortened. So each foot is held where it came down, and led
back while it swings. Two-bone inverse kinematics bends the leg accordingly.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.rotations import TINY, shortest_turn, unit
from mesa_mobility.bodies.sequence import FADE
from mesa_mobility.bodies.skeleton import (
    ANKLE_HEIGHT,
    HEEL_BACK,
    JOINT,
    OFFSETS,
)
from mesa_mobility.compiled.decorators import kept

LEGS = tuple(
    tuple(JOINT[f"{side}_{joint}"] for joint in ("hip", "knee", "ankle", "toe"))
    for side in ("left", "right")
)
"""Numbers of hip, knee, ankle and toe of both legs."""

FARTHEST = 0.15
"""Metres that a foot is held away from where the recording has it; then it takes a step."""

STEP_FRAMES = 9
"""Frames of such a step, and frames within which a swinging foot is led back."""

STEP_LIFT = 0.03
"""Height of such a step, metres."""

LANDING_FRAMES = 4
"""Frames within which a foot that comes down is put onto the floor."""

STRAIGHT = 0.9995
"""Length of a leg that is stretched, as a share of thigh and shank."""

Floor = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""Heights (n,) of the floor beneath (n, 2) points of successive frames, and (n,) heights over which
feet swing there; see ``Footing.beneath`` of ``mesa_mobility.buildings``."""

_HEEL = np.array([-HEEL_BACK, 0.0, -ANKLE_HEIGHT])
_BALL = np.array([OFFSETS[JOINT["left_toe"], 0], 0.0, -ANKLE_HEIGHT])


def plant(
    positions: NDArray[np.float64],
    oriented: NDArray[np.float64],
    bearing: NDArray[np.bool_],
    floor: Floor | None = None,
) -> NDArray[np.bool_]:
    """Hold feet where they bear on the floor, and put them onto it; changes the first arguments.

    Args:
        positions: (n, 22, 3) joint positions of one person in successive frames, metres.
        oriented: (n, 22, 3, 3) orientations of the joints.
        bearing: (n, 4) whether left ankle and toe, right ankle and toe bear on the floor.
        floor: where the floor is; by default it is level, at 0.

    Returns:
        (n, 4) the same, without feet that take a step to get back under the body.
    """
    held = bearing.copy()
    for side, (hip, knee, ankle, toe) in enumerate(LEGS):
        own = bearing[:, 2 * side : 2 * side + 2]
        away, lift, stepping = _hold(
            positions[:, ankle, :2], positions[:, toe, :2], own, FARTHEST, STEP_FRAMES, STEP_LIFT
        )
        held[stepping, 2 * side : 2 * side + 2] = False
        target = positions[:, ankle].copy()
        target[:, :2] += away
        target[:, 2] += lift
        bears = held[:, 2 * side : 2 * side + 2]
        target[:, 2] += _to_floor(target, oriented[:, ankle], bears, floor)
        bend(positions, oriented, (hip, knee, ankle), target)
        positions[:, toe] = positions[:, ankle] + oriented[:, ankle] @ OFFSETS[toe]
    return held


def soles(
    ankle: NDArray[np.float64], foot: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3) heel and (n, 3) ball on the sole, from the ankle and the foot's orientation."""
    return ankle + foot @ _HEEL, ankle + foot @ _BALL


@kept()
def _hold(
    ankle: NDArray[np.float64],
    toe: NDArray[np.float64],
    bearing: NDArray[np.bool_],
    farthest: float,
    step_frames: int,
    step_lift: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """How far a foot is moved over the floor and lifted, and when it steps back under the body."""
    n = len(ankle)
    away, lift = np.zeros((n, 2)), np.zeros(n)
    stepping = np.zeros(n, np.bool_)
    left_x = left_y = 0.0  # how far it was away when it left the floor
    since, steps = step_frames, False
    for t in range(1, n):
        if not steps and bearing[t, 1] and bearing[t - 1, 1]:
            dx, dy = toe[t, 0] - toe[t - 1, 0], toe[t, 1] - toe[t - 1, 1]
        elif not steps and bearing[t, 0] and bearing[t - 1, 0]:
            dx, dy = ankle[t, 0] - ankle[t - 1, 0], ankle[t, 1] - ankle[t - 1, 1]
        else:
            if not steps and since == 0:
                left_x, left_y = away[t - 1, 0], away[t - 1, 1]
            since = min(since + 1, step_frames)
            u = since / step_frames
            rest = 1.0 - u * u * (3.0 - 2.0 * u)
            away[t, 0], away[t, 1] = rest * left_x, rest * left_y
            if steps:
                lift[t] = step_lift * math.sin(math.pi * u)
                stepping[t] = True
            if since == step_frames:
                steps = False
            continue
        since = 0
        away[t, 0], away[t, 1] = away[t - 1, 0] - dx, away[t - 1, 1] - dy
        if math.hypot(away[t, 0], away[t, 1]) > farthest:
            steps = True
            left_x, left_y = away[t, 0], away[t, 1]
    return away, lift, stepping


def _to_floor(
    ankle: NDArray[np.float64],
    foot: NDArray[np.float64],
    bearing: NDArray[np.bool_],
    floor: Floor | None,
) -> NDArray[np.float64]:
    """(n,) how far a foot is raised so that it bears on the floor and never enters it."""
    heel, ball = soles(ankle, foot)
    lowest = np.minimum(heel[:, 2], ball[:, 2])
    down: NDArray[np.float64] = np.asarray(bearing.any(axis=1), dtype=np.float64)
    weights = np.full(LANDING_FRAMES, 1.0 / LANDING_FRAMES)
    share = np.convolve(np.concatenate([np.full(LANDING_FRAMES - 1, down[0]), down]), weights)
    landed = share[LANDING_FRAMES - 1 : LANDING_FRAMES - 1 + len(down)]
    if floor is not None:
        # A foot over the edge of a tread is on the higher one. A swinging foot passes the edges.
        treads, edges = np.maximum(floor(heel[:, :2]), floor(ball[:, :2]))
        lowest = lowest - (edges + landed * (treads - edges))
    return np.where(lowest > 0.0, -lowest * landed, -lowest)


def bend(
    positions: NDArray[np.float64],
    oriented: NDArray[np.float64],
    leg: tuple[int, int, int],
    target: NDArray[np.float64],
) -> None:
    """Two-bone inverse kinematics: put the ankle where wanted, or as near as the leg reaches.

    The leg swings about the hip as a whole, then the knee bends; the foot keeps its orientation.
    """
    hip, knee, ankle = leg
    start = positions[:, hip]
    thigh = float(np.linalg.norm(OFFSETS[knee]))
    shank = float(np.linalg.norm(OFFSETS[ankle]))
    way = target - start
    distance = np.linalg.norm(way, axis=1)
    reach = np.clip(distance, abs(thigh - shank) + TINY, STRAIGHT * (thigh + shank))
    along = unit(way)
    swung = shortest_turn(unit(positions[:, ankle] - start), along)
    bent = np.einsum("nij,nj->ni", swung, positions[:, knee] - start)
    # A straight leg bends to where the body faces.
    forward = oriented[:, 0, :, 0]
    bent = bent + 0.02 * forward
    aside = unit(bent - np.einsum("ni,ni->n", bent, along)[:, None] * along)
    cosine = (thigh**2 + reach**2 - shank**2) / (2.0 * thigh * reach)
    cosine = np.clip(cosine, -1.0, 1.0)[:, None]
    new_knee = start + thigh * (cosine * along + np.sqrt(1.0 - cosine**2) * aside)
    new_ankle = start + reach[:, None] * along
    for joint, old, new in (
        (hip, positions[:, knee] - start, new_knee - start),
        (knee, positions[:, ankle] - positions[:, knee], new_ankle - new_knee),
    ):
        oriented[:, joint] = shortest_turn(unit(old), unit(new)) @ oriented[:, joint]
    positions[:, knee], positions[:, ankle] = new_knee, new_ankle


def settle(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) values of which each change takes as long as a join of poses."""
    weights: NDArray[np.float64] = FADE - np.append(FADE[1:], 0.0)
    padded = np.concatenate([np.full(len(weights), values[0]), values])
    return np.convolve(padded, weights)[len(weights) : len(weights) + len(values)]
