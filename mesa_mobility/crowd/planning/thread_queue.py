"""The queue by which threads share the decisions of a frame.

People decide in order, since each decision depends on the paths to which people before are
committed.
Nothing beyond the search radius matters: two people farther apart, on every sheet on which they
are seen, may decide in either order, or at once, with the same result to the last bit. So each
thread takes the next pedestrian, and waits for undecided predecessors within that radius.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.compiled.intrinsics import load_acquire, yield_thread
from mesa_mobility.crowd.planning.workspace import FrameContext
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.twins import Twins

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
    d: int, before: int, rows: NDArray[np.int64], queue: Queue, scene: FrameContext
) -> int:
    """Wait until those predecessors of the pedestrian at index d who are near have decided.

    They are within the search radius, or have a twin there, or are as near to a twin of the
    pedestrian.

    Returns:
        Length of the leading part of the queue that has decided, at least ``before``.
    """
    while before < d and load_acquire(queue.done, before) == 1:
        before += 1
    i, state, twins = rows[d], scene.state, scene.twins
    radius = scene.rules.search_radius
    for e in range(before, d):
        near = _near(i, rows[e], radius, state)
        if not near and len(twins.follow) > 0:
            near = _near_twin(i, rows[e], radius, twins, state) or _near_twin(
                rows[e], i, radius, twins, state
            )
        if near:
            patience = _PATIENCE
            while load_acquire(queue.done, e) == 0:
                patience -= 1
                if patience < 0:
                    yield_thread()
    return before


@internal()
def _near(i: int, j: int, radius: float, state: CrowdState) -> bool:
    """Whether j is within ``radius`` of i."""
    dx, dy = state.x[j] - state.x[i], state.y[j] - state.y[i]
    return bool(dx * dx + dy * dy <= radius * radius)


@internal()
def _near_twin(i: int, j: int, radius: float, twins: Twins, state: CrowdState) -> bool:
    """Whether j is within ``radius`` of a twin of i."""
    t = twins.follow[i]
    while t >= 0:
        if _near(t, j, radius, state):
            return True
        t = twins.follow[t]
    return False
