"""Slowing down before a place at which one is to stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

STOPPING = 3.0
"""Seconds from full speed to standing.

183 people who stopped at urban intersections did so most often early and on purpose, over about
3 s or six steps on average (Analysis on termination of pedestrians' gait at urban intersections,
IEEE Conference on Intelligent Transportation Systems 2014).
"""


def slow_down(speeds: NDArray[np.float64], remaining: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) speeds from which people come to stand at the end of their way, m/s.

    At the constant deceleration v0 / ``STOPPING`` somebody at full speed v0 needs
    v0 ``STOPPING`` / 2 to stand, and its speed is v0 times the square root of the share of this
    stretch that remains.

    Args:
        speeds: (n,) full speeds, m/s.
        remaining: (n,) metres to where each is to stand.
    """
    braking = speeds * STOPPING / 2.0
    slower = np.sqrt(2.0 * speeds / STOPPING * np.clip(remaining, 0.0, braking))
    found: NDArray[np.float64] = np.where(remaining < braking, np.minimum(speeds, slower), speeds)
    return found
