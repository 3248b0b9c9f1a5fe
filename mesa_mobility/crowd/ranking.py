"""Options in rising order of cost, without sorting those that nobody will look at.

A heap holds the options up to some cost; the rest join it band by band, when
all below them have been looked at.  Among equal costs the lower number is first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.jit import lean

FIRST_BAND = 0.15
"""Width of the first band above the least bound; the first options mostly decide."""

WIDENING = 2.0
BANDS = 8
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
    # Unsigned: no test whether an index counts from the end. The lesser child is found without a
    # branch, as which one it is cannot be foreseen.
    one, two, end = np.uint64(1), np.uint64(2), np.uint64(size)
    at = np.uint64(root)
    child = two * at + one
    while child < end:
        if child + one < end:
            left, right = key[child], key[child + one]
            second = right < left
            if right == left:
                second = item[child + one] < item[child]
            child += np.uint64(second)
        if k < key[child] or (k == key[child] and v < item[child]):
            break
        key[at], item[at] = key[child], item[child]
        at = child
        child = two * at + one
    key[at], item[at] = k, v


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
