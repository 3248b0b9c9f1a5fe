"""Cache of targets by position and destination.

A target depends only on the position, the destination and the floor plan. In a jam every other
decision is to stay, so the same query comes again.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal

ANSWER = np.dtype(
    [
        ("x", "u8"),
        ("y", "u8"),
        ("target_x", "f8"),
        ("target_y", "f8"),
        ("length", "f8"),
        ("destination", "i4"),
        ("gate", "i4"),
        ("corner", "i4"),
        ("next_corner", "i4"),
    ],
    align=True,
)
"""An entry: the bits of `x` and `y`, metres, and the number of the destination from 1 on (0 for an
empty slot); then the fields of `Targets`."""

# Number of entries, a power of 2: 0.9 MB, of which memory is taken as it is written to.
_SLOT_BITS = 14

# 2^64 over the golden ratio, which spreads similar numbers (Knuth, TAOCP 3, section 6.4).
_SPREAD = np.uint64(0x9E3779B97F4A7C15)


class Found(NamedTuple):
    """Arrays for the targets of n people.

    Attributes:
        points: (n, 2) metres.
        gates: (n,) numbers of openings, -1 for a corner.
        lengths: (n,) of the routes, metres.
        corners: (n, 2) the next corner and the node after it.
    """

    points: NDArray[np.float64]
    gates: NDArray[np.int64]
    lengths: NDArray[np.float64]
    corners: NDArray[np.int64]


def empty_cache() -> NDArray[np.void]:
    """An empty cache."""
    return np.zeros(1 << _SLOT_BITS, dtype=ANSWER)


@internal()
def _bits(x: float) -> np.uint64:
    return np.float64(x).view(np.uint64)


@internal()
def _slot_of(x: float, y: float, destination: int) -> np.int64:
    """The slot of a position and destination."""
    mixed = ((_bits(x) * _SPREAD ^ _bits(y)) + np.uint64(destination)) * _SPREAD
    # The upper half depends on all bits; the lower half of a round number is 0.
    mixed = (mixed ^ (mixed >> np.uint64(32))) * _SPREAD
    return np.int64(mixed >> np.uint64(64 - _SLOT_BITS))


@internal()
def recall(
    cache: NDArray[np.void],
    x: float,
    y: float,
    destination: int,
    person: int,
    found: Found,
) -> bool:
    """Write the cached target of (x, y), if there is one, and return whether; see `aim`."""
    slot = _slot_of(x, y, destination)
    kept = cache[slot]
    if kept["destination"] != destination + 1 or kept["x"] != _bits(x) or kept["y"] != _bits(y):
        return False
    found.points[person, 0], found.points[person, 1] = kept["target_x"], kept["target_y"]
    found.gates[person], found.lengths[person] = kept["gate"], kept["length"]
    found.corners[person, 0], found.corners[person, 1] = kept["corner"], kept["next_corner"]
    return True


@internal()
def keep(
    cache: NDArray[np.void],
    x: float,
    y: float,
    destination: int,
    person: int,
    found: Found,
) -> None:
    """Cache the target of a person at (x, y), in place of the entry in its slot."""
    slot = _slot_of(x, y, destination)
    cache[slot]["x"], cache[slot]["y"] = _bits(x), _bits(y)
    cache[slot]["target_x"], cache[slot]["target_y"] = found.points[person]
    cache[slot]["length"] = found.lengths[person]
    cache[slot]["destination"] = destination + 1
    cache[slot]["gate"] = found.gates[person]
    cache[slot]["corner"], cache[slot]["next_corner"] = found.corners[person]
