"""From channels in a file's axes to rotations and paths in the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

FILE_TO_WORLD = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""World axes of a y-up file: x = Z, y = X, z = Y.  A cyclic change keeps left and right."""

MIRROR_IN_FILE = np.diag([-1.0, 1.0, 1.0])
"""Left-right reflection in file axes: the world's y -> -y is the file's X -> -X."""

MIRROR_IN_WORLD = np.diag([1.0, -1.0, 1.0])
"""Left-right reflection in the world, y -> -y."""

FRAME_TIME_S = (1e-5, 1 / 12)
"""Shortest and longest time between frames, seconds.

Walking moves with frequencies of up to 6 Hz (Winter, Biomechanics and Motor Control of Human
Movement, chapter 2), which take at least 12 frames a second.
"""

RATE_TOLERANCE = 5e-4
"""Relative error of a frame time of few digits, such as .00833 s for 120 Hz."""


def to_world(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn (..., 3) vectors of a y-up file into the world."""
    return positions[..., [2, 0, 1]]


def root_to_world(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn (F, 4) root quaternions of a y-up file into the world."""
    return (Rotation.from_matrix(FILE_TO_WORLD) * Rotation.from_quat(rotations)).as_quat()


def frame_rate_of(frame_time: float) -> float:
    """Frames a second of a frame time written with few digits, whole where that is meant."""
    rate = 1.0 / frame_time
    whole = round(rate)
    return float(whole) if abs(rate - whole) <= RATE_TOLERANCE * rate else rate
