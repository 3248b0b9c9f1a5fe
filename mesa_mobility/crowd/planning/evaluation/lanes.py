"""Options and neighbours in full lanes of a vector."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.compiled.simd import LANES, bits_set, press_numbers
from mesa_mobility.crowd.collision.simd_tests import numbers_between
from mesa_mobility.crowd.costs.layout import COST, SPEED


@internal()
def pick_between(
    bounds: NDArray[np.float64],
    above: float,
    up_to: float,
    first: int,
    picked: NDArray[np.int64],
) -> int:
    """Write the indices of bounds, counted from ``first``, that lie in (``above``, ``up_to``].

    Behind the last bound there must be room to read, behind the last number to write 8 of them.
    Returns their number.
    """
    count = 0
    for at in range(0, len(bounds), LANES):
        bits = numbers_between(bounds, at, above, up_to)
        bits &= (1 << min(len(bounds) - at, LANES)) - 1
        press_numbers(first + at, bits, picked, count)
        count += bits_set(bits)
    return count


@internal()
def fill_ends(first: int, last: int, ends: NDArray[np.float64]) -> None:
    """Repeat the last of the options ``first`` to ``last`` until the last lane is full."""
    if last > first:
        for row in range(SPEED + 1):
            for k in range(last, first + in_lanes(last - first)):
                ends[row, k] = ends[row, last - 1]


@internal()
def least(values: NDArray[np.float64]) -> float:
    """Least of some values, none of which is nan; inf if there are none."""
    lowest = np.inf
    for value in values:
        lowest = value if value < lowest else lowest
    return lowest


@internal()
def in_lanes(count: int) -> int:
    """The number rounded up to full lanes."""
    return (count + LANES - 1) // LANES * LANES


@internal()
def fill_lane(count: int, others: NDArray[np.float64]) -> None:
    """Repeat the last of the first ``count`` neighbours until the last lane is full.

    Costs of these copies are computed and ignored: full lanes are faster than a remainder taken one
    by one.
    """
    for row in range(COST):
        for a in range(count, in_lanes(count)):
            others[row, a] = others[row, count - 1]
