"""People who decide in one frame, shared out among threads.

People decide one after the other, since each sees what those before have committed to. But
nobody looks farther than the search radius: two between whom there is more may decide in either
order, or at once, and the result is the same to the last bit. So a thread takes whoever is
next, and waits for those before who are within that radius and not done.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean
from mesa_mobility.machine import give_way, told

_PATIENCE = 1000
"""Looks at whether another thread is done before the processor is offered to others: a decision
takes some 10 microseconds, but a thread that others have put off its processor, milliseconds."""


class Queue(NamedTuple):
    """``next`` (1,) place of who is taken next, ``done`` (n,) 1 for those who have decided."""

    next: NDArray[np.int64]
    done: NDArray[np.int64]


def new_queue(people: int) -> Queue:
    """A queue of which nobody is taken."""
    return Queue(np.zeros(1, np.int64), np.zeros(people, np.int64))


@lean()
def await_neighbours(
    d: int, before: int, rows: NDArray[np.int64], queue: Queue, state: CrowdState, radius: float
) -> int:
    """Wait until everybody before place d and within ``radius`` of whom is there has decided.

    Returns:
        How many have decided from the first without a gap, at least ``before``.
    """
    while before < d and told(queue.done, before) == 1:
        before += 1
    i = rows[d]
    for e in range(before, d):
        dx, dy = state.x[rows[e]] - state.x[i], state.y[rows[e]] - state.y[i]
        if dx * dx + dy * dy <= radius * radius:
            patience = _PATIENCE
            while told(queue.done, e) == 0:
                patience -= 1
                if patience < 0:
                    give_way()
    return before
