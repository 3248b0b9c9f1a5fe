"""People who sit in a wheelchair: one pose, moved along their tracks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.motion import BodyMotion
from mesa_mobility.bodies.rotations import about_z, from_vectors, quaternions
from mesa_mobility.bodies.skeleton import JOINT, TURN_OF, TURNING, forward_kinematics

SEATED_PELVIS = 0.55
"""Metres above the floor."""

_TURNED_UP = {"hip": -90.0, "knee": 90.0, "shoulder": -35.0, "elbow": -55.0}
"""Degrees about the axis to the left: thighs and forearms are level, shanks upright."""


def seated_motion(
    frames: NDArray[np.integer],
    track: NDArray[np.float64],
    elevation: NDArray[np.float64] | None = None,
) -> BodyMotion:
    """An adult who sits, in successive frames.

    Args:
        frames: (n,) frames at 30 Hz.
        track: (n, 3) x, y (metres) and heading (radians) in them.
        elevation: (n,) elevation of the floor, metres; 0 by default.
    """
    vectors = np.zeros((1, len(TURNING), 3))
    for part, degrees in _TURNED_UP.items():
        for side in ("left", "right"):
            vectors[0, TURN_OF[JOINT[f"{side}_{part}"]], 1] = np.deg2rad(degrees)
    positions, oriented = forward_kinematics(from_vectors(vectors))
    facing = about_z(track[:, 2])
    places = np.einsum("nij,kj->nki", facing, positions[0])
    height = np.full(len(track), SEATED_PELVIS)
    if elevation is not None:
        height += elevation
    places += np.column_stack([track[:, :2], height])[:, None]
    return BodyMotion(
        frames=np.asarray(frames, dtype=np.float64),
        positions=places,
        rotations=quaternions(np.einsum("nij,kjl->nkil", facing, oriented[0])),
        bearing=np.zeros((len(track), 4), dtype=bool),
    )
