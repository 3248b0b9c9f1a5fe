"""Lanes: how well people who walk one way keep to rows of their own."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

ROW_M = 0.4
"""Width of a row, metres."""


def lane_order(across: ArrayLike, direction: ArrayLike) -> float:
    """How well people of one direction keep to rows of their own (Rex and Loewen 2007).

    Mean over people of ((a - b) / (a + b))^2, where a and b people of either direction are in the
    same row, 0.4 m wide: 1 in perfect lanes.

    Args:
        across: (n,) metres from the middle of the corridor.
        direction: (n,) +1 or -1.

    Returns:
        From 0 to 1; not a number without people.
    """
    places: NDArray[np.float64] = np.asarray(across, dtype=np.float64)
    if not len(places):
        return float("nan")
    _, row = np.unique(np.floor(places / ROW_M), return_inverse=True)
    net = np.bincount(row, np.asarray(direction, dtype=np.float64))
    total = np.bincount(row)
    return float(np.mean(((net / total) ** 2)[row]))
