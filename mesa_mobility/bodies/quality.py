"""How well bodies move: feet that slide or enter the floor, joints that jump."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.feet import LEGS, soles
from mesa_mobility.bodies.motion import BodyMotion
from mesa_mobility.bodies.rotations import angles, matrices
from mesa_mobility.bodies.skeleton import TURNING

LEAST_STANCE = 4
"""Frames that a foot must bear on the floor to count as a step."""


class BodyQuality(NamedTuple):
    """Figures of a body's motion.

    Attributes:
        slides: (steps,) metres that a foot slides over the floor while it bears on the floor, for
            each time that it does.
        depths: (n, 2) metres by which each sole is below the floor.
        jumps: (n - 1,) greatest angle by which a joint turns against its parent from one frame to
            the next, radians.
    """

    slides: NDArray[np.float64]
    depths: NDArray[np.float64]
    jumps: NDArray[np.float64]


def quality(motion: BodyMotion) -> BodyQuality:
    """Sliding and penetration of the feet, and jumps of the joints, in successive frames."""
    slides = []
    depths = np.zeros((len(motion), 2))
    oriented = matrices(motion.rotations)
    for side, (_, _, ankle, toe) in enumerate(LEGS):
        bearing = motion.bearing[:, 2 * side : 2 * side + 2]
        places = motion.positions[:, [ankle, toe], :2]
        slides.append(_slides(places, bearing))
        heel, ball = soles(motion.positions[:, ankle] / motion.scale, oriented[:, ankle])
        lowest = np.minimum(heel[:, 2], ball[:, 2]) * motion.scale
        depths[:, side] = np.maximum(0.0, -lowest)
    turns = motion.local()
    changed = angles(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    return BodyQuality(
        slides=np.concatenate(slides),
        depths=depths,
        jumps=changed.reshape(-1, len(TURNING)).max(axis=1, initial=0.0),
    )


def _slides(places: NDArray[np.float64], bearing: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Length of the way of the joint that bears, the toe before the ankle, for each stance."""
    moved = np.linalg.norm(np.diff(places, axis=0), axis=2)
    both = bearing[1:] & bearing[:-1]
    slid = np.where(both[:, 1], moved[:, 1], np.where(both[:, 0], moved[:, 0], 0.0))
    stance = np.concatenate([[False], both.any(axis=1), [False]]).astype(np.int8)
    edges = np.diff(stance)
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    long = ends - starts >= LEAST_STANCE - 1
    way = np.concatenate([[0.0], np.cumsum(slid)])
    return (way[ends] - way[starts])[long]
