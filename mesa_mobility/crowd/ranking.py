"""Options in rising order of cost, without sorting those that nobody will look at.

A heap holds the options up to some cost; the rest join it band by band, when
all below them have been looked at.  Among equal costs the lower number is first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.jit import lean

FIRST_BAND = 0.5
"""Width of the first band above the least bound; the first options mostly decide."""

WIDENING = 4.0
BANDS = 6
"""Bands after which all the rest joins."""

DEAREST = 1e300
"""What costs more is blocked."""


@lean()
def all_finite(values: NDArray[np.float64]) -> bool:
    """Whether every value is a finite number."""
    bad = 0
    for value in values:
        bad |= int(not abs(value) < np.inf)
    return bad == 0


@lean()
def least(values: NDArray[np.float64]) -> float:
    """The least of some values, none of which is nan; inf if there are none."""
    lowest = np.inf
    for value in values:
        lowest = value if value < lowest else lowest
    return lowest


@lean()
def sift_down(key: NDArray[np.float64], item: NDArray[np.int64], size: int, root: int) -> None:
    """Restore the heap order (least key first; lower item first among equals) below ``root``."""
    k, v = key[root], item[root]
    while True:
        child = 2 * root + 1
        if child >= size:
            break
        right = child + 1
        if right < size and (
            key[right] < key[child] or (key[right] == key[child] and item[right] < item[child])
        ):
            child = right
        if k < key[child] or (k == key[child] and v < item[child]):
            break
        key[root], item[root] = key[child], item[child]
        root = child
    key[root], item[root] = k, v


@lean()
def join(
    costs: NDArray[np.float64],
    rows: NDArray[np.int64],
    above: float,
    up_to: float,
    key: NDArray[np.float64],
    item: NDArray[np.int64],
    size: int,
) -> int:
    """Add the ``rows`` that cost more than ``above`` and at most ``up_to``; return the new size."""
    for k in range(len(costs)):
        if above < costs[k] <= up_to:
            key[size] = costs[k]
            item[size] = rows[k]
            size += 1
    for root in range(size // 2 - 1, -1, -1):
        sift_down(key, item, size, root)
    return size
