"""The neutral skeleton: an adult of 1.75 m, onto whom all recordings are put.

It stands upright, facing +x, arms hanging, z up. Lengths are the shares of stature in Drillis and
Contini (1966), as in Winter, Biomechanics and Motor Control of Human Movement, figure 4.1; hips lie
0.175 m apart, as in the recordings.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

STATURE = 1.75
"""Metres."""

_BONES: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("pelvis", "", (0.0, 0.0, 0.0)),
    # The joint from which the trunk leans against the pelvis.
    ("spine", "pelvis", (0.0, 0.0, 0.0)),
    ("chest", "spine", (0.0, 0.0, 0.300)),
    ("neck", "chest", (0.0, 0.0, 0.205)),
    ("head", "neck", (0.0, 0.0, 0.130)),
    ("crown", "head", (0.0, 0.0, 0.185)),
    # Collar bones start below the neck; they turn as the shoulders are raised and drawn forward.
    ("left_collar", "chest", (0.0, 0.0, 0.160)),
    ("left_shoulder", "left_collar", (0.0, 0.185, 0.0)),
    ("left_elbow", "left_shoulder", (0.0, 0.0, -0.300)),
    ("left_wrist", "left_elbow", (0.0, 0.0, -0.255)),
    ("right_collar", "chest", (0.0, 0.0, 0.160)),
    ("right_shoulder", "right_collar", (0.0, -0.185, 0.0)),
    ("right_elbow", "right_shoulder", (0.0, 0.0, -0.300)),
    ("right_wrist", "right_elbow", (0.0, 0.0, -0.255)),
    ("left_hip", "pelvis", (0.0, 0.0875, 0.0)),
    ("left_knee", "left_hip", (0.0, 0.0, -0.429)),
    ("left_ankle", "left_knee", (0.0, 0.0, -0.431)),
    ("left_toe", "left_ankle", (0.130, 0.0, -0.050)),
    ("right_hip", "pelvis", (0.0, -0.0875, 0.0)),
    ("right_knee", "right_hip", (0.0, 0.0, -0.429)),
    ("right_ankle", "right_knee", (0.0, 0.0, -0.431)),
    ("right_toe", "right_ankle", (0.130, 0.0, -0.050)),
)

JOINTS: tuple[str, ...] = tuple(name for name, _, _ in _BONES)
"""Names of the 22 joints; toes are the balls of the feet."""

JOINT = {name: j for j, name in enumerate(JOINTS)}
"""Number of each joint."""

PARENTS: NDArray[np.int64] = np.array([JOINT.get(parent, -1) for _, parent, _ in _BONES])
"""(22,) number of each joint's parent, which comes before it; -1 for the pelvis."""

OFFSETS: NDArray[np.float64] = np.array([offset for _, _, offset in _BONES])
"""(22, 3) metres from the parent, in the parent's axes."""

TURNING: NDArray[np.int64] = np.flatnonzero(np.isin(np.arange(len(JOINTS)), PARENTS))
"""(17,) the joints that turn: those with children."""

COUNTERPARTS: NDArray[np.int64] = np.array(
    [
        JOINT[name.replace("left", "right") if "left" in name else name.replace("right", "left")]
        for name in JOINTS
    ]
)
"""(22,) each joint's counterpart on the other side; itself for those of the trunk."""

LEG_LENGTH = float(-OFFSETS[JOINT["left_knee"], 2] - OFFSETS[JOINT["left_ankle"], 2])
"""Thigh and shank, metres."""

ANKLE_HEIGHT = 0.075
"""Of the ankle above the sole, metres."""

TOE_HEIGHT = ANKLE_HEIGHT + float(OFFSETS[JOINT["left_toe"], 2])
"""Of the ball of the foot above the sole, metres."""

HEEL_BACK = 0.045
"""Metres from the ankle back to the heel."""

TURN_OF = {int(j): k for k, j in enumerate(TURNING)}
"""Place among ``TURNING`` of each joint that turns."""


def forward_kinematics(
    rotations: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Joint positions and orientations from the turns of the joints.

    Args:
        rotations: (n, 17, 3, 3) rotation matrices of ``TURNING`` against their parents, the
            pelvis's against the axes of the result.

    Returns:
        (n, 22, 3) positions relative to the pelvis, metres, and (n, 22, 3, 3) orientations; joints
        that do not turn are oriented as their parents.
    """
    n = len(rotations)
    positions = np.zeros((n, len(JOINTS), 3))
    oriented = np.empty((n, len(JOINTS), 3, 3))
    for j, parent in enumerate(PARENTS.tolist()):
        if parent < 0:
            oriented[:, j] = rotations[:, TURN_OF[j]]
            continue
        positions[:, j] = positions[:, parent] + oriented[:, parent] @ OFFSETS[j]
        own = TURN_OF.get(j)
        oriented[:, j] = (
            oriented[:, parent] if own is None else oriented[:, parent] @ rotations[:, own]
        )
    return positions, oriented


def local_rotations(oriented: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 17, 3, 3) turns of ``TURNING`` against their parents, from (n, 22, 3, 3) orientations."""
    own = oriented[:, TURNING]
    parents = oriented[:, PARENTS[TURNING[1:]]]
    turned = np.empty_like(own)
    turned[:, 0] = own[:, 0]
    turned[:, 1:] = np.swapaxes(parents, -1, -2) @ own[:, 1:]
    return turned
