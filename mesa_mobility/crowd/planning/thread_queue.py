"""The queue by which threads share the decisions of a frame.

People decide in order, since each depends on the paths that its predecessors have committed to.
Nothing beyond the search radius matters: two people farther apart may decide in either order, or
at once, with the same result to the last bit. So each thread takes the next pedestrian, and waits
for undecided predecessors within that radius.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.compiled.intrinsics import load_acquire, yield_thread
from mesa_mobility.crowd.state.records import CrowdState

_PATIENCE = 1000
"""Checks on another thread before the processor is yielded. A decision takes some 10 microseconds;
a thread that has lost its processor takes milliseconds."""


class Queue(NamedTuple):
    """``next`` (1,) index of the next pedestrian; ``done`` (n,) 1 for those who have decided."""

    next: NDArray[np.int64]
    done: NDArray[np.int64]


def new_queue(people: int) -> Queue:
    """A queue of undecided people."""
    return Queue(np.zeros(1, np.int64), np.zeros(people, np.int64))


@internal()
def await_neighbours(
    d: int, before: int, rows: NDArray[np.int64], queue: Queue, state: CrowdState, radius: float
) -> int:
    """Wait until all predecessors of the pedestrian at index d within ``radius`` have decided.

    Returns:
        Length of the leading part of the queue that has decided, at least ``before``.
    """
    while before < d and load_acquire(queue.done, before) == 1:
        before += 1
    i = rows[d]
    for e in range(before, d):
        dx, dy = state.x[rows[e]] - state.x[i], state.y[rows[e]] - state.y[i]
        if dx * dx + dy * dy <= radius * radius:
            patience = _PATIENCE
            while load_acquire(queue.done, e) == 0:
                patience -= 1
                if patience < 0:
                    yield_thread()
    return before
